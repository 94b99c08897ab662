//! Last stage: items and lines with the places of their numbers.

use super::groups::{Groups, Joined};
use super::lines::{LaidChain, Lines};
use super::roles::LineRoles;
use super::shapes::Shapes;
use super::slots::Slots;
use crate::kernels::{Item, Line, Loose};
use crate::kernels::{Row, Rows};

/// The items of all groups, in order; entries of the table of shapes are made as they need them.
pub fn items(
    lines: &Lines,
    hexes: &[[u32; 8]],
    groups: Groups,
    slots: &Slots,
    shapes: &mut Shapes,
    width: usize,
) -> Vec<Item> {
    let mut adding = Adding::new(slots);
    let all = groups.items.into_iter().zip(groups.group_of);
    all.map(|(joined, group)| match joined {
        Joined::Chains(chains) => {
            let rows = chains.iter().map(|laid| row(lines, laid, slots, group, &mut adding)).collect();
            let elements = chains.into_iter().flat_map(|laid| laid.chain.elements).collect();
            Item::Rows(Rows::new(rows, elements, width, |batch| shapes.entry(batch)))
        }
        Joined::Loose(elements) => Item::Loose(Box::new(loose(lines, hexes, elements, slots, group, shapes))),
    })
    .collect()
}

/// Which slots hold forces of an earlier row already, by line and number.
struct Adding {
    begun: Vec<Vec<bool>>,
}

impl Adding {
    fn new(slots: &Slots) -> Self {
        // Slots that are cleared hold their zeros.
        let of_line = |(slots, loose): (&Vec<usize>, &bool)| vec![*loose; slots.len()];
        Adding { begun: slots.of_lines.iter().zip(&slots.loose).map(of_line).collect() }
    }

    fn begin(&mut self, line: usize, number: usize) -> bool {
        std::mem::replace(&mut self.begun[line][number], true)
    }
}

fn row(lines: &Lines, laid: &LaidChain, slots: &Slots, group: usize, adding: &mut Adding) -> Row {
    let number = laid.lines.map(|l| slots.number(l, group));
    Row {
        count: laid.chain.elements.len(),
        closed: laid.chain.closed,
        x: laid.lines.map(|l| lines.lines[l].start),
        f: std::array::from_fn(|k| slots.of_lines[laid.lines[k]][number[k]]),
        add: std::array::from_fn(|k| adding.begin(laid.lines[k], number[k])),
    }
}

fn loose(
    lines: &Lines,
    hexes: &[[u32; 8]],
    elements: Vec<u32>,
    slots: &Slots,
    group: usize,
    shapes: &mut Shapes,
) -> Loose {
    let node = |corner: usize, lane: usize| hexes[elements[lane.min(elements.len() - 1)] as usize][corner];
    let force = |corner: usize, lane: usize| {
        let at = lines.at[node(corner, lane) as usize];
        let line = at.line as usize;
        slots.of_lines[line][slots.number(line, group)] as u32 + at.index
    };
    let by_lane = |of: &dyn Fn(usize, usize) -> u32| {
        std::array::from_fn(|corner| std::array::from_fn(|lane| of(corner, lane)))
    };
    Loose {
        nodes: by_lane(&|corner, lane| lines.place(node(corner, lane))),
        f: by_lane(&force),
        shape: shapes.entry(&elements),
        elements,
    }
}

/// The lines with their roles and slots.
pub fn placed_lines(lines: Lines, roles: Vec<LineRoles>, slots: Slots) -> Vec<Line> {
    let slots = slots.of_lines.into_iter().zip(slots.loose);
    let all = lines.lines.into_iter().zip(roles).zip(slots);
    all.map(|((line, roles), (slots, loose))| Line {
        start: line.start,
        nodes: line.nodes,
        closed: line.closed,
        batches: roles.batches,
        slots,
        length: line.length,
        loose,
        has_rim: roles.has_rim,
        driven: roles.driven,
        plain: roles.plain,
        surface: roles.surface,
    })
    .collect()
}

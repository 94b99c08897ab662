//! How nodes and elements lie in memory: node lines and element rows that load as whole vectors, whatever numbering
//! the mesh came with, and groups of rows that one thread takes.
//!
//! A row is a chain of elements along xi; its corners lie on four node lines. Lane l of a batch reads entry i + l of a
//! line for the corners xi = -1 and entry i + l + 1 for those xi = +1: no indices. A closed line (around a ring) keeps
//! a copy of its first node behind its last one. Batches run on from a row into the next ([`Rows`]). Elements in no such
//! chain are taken lane by lane ([`Loose`]).
//!
//! Forces are summed line by line into *slots*: one copy of the line for every group of rows that touches it, in
//! which the group's rows are added in order. A node's force is the sum of its slots, first to last: the same bits
//! however the groups are shared out among threads, and wherever the slots lie ([`super::slots`]).

use super::rows::{Row, Rows, runs};
use crate::model::Model;
use crate::model::chains::{BACK, Chain, FRONT, chains};
use crate::physics::lanes::WIDEST;
use std::collections::HashMap;
use std::ops::Range;

/// Most groups, and fewest elements of one.
const MOST_GROUPS: usize = 256;
const LEAST_ELEMENTS: usize = 40;
/// Nodes of a line of nodes in no row, in batches: the size of a typical line.
const LOOSE_BATCHES: usize = 8;

/// At most as many elements as there are lanes, with nothing in common.
#[derive(Debug, Clone)]
pub struct Loose {
    pub elements: Vec<u32>,
    /// Places of the corners among the nodes and the forces, by corner and lane; lanes beyond the last element repeat it.
    pub nodes: [[u32; WIDEST]; 8],
    pub f: [[u32; WIDEST]; 8],
    pub shape: u32,
}

/// What the element pass takes at a time.
#[derive(Debug, Clone)]
pub enum Item {
    Rows(Rows),
    Loose(Box<Loose>),
}

impl Item {
    pub fn elements(&self) -> &[u32] {
        match self {
            Item::Rows(rows) => &rows.elements,
            Item::Loose(loose) => &loose.elements,
        }
    }

    /// Places of the corners of its elements.
    pub fn corners(&self) -> Vec<[u32; 8]> {
        match self {
            Item::Rows(rows) => {
                rows.rows.iter().flat_map(|row| (0..row.count).map(|i| row.corners(i))).collect()
            }
            Item::Loose(loose) => {
                (0..loose.elements.len()).map(|lane| loose.nodes.map(|corner| corner[lane])).collect()
            }
        }
    }

    /// Entries of the table of shapes, by batch.
    pub fn shapes(&self) -> &[u32] {
        match self {
            Item::Rows(rows) => &rows.shapes,
            Item::Loose(loose) => std::slice::from_ref(&loose.shape),
        }
    }
}

/// What the lanes of a batch of nodes are, by bits.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct NodeBatch {
    pub rim: u32,
    /// Nodes that can touch the road.
    pub surface: u32,
    /// Held components: lanes by component.
    pub held: [u32; 3],
    /// Of a batch with either: where its lanes begin in tables of such batches alone.
    pub boundary: u32,
}

/// Consecutive nodes.
#[derive(Debug, Clone)]
pub struct Line {
    pub start: usize,
    pub nodes: Vec<u32>,
    pub closed: bool,
    pub batches: Vec<NodeBatch>,
    /// Its copies among the forces, by ascending group.
    pub slots: Vec<usize>,
    /// Forces come lane by lane: the slots must be zero before a step.
    pub loose: bool,
    pub has_rim: bool,
    /// Whether all of its nodes are free of rim and holds.
    pub plain: bool,
    /// Its number among the lines that can touch the road.
    pub surface: Option<usize>,
    /// First and last item that touches it.
    pub items: (usize, usize),
}

impl Line {
    /// Numbers of it in an array for lanes of `width`: a vector more than it fills, so that a load from the second node on
    /// stays inside.
    pub fn length(&self, width: usize) -> usize {
        (self.nodes.len().div_ceil(width) + 1) * width
    }
}

/// The whole arrangement for lanes of one width.
#[derive(Debug, Clone)]
pub struct Layout {
    /// Place of every node.
    pub place: Vec<u32>,
    /// Length of arrays by place.
    pub places: usize,
    pub items: Vec<Item>,
    pub lines: Vec<Line>,
    /// Items by group.
    pub groups: Vec<Range<usize>>,
    /// The table of shapes: the class of every lane.
    pub shapes: Vec<[u32; WIDEST]>,
    pub surface_lines: usize,
    /// Lanes of batches of nodes with rim or surface nodes.
    pub boundary: usize,
}

/// Position of a node: its line and place in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct At {
    line: u32,
    index: u32,
}
const NOWHERE: At = At { line: u32::MAX, index: 0 };

impl Layout {
    /// Arranges a model for lanes of `width`; `road`: surface nodes can touch.
    pub fn new(model: &Model, road: bool, width: usize) -> Layout {
        let mut builder = Builder::new(model, width);
        for chain in chains(&model.mesh.hexes, model.node_count()) {
            builder.add(chain);
        }
        builder.end_loose();
        builder.loose_lines();
        builder.finish(model, road)
    }
}

struct Builder<'a> {
    model: &'a Model,
    width: usize,
    items: Vec<Item>,
    lines: Vec<Line>,
    at: Vec<At>,
    /// Elements waiting for a loose batch.
    waiting: Vec<u32>,
    shapes: Vec<[u32; WIDEST]>,
    /// Entries of that table.
    entries: HashMap<[u32; WIDEST], u32>,
}

impl<'a> Builder<'a> {
    fn new(model: &'a Model, width: usize) -> Self {
        let at = vec![NOWHERE; model.node_count()];
        Builder {
            model,
            width,
            items: Vec::new(),
            lines: Vec::new(),
            at,
            waiting: Vec::new(),
            shapes: Vec::new(),
            entries: HashMap::new(),
        }
    }

    fn hex(&self, e: u32) -> &'a [u32; 8] {
        &self.model.mesh.hexes[e as usize]
    }

    /// Makes a row of a chain if its nodes lie, or can be laid, on lines; else its elements are loose.
    fn add(&mut self, mut chain: Chain) {
        if 2 * chain.elements.len() >= self.width {
            self.rotate(&mut chain);
            if let Some(lines) = self.lines_of(&chain) {
                self.end_loose();
                let Chain { elements, closed } = chain;
                let (x, f, add) = ([0; 4], [0; 4], [false; 4]);
                let row = Row { count: elements.len(), closed, x, f, add, lines };
                // Batches, and with them shapes, come when rows are joined.
                self.items.push(Item::Rows(Rows::new(vec![row], elements, self.width, |_| 0)));
                return;
            }
        }
        for e in chain.elements {
            self.waiting.push(e);
            if self.waiting.len() == self.width {
                self.end_loose();
            }
        }
    }

    /// Starts a closed chain where a line that it meets starts.
    fn rotate(&self, chain: &mut Chain) {
        if !chain.closed {
            return;
        }
        for corner in BACK {
            let at = |e: &u32| self.at[self.hex(*e)[corner] as usize];
            if let Some(first) = chain.elements.iter().position(|e| at(e) != NOWHERE && at(e).index == 0) {
                chain.elements.rotate_left(first);
                return;
            }
        }
    }

    fn lines_of(&mut self, chain: &Chain) -> Option<[usize; 4]> {
        let mut lines = [0; 4];
        for k in 0..4 {
            let mut nodes: Vec<u32> = chain.elements.iter().map(|e| self.hex(*e)[BACK[k]]).collect();
            if !chain.closed {
                nodes.push(self.hex(*chain.elements.last()?)[FRONT[k]]);
            }
            lines[k] = self.line_of(nodes, chain.closed)?;
        }
        Some(lines)
    }

    /// The line with exactly these nodes: an old one, or a new one if none of them is on a line.
    fn line_of(&mut self, nodes: Vec<u32>, closed: bool) -> Option<usize> {
        let first = self.at[nodes[0] as usize];
        if first == NOWHERE {
            let fresh = nodes.iter().all(|n| self.at[*n as usize] == NOWHERE);
            return fresh.then(|| self.new_line(nodes, closed));
        }
        let line = first.line as usize;
        (self.lines[line].closed == closed && self.lines[line].nodes == nodes).then_some(line)
    }

    fn new_line(&mut self, nodes: Vec<u32>, closed: bool) -> usize {
        let line = self.lines.len();
        for (index, &n) in nodes.iter().enumerate() {
            self.at[n as usize] = At { line: line as u32, index: index as u32 };
        }
        self.lines.push(Line {
            start: 0,
            batches: vec![NodeBatch::default(); nodes.len().div_ceil(self.width)],
            nodes,
            closed,
            slots: Vec::new(),
            loose: false,
            has_rim: false,
            plain: true,
            surface: None,
            items: (usize::MAX, 0),
        });
        line
    }

    /// The entry of the table of shapes for these elements, one a lane; lanes beyond the last repeat it.
    fn shape_of(&mut self, batch: &[u32]) -> u32 {
        let class = |lane: usize| self.model.class_of[batch[lane.min(batch.len() - 1)] as usize];
        let lanes = std::array::from_fn(class);
        *self.entries.entry(lanes).or_insert_with(|| {
            self.shapes.push(lanes);
            self.shapes.len() as u32 - 1
        })
    }

    fn end_loose(&mut self) {
        if self.waiting.is_empty() {
            return;
        }
        let elements = std::mem::take(&mut self.waiting);
        let shape = self.shape_of(&elements);
        let none = [[0; WIDEST]; 8];
        self.items.push(Item::Loose(Box::new(Loose { elements, nodes: none, f: none, shape })));
    }

    /// Lines for the nodes that are on none, in the order in which elements meet them.
    fn loose_lines(&mut self) {
        let model = self.model;
        let of_items = self.items.iter().flat_map(Item::elements).flat_map(|e| model.mesh.hexes[*e as usize]);
        // Nodes of no element are nodes all the same.
        let mut met = vec![false; self.at.len()];
        let mut left = Vec::new();
        for n in of_items.chain(0..self.at.len() as u32) {
            if self.at[n as usize] == NOWHERE && !std::mem::replace(&mut met[n as usize], true) {
                left.push(n);
            }
        }
        for nodes in left.chunks(LOOSE_BATCHES * self.width) {
            self.new_line(nodes.to_vec(), false);
        }
    }

    /// Lines that an item touches.
    fn touched(&self, item: &Item) -> Vec<usize> {
        match item {
            Item::Rows(rows) => rows.rows.iter().flat_map(|row| row.lines).collect(),
            Item::Loose(loose) => {
                let nodes = loose.elements.iter().flat_map(|e| self.hex(*e));
                nodes.map(|n| self.at[*n as usize].line as usize).collect()
            }
        }
    }

    fn finish(mut self, model: &Model, road: bool) -> Layout {
        let touched: Vec<Vec<usize>> = self.items.iter().map(|i| self.touched(i)).collect();
        for (i, (lines, item)) in touched.iter().zip(&self.items).enumerate() {
            for &l in lines {
                let line = &mut self.lines[l];
                line.items = (line.items.0.min(i), line.items.1.max(i));
                line.loose |= matches!(item, Item::Loose(_));
            }
        }
        let groups = self.groups();
        let places = self.lay_nodes();
        let groups = self.join(&groups);
        let (surface_lines, boundary) = self.roles(model, road);
        let place = |at: &At| (self.lines[at.line as usize].start + at.index as usize) as u32;
        let place = self.at.iter().map(place).collect();
        let Builder { items, lines, shapes, .. } = self;
        Layout { place, places, items, lines, groups, shapes, surface_lines, boundary }
    }

    /// Cuts the items so that a line meets few groups.
    fn groups(&self) -> Vec<Range<usize>> {
        let met = self.lines.iter().filter(|l| l.items.0 != usize::MAX);
        let widest = met.map(|l| l.items.1 - l.items.0).max().unwrap_or(0);
        let stride = widest.saturating_sub(1).max(1);
        let all = self.model.element_count();
        let least = LEAST_ELEMENTS.max(all.div_ceil(MOST_GROUPS));
        let mut groups = Vec::new();
        let (mut start, mut elements) = (0, 0);
        for i in 0..self.items.len() {
            elements += self.items[i].elements().len();
            let whole = (i + 1 - start).is_multiple_of(stride);
            if whole && elements >= least {
                groups.push(start..i + 1);
                (start, elements) = (i + 1, 0);
            }
        }
        match groups.last_mut() {
            Some(last) if elements < least => last.end = self.items.len(),
            _ => groups.push(start..self.items.len()),
        }
        groups
    }

    /// Joins rows of a group that follow each other where that fills lanes; the groups of the items that are left.
    fn join(&mut self, groups: &[Range<usize>]) -> Vec<Range<usize>> {
        let mut before = std::mem::take(&mut self.items).into_iter();
        // What became of each item.
        let mut became = Vec::new();
        let mut joined = Vec::new();
        for group in groups {
            let start = self.items.len();
            let mut rows: Vec<Rows> = Vec::new();
            for item in before.by_ref().take(group.len()) {
                match item {
                    Item::Rows(row) => rows.push(row),
                    loose => {
                        self.add_joined(&mut rows, &mut became);
                        became.push(self.items.len());
                        self.items.push(loose);
                    }
                }
            }
            self.add_joined(&mut rows, &mut became);
            joined.push(start..self.items.len());
        }
        for line in self.lines.iter_mut().filter(|l| l.items.0 != usize::MAX) {
            line.items = (became[line.items.0], became[line.items.1]);
        }
        joined
    }

    /// Adds rows that follow each other as items, and says which item each is part of.
    fn add_joined(&mut self, rows: &mut Vec<Rows>, became: &mut Vec<usize>) {
        let counts: Vec<usize> = rows.iter().map(|r| r.elements.len()).collect();
        let mut rest = rows.drain(..);
        for count in runs(&counts, self.width) {
            became.extend(std::iter::repeat_n(self.items.len(), count));
            let run: Vec<Rows> = rest.by_ref().take(count).collect();
            let elements = run.iter().flat_map(|r| r.elements.iter().copied()).collect();
            let joined = run.into_iter().flat_map(|r| r.rows).collect();
            let joined = Rows::new(joined, elements, self.width, |batch| self.shape_of(batch));
            self.items.push(Item::Rows(joined));
        }
    }

    /// Lays the lines one behind the other and tells the items where; returns the length of arrays by place.
    fn lay_nodes(&mut self) -> usize {
        let mut next = 0;
        for line in &mut self.lines {
            line.start = next;
            next += line.length(self.width);
        }
        for item in &mut self.items {
            match item {
                Item::Rows(rows) => {
                    rows.rows.iter_mut().for_each(|row| row.x = row.lines.map(|l| self.lines[l].start));
                }
                Item::Loose(loose) => {
                    for lane in 0..WIDEST {
                        let e = loose.elements[lane.min(loose.elements.len() - 1)];
                        for c in 0..8 {
                            let At { line, index } = self.at[self.model.mesh.hexes[e as usize][c] as usize];
                            loose.nodes[c][lane] = self.lines[line as usize].start as u32 + index;
                        }
                    }
                }
            }
        }
        next
    }

    /// Marks rim and surface nodes; returns the number of lines that can touch, and of lanes beside such nodes.
    fn roles(&mut self, model: &Model, road: bool) -> (usize, usize) {
        let mut mark = |nodes: &[u32], bit: fn(&mut NodeBatch) -> &mut u32| {
            for &n in nodes {
                let At { line, index } = self.at[n as usize];
                let (batch, lane) = (index as usize / self.width, index as usize % self.width);
                *bit(&mut self.lines[line as usize].batches[batch]) |= 1 << lane;
            }
        };
        mark(&model.mesh.rim, |b| &mut b.rim);
        if road {
            mark(&model.mesh.surface, |b| &mut b.surface);
        }
        let held = |d: usize| {
            let bits = model.mesh.held.iter().enumerate();
            bits.filter(move |(_, bits)| *bits >> d & 1 == 1).map(|(n, _)| n as u32).collect::<Vec<u32>>()
        };
        mark(&held(0), |b| &mut b.held[0]);
        mark(&held(1), |b| &mut b.held[1]);
        mark(&held(2), |b| &mut b.held[2]);
        let (mut surface_lines, mut boundary) = (0, 0);
        for line in &mut self.lines {
            line.has_rim = line.batches.iter().any(|b| b.rim != 0);
            line.plain = line.batches.iter().all(|b| b.rim == 0 && b.held == [0; 3]);
            if line.batches.iter().any(|b| b.surface != 0) {
                line.surface = Some(surface_lines);
                surface_lines += 1;
            }
            for batch in line.batches.iter_mut().filter(|b| b.rim | b.surface != 0) {
                batch.boundary = boundary as u32;
                boundary += self.width;
            }
        }
        (surface_lines, boundary)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use std::path::Path;

    /// Batches of one class, however many, share an entry; classes that no batch has to itself have none.
    #[test]
    fn the_table_of_shapes_has_what_batches_need_and_no_more() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lat100_straight.toml");
        let ring = Model::new(&Scene::load(&file, &[]).unwrap()).unwrap();
        let entries = |model: &Model| {
            let layout = Layout::new(model, true, 8);
            let batches = layout.items.iter().flat_map(Item::shapes);
            assert!(batches.clone().all(|entry| (*entry as usize) < layout.shapes.len()));
            let mut used: Vec<u32> = batches.copied().collect();
            let count = used.len();
            used.sort_unstable();
            used.dedup();
            assert_eq!(used.len(), layout.shapes.len());
            (layout.shapes.len(), count)
        };
        // A class a layer of the ring, and batches from one layer's last elements into the next one's first.
        let (shapes, batches) = entries(&ring);
        assert!(shapes < 2 * ring.classes.len() && batches >= 110, "{shapes} of {batches}");
        // As many classes as elements: no entry but the batches'.
        let mut own = ring.clone();
        own.class_of = (0..own.element_count() as u32).collect();
        own.classes = own.class_of.iter().map(|_| ring.classes[0]).collect();
        let (shapes, batches) = entries(&own);
        assert_eq!(shapes, batches);
    }
}

//! From a model to what the passes read, in stages. Each takes what the ones before it made, and changes none of it:
//!
//! ```text
//! chains -> Lines -> Groups -> shares -> Slots -> Plan
//!             \-> Roles --------^------------------^
//! ```
//!
//! | stage | says |
//! |---|---|
//! | [`chains`] (`model/chains.rs`) | which elements follow each other along xi |
//! | [`Lines`] | on which line, at which index, every node is; which chains lie on four lines, which elements are loose |
//! | [`Roles`] | which lanes of a line are the rim's, near the road, or held |
//! | [`Groups`] | which chains are joined to an item, which items make a group, from which to which item a line is touched |
//! | [`shares`] | which items a thread takes, and after which item a line's nodes move |
//! | [`Slots`] | where among the forces each group adds up what its rows give a line |
//! | [`Plan`] | all of it by place in memory |
//!
//! Only shares and slots depend on the number of threads, and no sum depends on either: forces are added row by row
//! within a group, group by group within a line.

mod groups;
mod lines;
mod places;
mod roles;
mod schedule;
mod shapes;
mod slots;

pub use schedule::{Share, Task};

use crate::kernels::{DrivenPart, Item, Line, Sizes};
use crate::model::Model;
use crate::model::chains::chains;
use groups::Groups;
use lines::Lines;
use places::{items, placed_lines};
use roles::Roles;
use schedule::shares;
use shapes::Shapes;
use slots::Slots;

/// A step of a body, laid out for lanes of one width and for so many threads.
#[derive(Debug, Clone)]
pub struct Plan {
    pub items: Vec<Item>,
    pub lines: Vec<Line>,
    /// Work of each thread.
    pub shares: Vec<Share>,
    /// The table of shapes: the class of every lane.
    pub shapes: Vec<shapes::Lanes>,
    /// Place of every node in arrays by place, and their length.
    pub place: Vec<u32>,
    pub places: usize,
    /// Length of the force arrays.
    pub forces: usize,
    /// Lines that can touch the road.
    pub surface_lines: usize,
    /// Lanes of batches of nodes with rim or surface nodes.
    pub boundary: usize,
    /// Batches of nodes with driven ones: their parts.
    pub driven: Vec<Vec<DrivenPart>>,
}

impl Plan {
    /// Lengths of the arrays that its steps write, with so many surface nodes, and so many numbers that a batch remembers.
    pub fn sizes(&self, surface_nodes: usize, memory: usize) -> Sizes {
        Sizes {
            places: self.places,
            forces: self.forces,
            items: self.items.len(),
            memory: memory * self.items.iter().map(|item| item.shapes().len()).sum::<usize>(),
            lines: self.lines.len(),
            surface_lines: self.surface_lines,
            surface_nodes,
            driven: self.driven.len(),
        }
    }

    /// Lays a model out for lanes of `width` and `threads` threads; `road`: surface nodes can touch.
    pub fn new(model: &Model, road: bool, width: usize, threads: usize) -> Plan {
        let hexes = &model.mesh.hexes;
        let chains = chains(hexes, model.node_count());
        let lines = Lines::new(chains, hexes, model.node_count(), width);
        let roles = Roles::new(&lines, &model.mesh, road, width);
        let groups = Groups::new(&lines, hexes, width);
        let shares = shares(&groups, &roles.of_lines, threads);
        let slots = Slots::new(&lines.lines, &groups, &shares);
        let mut shapes = Shapes::new(&model.class_of);
        let items = items(&lines, hexes, groups, &slots, &mut shapes, width);
        let place = (0..model.node_count() as u32).map(|n| lines.place(n)).collect();
        let Roles { of_lines: roles, surface_lines, boundary, driven } = roles;
        let (places, forces) = (lines.places, slots.length);
        let lines = placed_lines(lines, roles, slots);
        let shapes = shapes.into_entries();
        Plan { items, lines, shares, shapes, place, places, forces, surface_lines, boundary, driven }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use std::path::Path;

    /// A shipped scene's body with so many elements.
    pub fn body(scene: &str, elements: [usize; 3]) -> Model {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{scene}.toml"));
        let elements = format!("body.mesh.elements={elements:?}");
        Model::new(&Scene::load(&file, &[elements]).unwrap()).unwrap()
    }

    /// The drawing in `cpu/mod.rs`, with rows long enough to be groups of their own.
    #[test]
    fn two_rows_share_a_line_and_one_takes_the_slot_of_the_other() {
        let model = body("bouncing_block", [40, 1, 2]);
        let plan = Plan::new(&model, true, 4, 1);
        let [Item::Rows(first), Item::Rows(second)] = &plan.items[..] else { panic!("{:?}", plan.items) };
        assert_eq!([first.rows.len(), second.rows.len()], [1, 1]);
        // Corners 0-1 and 3-2 lie below, 4-5 and 7-6 above.
        let (below, above) = (&first.rows[0], &second.rows[0]);
        assert_eq!([below.x[2], below.x[3]], [above.x[0], above.x[1]], "line b");
        let line = |place: usize| plan.lines.iter().position(|line| line.start == place).unwrap() as u32;
        let moves = |places: &[usize]| places.iter().map(|x| Task::Move(line(*x))).collect::<Vec<Task>>();
        let tasks = [
            vec![Task::Forces(0)],
            moves(&below.x[..2]),
            vec![Task::Forces(1)],
            moves(&above.x[..2]),
            moves(&above.x[2..]),
        ];
        let [share] = &plan.shares[..] else { panic!() };
        assert_eq!(share.early, tasks.concat());
        assert!(share.late.is_empty());
        // Line a's slots go to line b, whose own from the first row are still needed; line c gets new ones.
        let sorted = |mut slots: [usize; 2]| {
            slots.sort_unstable();
            slots
        };
        assert_eq!(sorted([below.f[0], below.f[1]]), sorted([above.f[0], above.f[1]]));
        assert!(above.f[2..].iter().all(|slot| !below.f.contains(slot)));
        for k in 0..2 {
            let b = &plan.lines[line(above.x[k]) as usize];
            assert_eq!(b.slots, [below.f[k + 2], above.f[k]], "first row's, then second row's");
        }
        assert_eq!((below.add, above.add), ([false; 4], [false; 4]));
        // Two threads: line b waits for both, and its slots are nobody else's.
        let plan = Plan::new(&model, true, 4, 2);
        assert_eq!(plan.shares.iter().flat_map(|share| &share.late).count(), 2);
        let mut slots: Vec<usize> = plan.lines.iter().flat_map(|line| line.slots.iter().copied()).collect();
        slots.sort_unstable();
        assert!(slots.windows(2).all(|pair| pair[0] < pair[1]), "{slots:?}");
        assert_eq!(slots.len(), 8);
    }

    /// Batches of one class, however many, share an entry; classes that no batch has to itself have none.
    #[test]
    fn the_table_of_shapes_has_what_batches_need_and_no_more() {
        let ring = body("lat100_straight", [44, 4, 5]);
        let entries = |model: &Model| {
            let plan = Plan::new(model, true, 8, 1);
            let batches = plan.items.iter().flat_map(Item::shapes);
            assert!(batches.clone().all(|entry| (*entry as usize) < plan.shapes.len()));
            let mut used: Vec<u32> = batches.copied().collect();
            let count = used.len();
            used.sort_unstable();
            used.dedup();
            assert_eq!(used.len(), plan.shapes.len());
            (plan.shapes.len(), count)
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

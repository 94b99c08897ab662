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

use super::layout::{Item, Line};
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
}

impl Plan {
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
        let Roles { of_lines: roles, surface_lines, boundary } = roles;
        let (places, forces) = (lines.places, slots.length);
        let lines = placed_lines(lines, roles, slots);
        let shapes = shapes.into_entries();
        Plan { items, lines, shares, shapes, place, places, forces, surface_lines, boundary }
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

//! A compiled body: its plan with the numbers that go with it. Constant while steps are taken.

use super::plan::{Plan, Share};
use super::tables::{boundary, driven, masses, shape_table, sub64};
use crate::kernels::elements::Elements;
use crate::kernels::{Field, Item, Nodes, Passes};
use crate::model::Model;
use crate::physics::scalar::Real;

/// Passes, tables and the work of each thread.
pub struct Program<T> {
    pub passes: Passes<T>,
    pub elements: Elements<T>,
    pub nodes: Nodes<T>,
    /// Work of each thread.
    pub shares: Vec<Share>,
    /// Place of every node of the mesh.
    pub place: Vec<u32>,
    /// Line of each rim node, and its index in it.
    pub rim_nodes: Vec<(usize, usize)>,
}

impl<T: Real> Program<T> {
    /// A plan of a model with the numbers of these `surface` nodes.
    pub fn new(model: &Model, plan: Plan, surface: &[u32], passes: Passes<T>) -> Self {
        let width = passes.width;
        let shapes = shape_table(model, &plan, width, passes.elements.numbers());
        let [mass, inverse_mass] = masses(model, &plan);
        let (surface_of, rim_arms) = boundary(model, &plan, surface, width);
        let rim_nodes = rim_nodes(model, &plan);
        let driven = driven(model, &plan, width);
        let Plan { items, lines, shares, place, .. } = plan;
        let inverse_area = Vec::new();
        let first_batch = first_batches(&items);
        Program {
            passes,
            elements: Elements { items, first_batch, shapes },
            nodes: Nodes { lines, mass, inverse_mass, surface_of, rim_arms, inverse_area, driven },
            shares,
            place,
            rim_nodes,
        }
    }
}

impl<T: Real> Program<T> {
    /// Puts values by node at their places, and on the lanes beyond the end of a line its nodes over again, so that
    /// no lane computes with anything but a body's numbers.
    pub fn fill(&self, field: &mut Field<T>, values: &[[f64; 3]], origin: [f64; 3]) {
        for line in &self.nodes.lines {
            for (i, &n) in line.nodes.iter().cycle().take(line.length).enumerate() {
                field.set(line.start + i, sub64(values[n as usize], origin));
            }
        }
    }

    /// Clears the slots that are added to lane by lane.
    pub fn clear_loose(&self, f: &mut Field<T>) {
        for line in self.nodes.lines.iter().filter(|l| l.loose) {
            for &slot in &line.slots {
                for d in 0..3 {
                    f.component_mut(d)[slot..slot + line.length].fill(T::zero());
                }
            }
        }
    }
}

/// Numbers of the items' first batches, and of all batches at the end.
fn first_batches(items: &[Item]) -> Vec<usize> {
    let mut first = vec![0];
    for item in items {
        first.push(first[first.len() - 1] + item.shapes().len());
    }
    first
}

/// Line and index in it of every node of the rim, in the mesh's order.
fn rim_nodes(model: &Model, plan: &Plan) -> Vec<(usize, usize)> {
    let mut at = vec![(0, 0); model.node_count()];
    for (number, line) in plan.lines.iter().enumerate() {
        for (i, &n) in line.nodes.iter().enumerate() {
            at[n as usize] = (number, i);
        }
    }
    model.mesh.rim.iter().map(|&n| at[n as usize]).collect()
}

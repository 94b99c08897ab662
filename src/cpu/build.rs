//! What a model becomes for the CPU engine: tables by place, line and lane.

use super::energies::Stored;
use super::layout::Layout;
use super::nodes::{NO_SURFACE, Nodes};
use super::rim::RimState;
use super::state::{Aligned, Field};
use crate::model::mesh::Mesh;
use crate::model::{Model, areas};
use crate::physics::lanes::Level;
use crate::physics::scalar::Real;
use crate::scene::Road;
use std::ops::Range;

/// Data of the node pass for lanes of `width`.
pub fn nodes<T: Real>(
    model: &Model,
    layout: &Layout,
    surface: &[u32],
    level: Level,
    width: usize,
) -> Nodes<T> {
    let place = |n: u32| layout.place[n as usize] as usize;
    let (mut mass, mut inverse_mass) = (Aligned::zeros(layout.places), Aligned::zeros(layout.places));
    for (n, &m) in model.mass.iter().enumerate() {
        mass.slice_mut()[place(n as u32)] = T::from_f64(m);
        inverse_mass.slice_mut()[place(n as u32)] = T::from_f64(1.0 / m);
    }
    let mut boundary_of = vec![0; model.node_count()];
    for line in &layout.lines {
        for (batch, nodes) in line.batches.iter().zip(line.nodes.chunks(width)) {
            nodes.iter().zip(batch.boundary..).for_each(|(&n, at)| boundary_of[n as usize] = at as usize);
        }
    }
    let mut surface_of = vec![NO_SURFACE; layout.boundary];
    for (k, &n) in surface.iter().enumerate() {
        surface_of[boundary_of[n as usize]] = k as u32;
    }
    let mut rim_arms = Field::zeros(layout.boundary);
    for &n in &model.mesh.rim {
        rim_arms.set(boundary_of[n as usize], sub64(model.mesh.nodes[n as usize], model.mesh.axle));
    }
    Nodes {
        lines: layout.lines.clone(),
        mass,
        inverse_mass,
        surface_of,
        rim_arms,
        inverse_area: Vec::new(),
        level,
    }
}

pub fn stored(model: &Model, layout: &Layout, level: Level, width: usize) -> Stored {
    Stored {
        composition: model.composition(),
        level,
        classes: model.classes.clone(),
        shapes: layout.shapes.clone(),
        width,
    }
}

/// Reference geometry by lanes: these numbers of every class, one after the other.
pub fn shape_table<T: Real>(
    model: &Model,
    layout: &Layout,
    width: usize,
    numbers: Range<usize>,
) -> Aligned<T> {
    let length = numbers.len();
    let mut table = Aligned::zeros(layout.shapes.len() * length * width);
    for (lanes, part) in layout.shapes.iter().zip(table.slice_mut().chunks_exact_mut(length * width)) {
        for (lane, class) in lanes[..width].iter().enumerate() {
            let of_class = &model.classes[*class as usize].numbers()[numbers.clone()];
            for (i, number) in of_class.iter().enumerate() {
                part[i * width + lane] = T::from_f64(*number);
            }
        }
    }
    table
}

/// Line and index in it of every node of the rim, in the mesh's order.
pub fn rim_nodes(model: &Model, layout: &Layout) -> Vec<(usize, usize)> {
    let mut at = vec![(0, 0); model.node_count()];
    for (number, line) in layout.lines.iter().enumerate() {
        for (i, &n) in line.nodes.iter().enumerate() {
            at[n as usize] = (number, i);
        }
    }
    model.mesh.rim.iter().map(|&n| at[n as usize]).collect()
}

pub fn rim_state(model: &Model) -> RimState {
    let mass = |n: &u32| model.mass[*n as usize];
    let axle = model.mesh.axle;
    let [x, y, z] = axle;
    let rim = &model.mesh.rim;
    let arm2 = |n: &u32| {
        let arm = sub64(model.mesh.nodes[*n as usize], axle);
        arm[0] * arm[0] + arm[2] * arm[2]
    };
    RimState {
        q: [x, y, z, 0.0, 0.0, 0.0],
        rate: [0.0; 6],
        node_mass: rim.iter().map(mass).sum(),
        node_inertia: rim.iter().map(|n| mass(n) * arm2(n)).sum(),
    }
}

pub fn inverse_areas<T: Real>(mesh: &Mesh, x: impl Fn(u32) -> [f64; 3], road: &Road) -> Vec<T> {
    areas::inverse_areas(mesh, x, road).into_iter().map(T::from_f64).collect()
}

pub fn sub64(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|d| a[d] - b[d])
}

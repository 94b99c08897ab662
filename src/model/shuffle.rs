//! The same mesh with its nodes and elements in random order, or its nodes in other places, as an imported mesh might
//! come.

use crate::model::Model;
use crate::physics::tensor::{dot, sub};
use crate::scene::Body;

/// How far a node of a distorted mesh is moved along each direction, over the shortest edge.
const DISTORTION: f64 = 0.05;

/// Fixed pseudo-random numbers of 31 bits: xorshift64*, its upper bits.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33
    }
}

/// A fixed pseudo-random order of `count` things.
fn order(count: usize, seed: u64) -> Vec<usize> {
    let mut random = Random(seed);
    let mut order: Vec<usize> = (0..count).collect();
    for i in (1..count).rev() {
        order.swap(i, random.next() as usize % (i + 1));
    }
    order
}

/// `model` with every node that neither the road nor the rim touches moved a little.
pub fn distorted(model: &Model, body: &Body) -> Model {
    let mut mesh = model.mesh.clone();
    let edges = |hex: &[u32; 8]| [(0, 1), (0, 3), (0, 4)].map(|(a, b)| [hex[a], hex[b]]);
    let length = |[a, b]: [u32; 2]| {
        let edge = sub(model.mesh.nodes[b as usize], model.mesh.nodes[a as usize]);
        dot(edge, edge).sqrt()
    };
    let shortest = mesh.hexes.iter().flat_map(edges).map(length).fold(f64::INFINITY, f64::min);
    let mut stays = vec![false; mesh.nodes.len()];
    mesh.surface.iter().chain(&mesh.rim).for_each(|&n| stays[n as usize] = true);
    let mut random = Random(0xb529_7a4d_3f84_d5b5);
    for (x, _) in mesh.nodes.iter_mut().zip(stays).filter(|(_, stays)| !stays) {
        let share = |random: &mut Random| 2.0 * random.next() as f64 / f64::from(1u32 << 31) - 1.0;
        *x = x.map(|c| c + DISTORTION * shortest * share(&mut random));
    }
    Model::from_mesh(mesh, body).expect("a twentieth of an edge turns no element inside out")
}

/// `model` with new numbers for nodes and elements.
pub fn shuffled(model: &Model, body: &Body) -> Model {
    let mut mesh = model.mesh.clone();
    let number = order(mesh.nodes.len(), 0x9e37_79b9_7f4a_7c15);
    for (from, &to) in number.iter().enumerate() {
        mesh.nodes[to] = model.mesh.nodes[from];
    }
    let renamed = |n: &u32| number[*n as usize] as u32;
    let sorted = |nodes: &[u32]| {
        let mut nodes: Vec<u32> = nodes.iter().map(renamed).collect();
        nodes.sort_unstable();
        nodes
    };
    (mesh.rim, mesh.surface) = (sorted(&mesh.rim), sorted(&mesh.surface));
    mesh.facets.iter_mut().for_each(|f| *f = f.map(|n| renamed(&n)));
    let elements = order(mesh.hexes.len(), 0xd1b5_4a32_d192_ed03);
    mesh.hexes = elements.iter().map(|&e| model.mesh.hexes[e].map(|n| renamed(&n))).collect();
    Model::from_mesh(mesh, body).expect("the order of elements does not turn one inside out")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use std::path::Path;

    /// The paper's wheel of 880 elements.
    fn wheel() -> (Model, Body) {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lat100_straight.toml");
        let scene = Scene::load(&file, &[]).unwrap();
        (Model::new(&scene).unwrap(), scene.body)
    }

    /// Only nodes inside move, and no two elements with one of them are alike.
    #[test]
    fn a_distorted_mesh_has_as_many_shapes_as_elements() {
        let (model, body) = wheel();
        let other = distorted(&model, &body);
        assert_eq!(other.mesh.hexes, model.mesh.hexes);
        let outside = || model.mesh.surface.iter().chain(&model.mesh.rim).map(|&n| n as usize);
        assert!(outside().all(|n| other.mesh.nodes[n] == model.mesh.nodes[n]));
        let mut is_inside = vec![true; model.node_count()];
        outside().for_each(|n| is_inside[n] = false);
        let moved = model.mesh.hexes.iter().filter(|h| h.iter().any(|&n| is_inside[n as usize])).count();
        assert!(moved > 800, "{moved} elements have a node inside");
        assert!(
            (moved..=moved + model.classes.len()).contains(&other.classes.len()),
            "{}",
            other.classes.len()
        );
        assert!(!other.is_extruded());
    }

    /// New numbers, the same body: elements at the same places.
    #[test]
    fn a_shuffled_mesh_is_the_same_body() {
        let (model, body) = wheel();
        let other = shuffled(&model, &body);
        let corners = |m: &Model| {
            let mut all: Vec<_> =
                m.mesh.hexes.iter().map(|h| h.map(|n| m.mesh.nodes[n as usize].map(f64::to_bits))).collect();
            all.sort_unstable();
            all
        };
        assert!(other.mesh.hexes != model.mesh.hexes && corners(&other) == corners(&model));
        assert_eq!(other.mesh.surface.len(), model.mesh.surface.len());
    }
}

//! The same mesh with its nodes and elements in random order, as an imported mesh might come.

use crate::model::Model;
use crate::scene::Body;

/// A fixed pseudo-random order of `count` things.
fn order(count: usize, seed: u64) -> Vec<usize> {
    let mut state = seed;
    let mut random = |below: usize| {
        // Xorshift64*; its upper bits.
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        ((state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize) % below
    };
    let mut order: Vec<usize> = (0..count).collect();
    for i in (1..count).rev() {
        order.swap(i, random(i + 1));
    }
    order
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

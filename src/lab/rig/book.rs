//! Forces of `q1p0` as a textbook writes them.
#![allow(non_snake_case)] // X: the field's own symbol

use hexroll::model::Model;
use hexroll::physics::element::{Corners, textbook};
use hexroll::physics::material::{Hyperelastic, Law, WithLaw};

struct Book<'a> {
    X: &'a Corners<f64>,
    x: &'a Corners<f64>,
}

impl WithLaw for Book<'_> {
    type Output = Corners<f64>;
    fn with<L: Hyperelastic>(self, law: L) -> Corners<f64> {
        textbook::q1p0(&law, self.X, self.x)
    }
}

/// Forces of the corners [N] of an element at reference positions `X` and positions `x` [m].
pub fn book(law: &Law, X: &Corners<f64>, x: &Corners<f64>) -> Corners<f64> {
    law.visit(Book { X, x })
}

/// Internal forces of all nodes [N] at positions `x` [m], shape `[node_count]`.
pub fn by_the_book(model: &Model, x: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut forces = vec![[0.0; 3]; x.len()];
    for hex in &model.mesh.hexes {
        let f = book(&model.law, &hex.map(|n| model.mesh.nodes[n as usize]), &hex.map(|n| x[n as usize]));
        for (&n, f) in hex.iter().zip(f) {
            (0..3).for_each(|d| forces[n as usize][d] += f[d]);
        }
    }
    forces
}

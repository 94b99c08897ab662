//! A box with a corner at the origin.

use super::grading::share;
use super::grid::{Face, Grid};
use super::words::{self, mm};
use crate::model::mesh::{Lattice, Mesh};
use crate::scene::Grading;

const SETS: [Face; 6] = [
    Face { name: "x-min", meaning: "face x-min", direction: 0, far: false },
    Face { name: "x-max", meaning: "face x-max", direction: 0, far: true },
    Face { name: "y-min", meaning: "face y-min", direction: 1, far: false },
    Face { name: "y-max", meaning: "face y-max", direction: 1, far: true },
    Face { name: "z-min", meaning: "face z-min", direction: 2, far: false },
    Face { name: "z-max", meaning: "face z-max", direction: 2, far: true },
];

/// Edges of `size` [m] along +x, +y, +z.
pub fn mesh(size: [f64; 3], elements: [usize; 3], grading: &Grading) -> Mesh {
    let [x, y, z] = elements;
    let sizes = size.map(mm).join(" x ");
    let description = format!("block, {sizes} mm: {x} x {y} x {z} elements{}", words::grading(grading));
    grid(size, elements, grading).into_mesh(&SETS, size.map(|s| 0.5 * s), description)
}

fn grid(size: [f64; 3], elements: [usize; 3], grading: &Grading) -> Grid {
    let [nx, ny, nz] = elements;
    let mut nodes = Vec::with_capacity((nx + 1) * (ny + 1) * (nz + 1));
    for k in 0..=nz {
        for j in 0..=ny {
            for i in 0..=nx {
                let at = |c: usize, d: usize| size[d] * share(c, elements[d], grading.ratio[d]);
                nodes.push([at(i, 0), at(j, 1), at(k, 2)]);
            }
        }
    }
    Grid { lattice: Lattice { elements, closed: false }, nodes }
}

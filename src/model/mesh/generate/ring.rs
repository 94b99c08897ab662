//! A thick-walled cylinder whose axle is along y.

use std::f64::consts::TAU;

use super::grading::{share, share_from_ends, turn};
use super::grid::{Face, Grid};
use super::words::{self, mm};
use crate::model::mesh::{Lattice, Mesh};
use crate::scene::Grading;

const SETS: [Face; 4] = [
    Face { name: "inner", meaning: "inner cylinder", direction: 2, far: false },
    Face { name: "outer", meaning: "outer cylinder", direction: 2, far: true },
    Face { name: "y-min", meaning: "face y-min", direction: 1, far: false },
    Face { name: "y-max", meaning: "face y-max", direction: 1, far: true },
];

/// Touches z = 0 with a row of nodes below its axle; `elements` along the circumference, the radius, the width.
pub fn mesh([outer, inner]: [f64; 2], width: f64, elements: [usize; 3], grading: &Grading) -> Mesh {
    let [c, r, w] = elements;
    let description = format!(
        "ring, radii {} and {} mm, width {} mm: {c} x {r} x {w} elements (circumference, radius, width){}",
        mm(outer),
        mm(inner),
        mm(width),
        words::grading(grading)
    );
    grid([outer, inner], width, elements, grading).into_mesh(&SETS, [0.0, 0.0, outer], description)
}

/// Logical directions: i along the circumference, j along the width, k along the radius, so that rows around the ring
/// are contiguous, layers of equal shape too, and (i, j, k) is right-handed.
fn grid([outer, inner]: [f64; 2], width: f64, [nc, nr, nw]: [usize; 3], grading: &Grading) -> Grid {
    let [around, through, across] = grading.ratio;
    let mut nodes = Vec::with_capacity(nc * (nr + 1) * (nw + 1));
    for k in 0..=nr {
        let radius = inner + (outer - inner) * share(k, nr, through);
        for j in 0..=nw {
            let y = width * (share_from_ends(j, nw, across) - 0.5);
            for i in 0..nc {
                // Node 0 at the bottom, then towards -x: a turn about +y.
                let (sin, cos) = (TAU * turn(i, nc, around, grading.fine_arc)).sin_cos();
                nodes.push([-radius * sin, y, outer - radius * cos]);
            }
        }
    }
    Grid { lattice: Lattice { elements: [nc, nw, nr], closed: true }, nodes }
}

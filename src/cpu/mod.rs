//! The reference engine: the same passes in the same order as the GPU's, in f64 or f32, on any number of threads
//! with the same bits.
//!
//! A model is compiled to a [`plan::Plan`] once; a team of threads then goes through its tasks in every step.
//!
//! # How elements and nodes lie
//!
//! A *row* is a chain of elements along xi. Its corners lie on four *lines* of nodes, of which a look along eta shows two. Here
//! are two rows on three lines, for lanes of 4:
//!
//! ```text
//! line c   c0---c1---c2---c3---c4---c5---c6      a batch     reads of line b
//!          | e6 | e7 | e8 | e9 | e10| e11|       e0 e1 e2 e3   back  b0 b1 b2 b3   a vector from b0
//! line b   b0---b1---b2---b3---b4---b5---b6                    front b1 b2 b3 b4   a vector from b1
//!          | e0 | e1 | e2 | e3 | e4 | e5 |       and gives     back  B0 B1 B2 B3
//! line a   a0---a1---a2---a3---a4---a5---a6                    front F0 F1 F2 F3
//! ```
//!
//! No indices: lane l of a batch reads entry i + l of a line for its back corners (xi = -1) and entry i + l + 1 for its front ones.
//! What it gives its front corners belongs one lane further up, where the next element's back corners are; the last lane's is
//! the *carry* into the next batch. A node gets the forces of both its neighbours in the row in one addition:
//!
//! ```text
//! to line b    b0       b1       b2       b3     |  b4
//! e0 .. e3     B0 + 0   B1 + F0  B2 + F1  B3 + F2|
//! carry                                          |  F3
//! e4 ..                                          |  B4 + F3 ..
//! ```
//!
//! A closed row (around a ring) adds its last carry to its first node, and its lines have a copy of their first node behind the
//! last one. The second batch takes e4 and e5, and in the lanes that are left e6 and e7 of the next row, where the
//! plan has joined the two. Elements whose nodes fit on no line are *loose*: copied together lane by lane.
//!
//! # Whose forces are added to what
//!
//! Rows come in *groups*, and a line has a *slot* among the forces for every group that touches it. Row by row within a group,
//! group by group within a line: the order of sums depends on the mesh alone. Let each of the two rows be a group. One thread
//! goes through their tasks so, and slot 0 is taken again once the nodes of line a have moved:
//!
//! ```text
//! task      forces of e0..e5   move a   forces of e6..e11   move b   move c
//! slot 0    a, from group 0    read     b, from group 1     read
//! slot 1    b, from group 0                                 read
//! slot 2                                c, from group 1              read
//! ```
//!
//! The force on line b is slot 1 + slot 0: group 0's, then group 1's. With two threads, one a group, line b waits for both: it
//! moves late, after they have met, and keeps its slots to itself.
//!
//! # What it holds
//!
//! With t bytes a number (8 or 4), lanes of width w:
//!
//! | for every | bytes |
//! |---|---|
//! | node | 14 t (positions, velocities, both once more for a step that fails, mass and its inverse), 8 (place, number), 24/w (roles of a batch); a line is filled up to whole vectors and one more |
//! | slot | 3 t a node of its line: a few layers of lines where one thread finishes them, else a line's length times the groups at it |
//! | element | 4 (its number), 16/w (its batch and shape) |
//! | row, item | 80 and 128 |
//! | line | 1728 (window sums by lane, twice while a sample is taken), about 150 |
//! | surface node | 116, and t where friction looks at pressure; 4 + 3 t a lane of every batch that has one |
//! | entry of the table of shapes | w t times the numbers of a class that the element routine reads |
//!
//! # Who knows whom
//!
//! A file knows those below it that it names, and none above it:
//!
//! ```text
//! engine      the trait of engines: windows, states, failures
//! steps       a team goes through early and late tasks      course   the steps to take, and the rim meanwhile
//! program     the plan with its passes and tables           team     threads that meet
//! tables      masses, shapes, arms by place and lane        energies stored energies of a sample
//! plan/*      from a model to items, lines, shares          world    conditions of a step
//! sums        of all lines                                  rim      its own equation of motion
//! watch       states that are kept after every step
//! ```
//!
//! and below them the crate of kernels (`src/kernels`):
//!
//! ```text
//! elements    forces of an item: fetch -> formulation -> scatter
//! nodes       a step of a line: touch (contact), books (works)
//! shared      arrays that threads write, and the contract
//! layout      items and lines                               conditions of a step
//! rows        batches of lanes                              sums     of a line
//! state       aligned arrays
//! ```

mod course;
mod driven;
mod energies;
mod engine;
pub mod memory;
mod plan;
mod program;
mod rim;
mod steps;
mod sums;
mod tables;
mod team;
mod watch;
mod world;

pub use engine::CpuEngine;

use crate::engine::Engine;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::physics::lanes::Level;
use crate::physics::scalar::Real;
pub use crate::precision::Precision;
use crate::scene::Scene;

/// What the CPU engine computes in.
pub const PRECISIONS: [Precision; 2] = [Precision::F64, Precision::F32];

/// The precision of numbers of type `T`.
fn precision_of<T: Real>() -> Precision {
    if T::SINGLE { Precision::F32 } else { Precision::F64 }
}

/// A CPU engine at rest in the reference shape. `threads` = 0: all cores. Compiled once, here: callers do not each
/// instantiate every kernel.
///
/// # Errors
/// [`Error::Unsupported`] for a precision that is not in [`PRECISIONS`]; [`Error::Memory`] if it does not fit.
pub fn engine(model: &Model, scene: &Scene, precision: Precision, threads: usize) -> Result<Box<dyn Engine>> {
    engine_at(model, scene, precision, threads, Level::detect())
}

/// The same with chosen instructions.
///
/// # Errors
/// As [`engine`].
pub fn engine_at(
    model: &Model,
    scene: &Scene,
    precision: Precision,
    threads: usize,
    level: Level,
) -> Result<Box<dyn Engine>> {
    crate::memory::ensure(scene, |scene| memory::engine(scene, precision).into())?;
    match precision {
        Precision::F64 => Ok(Box::new(CpuEngine::<f64>::with_level(model, scene, threads, level))),
        Precision::F32 => Ok(Box::new(CpuEngine::<f32>::with_level(model, scene, threads, level))),
        Precision::F32Plus => Err(Error::Unsupported {
            what: format!("--precision {precision} on the CPU engine"),
            instead: "use f64 or f32 there, or --engine gpu".into(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use crate::engine::SurfaceSum;
    use crate::kernels::{Batch, LineSums, NodeBatch, Row};

    /// The table of bytes above.
    #[test]
    fn sizes_are_as_documented() {
        let sizes = [size_of::<NodeBatch>(), size_of::<Batch>(), size_of::<Row>(), size_of::<LineSums>()];
        assert_eq!(sizes, [28, 12, 80, 1728]);
        // With the node's number and its last step in contact.
        assert_eq!(size_of::<SurfaceSum>() + 4 + 8, 116);
    }
}

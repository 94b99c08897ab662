//! What is hot on a CPU, written once over lanes: the element and the node pass of a step, stored energies, and tangents.
//!
//! Generic code alone: crates beside this one (`portable/`, `avx2/`, `avx512/`) compile it for a level of instructions each, so
//! that a build has several to work on at once, and nothing of it is compiled again when the rest of the program changes.
#![allow(non_snake_case)] // F, J, W, N: the field's own symbols
#![allow(rustdoc::broken_intra_doc_links)] // units are written [m], [N s]

mod books;
mod conditions;
mod dual;
pub mod elements;
pub mod energies;
mod fetch;
mod layout;
pub mod memory;
pub mod nodes;
mod rows;
mod scatter;
mod shared;
mod state;
mod sums;
pub mod tangents;
mod touch;

use hexroll_physics as physics;

pub use conditions::Conditions;
pub use layout::{Driven, DrivenPart, DrivenPose, Item, Line, Loose, NodeBatch, Nodes};
pub use rows::{Batch, Row, Rows, runs};
pub use shared::{Arrays, Shared, Sizes};
pub use state::{Aligned, Field};
pub use sums::{LineContact, LineSums, SurfaceSum};

use elements::ElementPass;
use energies::EnergyPass;
use nodes::NodePass;
use physics::element::Composition;
use physics::lanes::Instructions;
use physics::scalar::Real;
use tangents::TangentPass;

/// The passes of a step in precision `T`.
pub struct Passes<T> {
    pub elements: Box<dyn ElementPass<T>>,
    pub nodes: Box<dyn NodePass<T>>,
    /// Lanes of a batch, of elements and of nodes.
    pub width: usize,
}

impl<T: Real> Passes<T> {
    /// For these instructions; `extruded`: all elements are plane figures extruded along eta.
    pub fn new(instructions: impl Instructions, composition: &Composition, extruded: bool) -> Self {
        Passes {
            elements: elements::compose(instructions, composition, extruded),
            nodes: nodes::compose(instructions),
            width: instructions.width::<T>(),
        }
    }
}

/// Everything that a level of instructions offers: what the crates beside this one give, each compiled for its own.
pub trait Compiled: Send + Sync {
    fn passes_f64(&self, composition: &Composition, extruded: bool) -> Passes<f64>;
    fn passes_f32(&self, composition: &Composition, extruded: bool) -> Passes<f32>;
    fn energies(&self, composition: &Composition) -> Box<dyn EnergyPass>;
    fn tangents(&self, composition: &Composition) -> Box<dyn TangentPass>;
}

/// All of it for these instructions. Whoever makes a trait object of it compiles every kernel there is.
pub struct For<I>(pub I);

impl<I: Instructions> Compiled for For<I> {
    fn passes_f64(&self, composition: &Composition, extruded: bool) -> Passes<f64> {
        Passes::new(self.0, composition, extruded)
    }

    fn passes_f32(&self, composition: &Composition, extruded: bool) -> Passes<f32> {
        Passes::new(self.0, composition, extruded)
    }

    fn energies(&self, composition: &Composition) -> Box<dyn EnergyPass> {
        energies::compose(self.0, composition)
    }

    fn tangents(&self, composition: &Composition) -> Box<dyn TangentPass> {
        tangents::compose(self.0, composition)
    }
}

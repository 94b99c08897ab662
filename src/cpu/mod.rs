//! The reference engine: the same passes in the same order as the GPU's, in f64 or f32, on any number of threads
//! with the same bits.

mod build;
mod elements;
mod energies;
mod engine;
mod layout;
mod nodes;
mod reduce;
mod rim;
mod rows;
mod schedule;
mod slots;
mod state;
mod steps;
mod team;

pub use engine::CpuEngine;

use crate::engine::Engine;
use crate::model::Model;
use crate::physics::lanes::Level;
use crate::scene::Scene;

/// Floating-point type of the CPU engine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    F64,
    F32,
}

/// A CPU engine at rest in the reference shape. `threads` = 0: all cores. Compiled once, here: callers do not each
/// instantiate every kernel.
pub fn engine(model: &Model, scene: &Scene, precision: Precision, threads: usize) -> Box<dyn Engine> {
    engine_at(model, scene, precision, threads, Level::detect())
}

/// The same with chosen instructions.
pub fn engine_at(
    model: &Model,
    scene: &Scene,
    precision: Precision,
    threads: usize,
    level: Level,
) -> Box<dyn Engine> {
    match precision {
        Precision::F64 => Box::new(CpuEngine::<f64>::with_level(model, scene, threads, level)),
        Precision::F32 => Box::new(CpuEngine::<f32>::with_level(model, scene, threads, level)),
    }
}

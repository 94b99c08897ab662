//! The loop over an [`Engine`](crate::engine::Engine): stages, windows, steps; histories, fields and the critical step on
//! the way.
//!
//! [`run`] goes through the stages (`stages.rs`); a stage is made of windows of steps (`explicit.rs`) or of increments
//! (`implicit.rs`). What they change is in one place (`state.rs`), in parts that are plain data: the step (`control.rs`),
//! the rim (`motion.rs`), what is recorded (`recorder.rs`), rest (`settle.rs`) and the totals (`totals.rs`).

mod booking;
mod chatter;
mod control;
pub mod estimate;
mod explicit;
mod fields;
mod footprint;
mod histories;
mod implicit;
mod lanczos;
mod ledger;
mod motion;
mod observer;
mod pace;
mod recorder;
mod round_off;
mod scatter;
mod settle;
pub mod stability;
mod stages;
mod state;
mod totals;
mod velocities;

pub use booking::GARBAGE;
pub use ledger::Ledger;
pub use motion::Motion;
pub use observer::{Observer, Progress};
pub use round_off::RoundOff;
pub use stages::run;
pub use totals::{ImplicitCounts, Totals};

pub use crate::model::areas::contact_areas;

//! Everything a run leaves on disk, and how it is read back.
//!
//! A run's folder:
//!
//! | file | content | written |
//! |---|---|---|
//! | `.hexroll` | marks the folder as a run's; locked while the run writes | at the start |
//! | `scene.toml` | the scene's effective text, after `--set` | at the start |
//! | `history.csv` | one row a [`Sample`](crate::record::Sample), columns named after its fields | row by row |
//! | `snapshot_<k>.vtu` | whole fields: see [`snapshot`] | each whole, at once |
//! | `contact_<k>.csv` | nodes that touched during the last window before snapshot k: see [`contact`] | each whole, at once |
//! | `run.pvd` | times and names of the snapshots, for ParaView | after each snapshot |
//! | `implicit.csv` | one row an iteration of an implicit stage ([`NewtonRow`](crate::record::NewtonRow)) | increment by increment |
//! | `history_<name>.npz`, `.uff` | histories at a high rate: see [`history`] | each at once, at the end |
//! | `summary.json` | a [`Summary`] | at the end |
//! | `body*.png`, `footprint*.png` | pictures | by the renderer |
//!
//! A killed run leaves all of it readable but `summary.json`, which it lacks: files that are written at
//! once appear under their name only when complete, and a history row that was cut off is skipped.

pub mod compare;
pub mod contact;
pub mod folder;
pub mod history;
pub mod mesh;
mod pvd;
pub mod read;
pub mod rolling;
pub mod scatter;
pub mod snapshot;
pub mod spectrum;
pub mod stages;
pub mod summary;
pub mod vtu;
mod writer;

pub use rolling::Rolling;
pub use scatter::{ContactScatter, Verdict};
pub use summary::Summary;
pub use writer::RunWriter;

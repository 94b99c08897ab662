//! The command line as a user meets it: the built program, its files, its messages, its exit codes.

mod alarms;
mod beginning;
mod benching;
mod checking;
mod choosing;
mod comparing;
mod ending_early;
mod memory;
mod meshes;
mod mistakes;
mod pages;
mod program;
mod reporting;
mod running;
mod spectra;
mod studies;

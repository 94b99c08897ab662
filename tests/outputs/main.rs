//! What a run leaves on disk: complete, readable by others, readable after a kill, and comparable.
#![allow(non_snake_case)] // X, J: the field's own symbols

mod comparing;
mod damaged;
mod fixtures;
mod folders;
mod histories;
mod independent_reader;
mod round_trips;
mod summaries;

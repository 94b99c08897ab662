//! Meshes of other programs: what is read is what they wrote, and what is wrong is named.

mod damaged;
mod decks;
mod keywords;
mod materials;
mod quality;
mod rig;
mod round_trips;
mod same_wheel;
mod sections;

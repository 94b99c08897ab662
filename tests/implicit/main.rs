//! The implicit scheme: tangents, Newton's method, contact, friction, time.

mod fixtures;
mod tangents;
mod wheel_static;

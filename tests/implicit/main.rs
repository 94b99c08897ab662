//! The implicit scheme: tangents, Newton's method, contact, friction, time.

mod fixtures;
mod in_time;
mod tangents;
mod wheel_static;

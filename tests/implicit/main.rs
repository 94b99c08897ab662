//! The implicit scheme: tangents, Newton's method, contact, friction, time.

mod hard_cases;
mod in_time;
mod multigrid;
mod projected_multigrid;
mod runs;
mod scene_keys;
mod tangents;
mod wheel_static;

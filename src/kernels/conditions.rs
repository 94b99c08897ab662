//! What acts on the nodes of a body in one step.

use crate::physics::friction::Friction;
use crate::physics::node::{Loads, Prediction, StepSize};
use crate::physics::road::Road;
use crate::physics::tensor::Vec3;

/// Everything that is the same for all nodes of a step.
#[derive(Debug, Clone)]
pub struct Conditions<T> {
    pub step: StepSize<T>,
    pub loads: Loads<T>,
    pub prediction: Prediction<T>,
    /// Seen from the engine's frame, and whether it moves.
    pub road: Option<Road>,
    pub road_moves: bool,
    pub friction: Option<Friction>,
    /// Axle at the end of the step in the engine's frame and its mean velocity, rotation at the end and its mean rate
    /// (columns), axle at the start.
    pub axle: Vec3<T>,
    pub axle_velocity: Vec3<T>,
    pub rotation: [Vec3<T>; 3],
    pub rotation_rate: [Vec3<T>; 3],
    pub axle_before: Vec3<T>,
    /// Work of a force: f . (before v(n-1/2) + after v(n+1/2)).
    pub weights: [T; 2],
    /// Whether there is a body force, and mass damping: neither is booked otherwise.
    pub has_gravity: bool,
    pub has_damping: bool,
    /// Where the poses of driven sets begin that belong to the step.
    pub driven: usize,
    /// Number of the step, which touching nodes remember.
    pub number: u64,
}

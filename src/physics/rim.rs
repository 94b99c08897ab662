//! The rigid rim: six coordinates (axle x, y, z; steer, camber, spin), each prescribed or free.
//!
//! Orientation = steer about z, then camber about the new x, then spin about the new axle y.

use glam::{DMat3, DVec3};

/// Coordinates of the rim: axle point [m], then steer, camber, spin [rad].
pub type Coordinates = [f64; 6];

/// Index of the spin among the coordinates.
pub const SPIN: usize = 5;

/// Rotation from the reference to the current orientation.
pub fn rotation(q: &Coordinates) -> DMat3 {
    frame(q) * DMat3::from_rotation_y(q[SPIN])
}

/// Steer and camber only: what the wheel looks like before it spins.
pub fn frame(q: &Coordinates) -> DMat3 {
    DMat3::from_rotation_z(q[3]) * DMat3::from_rotation_x(q[4])
}

/// Unit vector along the axle.
pub fn axle_direction(q: &Coordinates) -> DVec3 {
    frame(q) * DVec3::Y
}

/// Angular velocity in fixed axes from the rates of the coordinates [rad/s].
pub fn angular_velocity(q: &Coordinates, rate: &Coordinates) -> DVec3 {
    let steer = DMat3::from_rotation_z(q[3]);
    DVec3::Z * rate[3] + steer * DVec3::X * rate[4] + axle_direction(q) * rate[SPIN]
}

/// Axle's position.
pub fn axle(q: &Coordinates) -> DVec3 {
    DVec3::new(q[0], q[1], q[2])
}

//! What is given of the paper's wheel: body, load and motion, once for tests, reports and benchmarks.
//!
//! Source: the University of Twente's paper on a tyre/road contact solver, LAT-100 wheel. The shipped `lat100_*` scenes
//! say the same in their own words (`tests/scenes/shipped.rs` compares). What comes out is in `references.toml`.

/// Mass density [kg/m3].
pub const DENSITY: f64 = 1100.0;
/// Shear modulus G [Pa].
pub const SHEAR_MODULUS: f64 = 2.64e6;
/// Bulk modulus kappa [Pa].
pub const BULK_MODULUS: f64 = 65.1e6;
/// Shear viscosity of the viscous runs [Pa s]: ours, the paper has none (tan delta 0.024 at 500 Hz).
pub const VISCOSITY: f64 = 20.0;
/// Hourglass stiffness of `uniform-gradient` over G: ours, the scenes' default.
pub const HOURGLASS: f64 = 0.15;

/// Outer radius [m].
pub const OUTER_RADIUS: f64 = 0.039;
/// Inner radius, where the rim holds it [m].
pub const INNER_RADIUS: f64 = 0.017;
/// Width along the axle [m].
pub const WIDTH: f64 = 0.0175;
/// The paper's mesh: elements along circumference, radius and width.
pub const MESH: [usize; 3] = [44, 4, 5];

/// How far the axle is pushed down [m].
pub const DEPTH: f64 = 2.2e-3;
/// Time in which it is [s]: ours.
pub const PRESSING: f64 = 0.02;
/// The force that finds the same depth [N].
pub const LOAD: f64 = 300.0;

/// Speed over the road [m/s].
pub const SPEED: f64 = 2.59;
/// Spin [rad/s]: 5 % more than free rolling.
pub const SPIN: f64 = 70.0;
/// Duration of the rolling run [s]; means are taken over its last 30 %.
pub const ROLLING: f64 = 0.1;
/// Velocity along x and y [m/s] of straight rolling.
pub const STRAIGHT: [f64; 2] = [SPEED, 0.0];
/// The same at a slip angle of 5 degrees, in the digits of the scene.
pub const AT_5_DEGREES: [f64; 2] = [2.5801, 0.2257];
/// The same at 45 degrees: faster, as in the paper.
pub const AT_45_DEGREES: [f64; 2] = [1.9, 1.9];

/// The paper's mesh with `n` times as many elements in every direction.
pub fn refined(n: usize) -> [usize; 3] {
    MESH.map(|count| n * count)
}

//! A thick-walled rubber cylinder in plane strain on a rigid plane, fine where it touches: the body of the line-contact
//! cases.

use crate::rig::{G, GROUND, HELD, explicit, hold, scene};
use hexroll::physics::material::NeoHookean;
use hexroll::scene::*;

/// Outer and rim radius [m].
pub const RADIUS: f64 = crate::rig::given::OUTER_RADIUS;
pub const INNER: f64 = 0.027;
/// kappa / G = 100 where friction matters: Dundurs' constant against a rigid plane is (1 - 2 nu) / (2 (1 - nu)) = 0.01.
pub const STIFF: Law = Law::NeoHookean(NeoHookean { g0: 100.0 * G, g1: G });
/// Edge of the elements that touch [m].
pub const EDGE: f64 = 1.5e-4;
/// Axial length of the slice: one element [m].
pub const WIDTH: f64 = 3e-4;
/// How deep the axle is pressed [m]: gives a half width near 1.5 mm.
pub const DEPTH: f64 = 6e-5;

/// The slice, rim held, with equal elements over `arc` [rad] at the bottom. No stages.
pub fn slice(law: Law, arc: f64, friction: Option<Friction>) -> Scene {
    let fine = (arc * RADIUS / EDGE).round();
    // Outside, sizes grow by a tenth from element to element.
    let around = fine as usize + 90;
    let mut scene = scene(MeshSpec::Ring {
        outer_radius: RADIUS,
        inner_radius: INNER,
        width: WIDTH,
        elements: [around, 22, 1],
    });
    scene.body.law = law;
    scene.body.grading = Grading { ratio: [growth(arc, around, fine), 0.12, 1.0], fine_arc: arc };
    scene.holds = vec![hold("all", "y")];
    scene.rim = Some(Rim { nodes: "inner".into() });
    scene.road = Some(GROUND);
    scene.friction = friction;
    scene.output.sample = 1e-4;
    scene.stages.clear();
    scene
}

/// Ratio of sizes that leaves `fine` of `around` elements within the arc: (1 - e)/e ln q/(q - 1) = (1 - i)/i.
fn growth(arc: f64, around: usize, fine: f64) -> f64 {
    let (equal, index) = (arc / std::f64::consts::TAU, fine / around as f64);
    let wanted = (1.0 - index) / index * equal / (1.0 - equal);
    let (mut low, mut high) = (1.0001f64, 1e4f64);
    for _ in 0..200 {
        let q = (low * high).sqrt();
        if q.ln() / (q - 1.0) > wanted { low = q } else { high = q }
    }
    (low * high).sqrt()
}

/// A stage that relaxes while the rim moves.
pub fn relaxing(name: &str, rim: RimMotion, duration: f64) -> Stage {
    Stage {
        method: Method::QuasiStatic { kinetic_ratio: 1e-6, residual: 1e-3 },
        // Twice the wall's own frequency, c_s / (4 x 12 mm) of 1 kHz.
        mass_damping: 1.2e4,
        rim,
        ..explicit(name, duration)
    }
}

/// Pressed by [`DEPTH`].
pub fn press() -> Stage {
    relaxing("press", RimMotion { z: Drive::Displacement { to: -DEPTH, ramp: 2e-3 }, ..HELD }, 0.02)
}

/// E / (1 - nu^2) [Pa].
pub fn plane_strain_modulus(law: &Law) -> f64 {
    let [e, nu] = crate::rig::elastic_constants(law);
    e / (1.0 - nu * nu)
}

/// Hertz: half width of the contact under a load of `force` [N] on the slice, a^2 = 4 P R / (pi E*).
pub fn half_width(law: &Law, force: f64) -> f64 {
    (4.0 * force / WIDTH * RADIUS / (std::f64::consts::PI * plane_strain_modulus(law))).sqrt()
}

//! The same three scenes at a thousandth and a thousand times the size: a block on a slope, a pressed wheel, a bouncing block.

use crate::report::{Case, Claim};
use crate::rig::{Outcome, block, explicit, given, press, simulate_with, wheel};
use hexroll::Result;
use hexroll::cpu::Precision;
use hexroll::model::Model;
use hexroll::physics::friction::Coulomb;
use hexroll::record::Sample;
use hexroll::scene::*;

pub const SIZES: Case = Case {
    name: "sizes",
    theorem: "size_changes_no_result",
    title: "A slope, a press and a bounce at a thousandth, one and a thousand times the size",
    source: "similarity: at the same moduli and density lengths and times go with s, body forces per mass with 1/s, energies with s^3",
    setup: "block of 100 mm on a slope of 30 degrees, mu = 0.4, settled and let go; 24 x 3 x 3 wheel pressed by 2.2 mm; block of 20 mm \
            that falls at 1 m/s; lengths times s, times times s",
    everyday: true,
    run,
};

/// A block that settles on a slope of 30 degrees, and slides.
fn slope(s: f64) -> Scene {
    let mut scene = block([0.1 * s, 0.1 * s, 0.05 * s], [4, 4, 2]);
    scene.body.viscosity = Some(150.0 * s);
    scene.road = Some(GROUND);
    scene.friction = Some(Friction::Coulomb(Coulomb { mu: 0.4 }));
    scene.gravity = [4.905 / s, 0.0, -8.495_709_211_125_343 / s];
    let settle = Stage { mass_damping: 3000.0 / s, ..explicit("settle", 0.03 * s) };
    scene.stages = vec![settle, explicit("slide", 0.03 * s)];
    scene
}

/// The wheel, pressed down slowly.
fn pressed(s: f64) -> Scene {
    let mut scene = wheel([24, 3, 3], 1.0);
    scene.body.mesh = MeshSpec::Ring {
        outer_radius: given::OUTER_RADIUS * s,
        inner_radius: given::INNER_RADIUS * s,
        width: given::WIDTH * s,
        elements: [24, 3, 3],
    };
    let mut down = press(Drive::Displacement { to: -given::DEPTH * s, ramp: given::PRESSING * s });
    (down.duration, down.mass_damping) = (0.2 * s, 3000.0 / s);
    scene.stages = vec![down];
    scene
}

/// A block that falls on the road, and leaves it.
fn bounce(s: f64) -> Scene {
    let mut scene = block([0.02 * s; 3], [4; 3]);
    scene.body.offset = [0.0, 0.0, 1e-3 * s];
    scene.body.velocity = [0.0, 0.0, -1.0];
    scene.road = Some(GROUND);
    scene.gravity = [0.0, 0.0, -9.81 / s];
    scene.stages = vec![explicit("bounce", 8e-3 * s)];
    scene
}

/// A scene by its size, what is looked at at its end, the power of the size that this goes with, and what rounding in single precision
/// may change of it.
type Watched = (&'static str, fn(f64) -> Scene, fn(&Sample) -> f64, i32, f64);

const WATCHED: [Watched; 3] = [
    ("slope: kinetic energy", slope, |s| s.kinetic_J, 3, 6e-4),
    ("press: vertical force", pressed, |s| s.road_fz_N, 2, 1e-4),
    ("bounce: kinetic energy", bounce, |s| s.kinetic_J, 3, 3e-4),
];

fn last(scene: fn(f64) -> Scene, s: f64, precision: Precision) -> Result<Outcome> {
    let mut scene = scene(s);
    scene.output.sample = 1e-3 * s;
    let model = Model::new(&scene)?;
    simulate_with(&scene, model, precision, 1)
}

fn run() -> Result<Vec<Claim>> {
    let mut claims = Vec::new();
    for (what, scene, value, power, single) in WATCHED {
        for (precision, tolerance, reason) in [
            (
                Precision::F64,
                1e-9,
                "double precision: rounding of some thousand steps, which contact that changes does not keep small",
            ),
            (
                Precision::F32,
                single,
                "single precision: 6e-8 of a position against strains of 1e-4 (slope) to 1e-1 (press), over some thousand steps",
            ),
        ] {
            let of = |s: f64| last(scene, s, precision).map(|out| value(out.last()) / s.powi(power));
            let one = of(1.0)?;
            for s in [1e-3, 1e3] {
                let claim = format!("{what} in {precision}, lengths x {s}, over that at size 1");
                claims.push(Claim::relative(claim, "", of(s)? / one, 1.0, tolerance, reason));
            }
        }
    }
    Ok(claims)
}

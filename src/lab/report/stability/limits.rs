//! Runs at the default safety factor and at growing ones, until one fails.

use crate::report::claim::short;
use crate::rig::given::{DEPTH, HOURGLASS, SPEED, SPIN, STRAIGHT, VISCOSITY};
use crate::rig::{self, GROUND, HELD, block, down, explicit, press, rolling, simulate_with, wheel};
use hexroll::model::Model;
use hexroll::physics::friction::Coulomb;
use hexroll::physics::material::NeoHookean;
use hexroll::run;
use hexroll::scene::*;
use hexroll::{Error, Result};

/// A hard case.
pub struct Hard {
    /// Name on the command line.
    pub name: &'static str,
    /// What it shows, as the name of its test.
    pub theorem: &'static str,
    pub title: &'static str,
    /// Scene and model, or why there is none.
    pub build: fn() -> Result<(Scene, Model)>,
    /// Largest error of the stored-energy balance at the default settings, over the largest energy term, and why.
    pub energy: f64,
    /// Whether it is meant to fail at the default settings: then the diagnosis is what counts.
    pub fails: bool,
    /// Whether it belongs to the everyday suite; otherwise its test is ignored and `make verify` runs it.
    pub everyday: bool,
}

/// What was found of a hard case.
#[derive(Debug, Clone)]
pub struct Limit {
    /// Largest safety factor that ended well, of those tried; `None`: not even the smallest.
    pub stable_up_to: Option<f64>,
    /// Diagnosis of the first run that did not.
    pub beyond: Option<String>,
    /// At the default settings, over the largest energy term: errors of the work and of the stored-energy balance.
    pub work_error: f64,
    pub stored_error: f64,
    pub min_jacobian: f64,
    pub steps: u64,
    /// A run that ended without an error, but with energies that do not add up.
    pub silent: Option<String>,
}

impl Hard {
    /// Whether what was found is what was meant: no garbage without a word, a diagnosis wherever it fails, and at the
    /// default settings balances that close.
    pub fn holds(&self, limit: &Limit) -> bool {
        let ends = limit.stable_up_to.is_some_and(|s| s >= UP[0]);
        let balanced = limit.work_error < 1e-10 && limit.stored_error <= self.energy;
        limit.silent.is_none() && if self.fails { !ends && limit.beyond.is_some() } else { ends && balanced }
    }

    /// Cells of a table row: case, steps, errors, smallest det F, limit, diagnosis, pass.
    pub fn cells(&self, limit: &Limit) -> Vec<String> {
        let percent = |v: f64| if v.is_nan() { "-".into() } else { format!("{} %", short(100.0 * v)) };
        let up_to = match limit.stable_up_to {
            Some(s) if s == UP[UP.len() - 1] => format!("{s} and more"),
            Some(s) => s.to_string(),
            None => format!("not at {}", DOWN[DOWN.len() - 1]),
        };
        let pass = if self.holds(limit) { "yes" } else { "**no**" };
        vec![
            self.title.into(),
            limit.steps.to_string(),
            if limit.work_error.is_nan() { "-".into() } else { format!("{:.0e}", limit.work_error) },
            percent(limit.stored_error),
            percent(self.energy),
            if limit.min_jacobian.is_nan() { "-".into() } else { short(limit.min_jacobian) },
            up_to,
            limit.beyond.clone().unwrap_or_else(|| "-".into()),
            pass.into(),
        ]
    }
}

/// Safety factors tried, the default first. Halves before giving up on a case that fails at 0.9.
const UP: [f64; 5] = [0.9, 0.97, 1.03, 1.1, 1.3];
const DOWN: [f64; 2] = [0.45, 0.2];

/// Searches the limit.
///
/// # Errors
/// A scene that cannot be built.
pub fn find(hard: &Hard) -> Result<Limit> {
    let (scene, model) = (hard.build)()?;
    let mut limit = Limit {
        stable_up_to: None,
        beyond: None,
        work_error: f64::NAN,
        stored_error: f64::NAN,
        min_jacobian: f64::NAN,
        steps: 0,
        silent: None,
    };
    for safety in UP {
        if !attempt(&scene, &model, safety, &mut limit) {
            break;
        }
    }
    if limit.stable_up_to.is_none() {
        let beyond = limit.beyond.take();
        for safety in DOWN {
            if attempt(&scene, &model, safety, &mut limit) {
                break;
            }
        }
        limit.beyond = beyond;
    }
    Ok(limit)
}

/// Runs at a safety factor; whether it ended well.
fn attempt(scene: &Scene, model: &Model, safety: f64, limit: &mut Limit) -> bool {
    let scene = Scene { safety, ..scene.clone() };
    match simulate_with(&scene, model.clone(), hexroll::cpu::Precision::F64, 1) {
        Ok(outcome) => {
            let ledger = &outcome.totals.ledger;
            let stored = ledger.worst_stored_balance / ledger.largest_term;
            if limit.work_error.is_nan() {
                limit.work_error = ledger.worst_balance / ledger.largest_term;
                limit.stored_error = stored;
                limit.steps = outcome.totals.steps;
                limit.min_jacobian =
                    outcome.samples.iter().map(|s| s.min_jacobian).fold(f64::INFINITY, f64::min);
            }
            // NaN is garbage too.
            if stored.is_nan() || stored >= run::GARBAGE {
                let percent = short(100.0 * stored);
                limit.silent = Some(format!("safety {safety}: ends, stored energy off by {percent} %"));
                limit.beyond = limit.silent.clone();
                return false;
            }
            limit.stable_up_to = Some(safety);
            true
        }
        Err(error) => {
            limit.beyond = Some(diagnosis(safety, &error));
            false
        }
    }
}

/// The first sentence of an error.
fn diagnosis(safety: f64, error: &Error) -> String {
    let text = error.to_string();
    let sentence = text.split(';').next().unwrap_or(&text);
    format!("safety {safety}: {sentence}")
}

fn meshed(scene: Scene) -> Result<(Scene, Model)> {
    let model = Model::new(&scene)?;
    Ok((scene, model))
}

/// A coarse wheel (24 x 3 x 3), pressed by `depth` and rolled for 20 ms at `velocity` and `omega`.
fn rolled(mu: f64, eta: f64, depth: f64, velocity: [f64; 2], omega: f64) -> Scene {
    let mut scene = wheel([24, 3, 3], mu);
    scene.body.viscosity = (eta > 0.0).then_some(eta);
    scene.stages = vec![press(down(depth)), rolling(velocity, omega, 0.02)];
    scene
}

/// A viscous wheel at 5 % driving slip.
fn usual(mu: f64, velocity: [f64; 2], omega: f64) -> Result<(Scene, Model)> {
    meshed(rolled(mu, VISCOSITY, DEPTH, velocity, omega))
}

/// The spin of a wheel without torque [rad/s].
pub(super) fn free_spin() -> f64 {
    rig::reference("free.spin").value
}

/// A wheel that slides: mu = 1, at a spin of `omega`.
pub(super) fn sliding(omega: f64) -> Result<(Scene, Model)> {
    usual(1.0, STRAIGHT, omega)
}

fn at_angle(degrees: f64) -> [f64; 2] {
    let (sin, cos) = f64::to_radians(degrees).sin_cos();
    [SPEED * cos, SPEED * sin]
}

fn incompressible() -> Result<(Scene, Model)> {
    let mut scene = rolled(1.0, VISCOSITY, DEPTH, STRAIGHT, SPIN);
    scene.body.law = Law::NeoHookean(NeoHookean { g0: 1e4 * rig::G, g1: rig::G });
    scene.stages[1].duration = 2e-3;
    scene.stages[0].rim.z = Drive::Displacement { to: -DEPTH, ramp: 5e-3 };
    meshed(scene)
}

/// Pressed without rolling.
fn pressed(depth: f64) -> Result<(Scene, Model)> {
    let mut scene = rolled(1.0, VISCOSITY, depth, [0.0; 2], 0.0);
    scene.stages.truncate(1);
    scene.stages[0].method = Method::Explicit;
    scene.stages[0].duration = 0.03;
    meshed(scene)
}

/// A block thrown at the road.
fn thrown(speed: f64, tumble: [f64; 3]) -> Scene {
    let mut scene = block([0.03, 0.02, 0.02], [6, 4, 4]);
    scene.body.offset = [0.0, 0.0, 0.01];
    scene.body.velocity = [0.3 * speed, 0.0, -speed];
    scene.body.angular_velocity = tumble;
    scene.body.viscosity = Some(20.0);
    scene.road = Some(GROUND);
    scene.friction = Some(Friction::Coulomb(Coulomb { mu: 0.8 }));
    scene.output.sample = 1e-4;
    scene.stages[0].duration = 0.03 / speed + 2e-3;
    scene
}

/// The pressed block of a bad mesh: `shape` moves its reference nodes.
fn misshapen(elements: [usize; 3], shape: impl Fn([f64; 3]) -> [f64; 3]) -> Result<(Scene, Model)> {
    let mut scene = block([0.04, 0.02, 0.02], elements);
    scene.rim = Some(Rim { nodes: "z-max".into() });
    scene.road = Some(GROUND);
    scene.friction = Some(Friction::Coulomb(Coulomb { mu: 0.5 }));
    scene.body.viscosity = Some(1.0);
    scene.output.sample = 1e-4;
    let z = Drive::Displacement { to: -2e-3, ramp: 3e-3 };
    scene.stages = vec![Stage { rim: RimMotion { z, ..HELD }, ..explicit("press", 5e-3) }];
    let mut mesh = Model::new(&scene)?.mesh;
    mesh.nodes.iter_mut().for_each(|x| *x = shape(*x));
    let model = Model::from_mesh(mesh, &scene.body).map_err(|element| Error::Scene {
        file: "report".into(),
        line: None,
        key: "body.mesh".into(),
        problem: format!("element {element} is inside out"),
        remedy: "another shape".into(),
    })?;
    Ok((scene, model))
}

fn flat() -> Result<(Scene, Model)> {
    // 4 x 4 x 40: elements of 10 x 5 x 0.5 mm.
    misshapen([4, 4, 40], |x| x)
}

/// Sheared until the angle between two faces is 10 degrees.
fn skewed() -> Result<(Scene, Model)> {
    let lean = 1.0 / f64::to_radians(10.0).tan();
    misshapen([8, 4, 4], |x| [x[0] + lean * x[1], x[1], x[2]])
}

/// One element a twentieth as long as its neighbours.
fn tiny() -> Result<(Scene, Model)> {
    misshapen([8, 4, 4], |x| {
        let plane = (x[0] / 0.005).round() as usize;
        [if plane == 4 { x[0] - 0.95 * 0.005 } else { x[0] }, x[1], x[2]]
    })
}

/// Stretched and sheared far on one-point elements, which resist bending by hourglass stiffness alone.
fn hourglass() -> Result<(Scene, Model)> {
    let mut scene = rolled(1.0, VISCOSITY, 4e-3, at_angle(20.0), SPIN);
    scene.body.element = Element::UniformGradient { hourglass: HOURGLASS };
    meshed(scene)
}

/// First contact and last release on one step: a block that skims the road.
fn skimming() -> Result<(Scene, Model)> {
    let mut scene = thrown(0.5, [0.0; 3]);
    scene.body.offset = [0.0, 0.0, 1e-9];
    scene.body.velocity = [20.0, 0.0, -1e-6];
    scene.stages[0].duration = 5e-3;
    meshed(scene)
}

/// A case of the everyday suite that ends well.
const fn case(
    name: &'static str,
    theorem: &'static str,
    title: &'static str,
    energy: f64,
    build: fn() -> Result<(Scene, Model)>,
) -> Hard {
    Hard { name, theorem, title, build, energy, fails: false, everyday: true }
}

/// Every hard case whose limit is searched.
///
/// Energies: second order in the step, 1e-2 where strains are moderate; impacts and edges that fold excite the highest
/// frequencies, which the step resolves by its safety alone; so does a wheel that slides and chatters (`sliding_energy` shows
/// that its error is the step's).
pub const HARD: &[Hard] = &[
    Hard {
        everyday: false,
        ..case(
            "incompressible",
            "nearly_incompressible_rubber_rolls",
            "kappa / G = 10^4, rolling",
            0.03,
            incompressible,
        )
    },
    case("slip_45", "slip_at_45_degrees", "slip angle 45 degrees", 0.03, || usual(0.5, at_angle(45.0), SPIN)),
    case("slip_90", "slip_at_90_degrees", "slip angle 90 degrees", 0.03, || usual(0.5, at_angle(90.0), SPIN)),
    case("locked", "a_locked_wheel", "locked wheel, omega = 0", 0.08, || sliding(0.0)),
    case("spun", "a_spun_wheel", "spun wheel, three times the free spin", 0.08, || {
        sliding(3.0 * free_spin())
    }),
    case("mu_0", "no_friction", "no friction", 0.03, || usual(0.0, STRAIGHT, SPIN)),
    case("mu_2", "friction_of_2", "mu = 2", 0.03, || usual(2.0, STRAIGHT, SPIN)),
    case("mu_10", "friction_of_10", "mu = 10", 0.03, || usual(10.0, STRAIGHT, SPIN)),
    case("press_6", "pressed_by_6_mm", "pressed by 6 mm", 0.03, || pressed(6e-3)),
    case("press_8", "pressed_by_8_mm", "pressed by 8 mm", 0.03, || pressed(8e-3)),
    Hard {
        fails: true,
        ..case(
            "press_20",
            "pressed_until_elements_turn_inside_out",
            "pressed by 20 of 22 mm: elements turn inside out",
            0.03,
            || pressed(20e-3),
        )
    },
    case("impact_10", "impact_at_10_metres_a_second", "block thrown at 10 m/s", 0.1, || {
        meshed(thrown(10.0, [0.0; 3]))
    }),
    case("impact_30", "impact_at_30_metres_a_second", "block thrown at 30 m/s", 0.1, || {
        meshed(thrown(30.0, [0.0; 3]))
    }),
    case("corner", "corner_first", "corner first, tumbling, 5 m/s", 0.1, || {
        meshed(thrown(5.0, [400.0, 300.0, 100.0]))
    }),
    case("flat", "elements_20_times_as_long_as_thick", "elements 20 times as long as thick", 0.03, flat),
    case("skew", "elements_10_degrees_from_flat", "elements sheared to 10 degrees from flat", 0.03, skewed),
    case(
        "tiny",
        "a_tiny_element_among_large_ones",
        "one layer a twentieth as long as its neighbours",
        0.03,
        tiny,
    ),
    case(
        "hourglass",
        "loads_that_excite_hourglass_modes",
        "one-point elements pressed by 4 mm at 20 degrees",
        0.05,
        hourglass,
    ),
    case("skim", "touch_and_release_on_one_step", "first touch and last release on one step", 0.03, skimming),
];

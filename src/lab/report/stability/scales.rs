//! Similarity, distance from the origin, and long runs.

use crate::report::{Case, Claim};
use crate::rig::{self, GROUND, Outcome, given, press, simulate_with, wheel};
use hexroll::Result;
use hexroll::cpu::Precision;
use hexroll::model::Model;
use hexroll::output::{ContactScatter, Verdict};
use hexroll::physics::material::NeoHookean;
use hexroll::scene::*;

/// Scatter above which a run is named: the default of `output.chatter_limit`.
const LIMIT: f64 = 0.05;

pub const SIMILAR: Case = Case {
    name: "similarity",
    theorem: "similar_wheels_have_similar_forces",
    title: "The same wheel, a thousand times smaller and larger, a million times softer and stiffer",
    source: "similarity: lengths s, moduli k, times s / sqrt(k), forces k s^2",
    setup: "24 x 3 x 3 wheel, viscous, pressed and rolled for 10 ms (of the original), single precision",
    everyday: true,
    run: similar,
};

pub const FAR: Case = Case {
    name: "far_away",
    theorem: "a_wheel_at_one_kilometre",
    title: "A wheel that starts at x = 1 km, in single precision",
    source: "nothing depends on where the road's origin is",
    setup: "24 x 3 x 3 wheel, viscous, pressed and rolled for 0.1 s",
    everyday: true,
    run: far,
};

pub const LONG: Case = Case {
    name: "million_steps",
    theorem: "a_million_steps",
    title: "A million steps of rolling",
    source: "steady rolling stays steady; balances close",
    setup: "24 x 3 x 3 wheel, mu = 1, straight, a million steps with 20 Pa s and as many without",
    everyday: false,
    run: long,
};

pub const CHATTER: Case = Case {
    name: "chatter",
    theorem: "elastic_rolling_is_named_as_chattering",
    title: "Elastic rolling chatters, and is named",
    source: "Adams 1995: constant friction on an elastic body is unstable at short wavelengths",
    setup: "24 x 3 x 3 wheel, mu = 1, straight, 0.5 s (25,000 steps) without viscosity and with 20 Pa s",
    everyday: true,
    run: chatter,
};

/// A wheel of lengths `s` and moduli `k` times the paper's.
fn rolling(s: f64, k: f64, duration: f64, eta: f64) -> Scene {
    let (time, speed) = (s / k.sqrt(), k.sqrt());
    let mut scene = wheel([24, 3, 3], 1.0);
    scene.body.mesh = MeshSpec::Ring {
        outer_radius: given::OUTER_RADIUS * s,
        inner_radius: given::INNER_RADIUS * s,
        width: given::WIDTH * s,
        elements: [24, 3, 3],
    };
    let Law::NeoHookean(NeoHookean { g0, g1 }) = scene.body.law else {
        unreachable!("the wheel is neo-Hookean")
    };
    scene.body.law = Law::NeoHookean(NeoHookean { g0: k * g0, g1: k * g1 });
    scene.body.viscosity = (eta > 0.0).then_some(eta * k * time);
    let mut down = press(Drive::Displacement { to: -given::DEPTH * s, ramp: given::PRESSING * time });
    (down.duration, down.mass_damping) = (0.2 * time, 3000.0 / time);
    let roll = rig::rolling([given::SPEED * speed, 0.0], given::SPIN / time, duration * time);
    scene.stages = vec![down, roll];
    scene.output.sample = 1e-3 * time;
    scene
}

fn run_in(scene: &Scene, precision: Precision) -> Result<Outcome> {
    simulate_with(scene, Model::new(scene)?, precision, 1)
}

/// Last forces over k s^2 [N].
fn forces(outcome: &Outcome, s: f64, k: f64) -> [f64; 2] {
    let mean = |column: fn(&hexroll::record::Sample) -> f64| outcome.mean("roll", 0.5, column) / (k * s * s);
    [mean(|s| s.road_fx_N), mean(|s| s.road_fz_N)]
}

fn similar() -> Result<Vec<Claim>> {
    const REASON: &str =
        "single precision: 6e-8 of positions against strains of 1e-2 to 1e-1, over a thousand steps";
    let reference = forces(&run_in(&rolling(1.0, 1.0, 0.01, 20.0), Precision::F32)?, 1.0, 1.0);
    let mut claims = Vec::new();
    for (s, k) in [(1e-3, 1.0), (1e3, 1.0), (1.0, 1e-6), (1.0, 1e6), (1e3, 1e6)] {
        let found = forces(&run_in(&rolling(s, k, 0.01, 20.0), Precision::F32)?, s, k);
        for (name, (got, expected)) in ["Fx", "Fz"].iter().zip(found.into_iter().zip(reference)) {
            let what = format!("lengths x {s}, moduli x {k}: {name} over k s^2");
            claims.push(Claim::relative(what, "N", got, expected, 1e-3, REASON));
        }
    }
    Ok(claims)
}

fn far() -> Result<Vec<Claim>> {
    const REASON: &str =
        "positions are kept relative to a frame that follows the axle: no digit is lost to distance";
    let near = rolling(1.0, 1.0, 0.1, 20.0);
    let mut away = near.clone();
    away.body.offset = [1000.0, 0.0, 0.0];
    let [a, b] = [&near, &away].map(|scene| run_in(scene, Precision::F32).map(|o| forces(&o, 1.0, 1.0)));
    let (a, b) = (a?, b?);
    Ok(vec![
        Claim::relative("Fx at 1 km", "N", b[0], a[0], 1e-3, REASON),
        Claim::relative("Fz at 1 km", "N", b[1], a[1], 1e-3, REASON),
    ])
}

/// Claims that the run without viscosity is named, and the one with it is not.
fn named(elastic: &Outcome, viscous: &Outcome) -> Vec<Claim> {
    let verdict = |outcome: &Outcome| {
        let noise = outcome.totals.noise.last().and_then(Option::as_ref)?;
        ContactScatter::of(noise, GROUND.normal([0.0; 3]), LIMIT)
    };
    let share = |outcome: &Outcome| verdict(outcome).map_or(f64::NAN, |c| c.remaining_share);
    let chatters = |outcome: &Outcome| match verdict(outcome).map(|c| c.verdict) {
        Some(Verdict::Chattering) => 1.0,
        Some(_) => 0.0,
        None => f64::NAN,
    };
    vec![
        Claim::at_least(
            "elastic: scatter of the road's force over the load, without the mesh's tone",
            "",
            share(elastic),
            LIMIT,
            "the default limit above which a run is named",
        ),
        Claim::absolute(
            "elastic: named as chattering (1: yes)",
            "",
            chatters(elastic),
            1.0,
            0.0,
            "a verdict",
        ),
        Claim::at_most(
            "20 Pa s: the same scatter",
            "",
            share(viscous),
            0.5 * LIMIT,
            "viscosity makes rolling well-posed; half of the limit, so that the two are apart",
        ),
        Claim::absolute("20 Pa s: named as chattering", "", chatters(viscous), 0.0, 0.0, "a verdict"),
    ]
}

fn chatter() -> Result<Vec<Claim>> {
    let run = |eta: f64| run_in(&rolling(1.0, 1.0, 0.5, eta), Precision::F64);
    Ok(named(&run(0.0)?, &run(20.0)?))
}

/// Runs of many steps. In one piece: the claims share their runs.
fn long() -> Result<Vec<Claim>> {
    let steps = |wanted: f64, eta: f64| -> Result<Outcome> {
        // As long as the longest step of a short run would take for so many.
        let dt = run_in(&rolling(1.0, 1.0, 0.01, eta), Precision::F64)?.totals.dt_max;
        run_in(&rolling(1.0, 1.0, wanted * dt, eta), Precision::F64)
    };
    let viscous = steps(1e6, 20.0)?;
    let rows = viscous.stage("roll");
    let share = |from: f64, to: f64, f: fn(&hexroll::record::Sample) -> f64| {
        let [from, to] = [from, to].map(|s| (s * rows.len() as f64) as usize);
        rows[from..to].iter().map(|s| f(s)).sum::<f64>() / (to - from) as f64
    };
    let elastic = steps(1e6, 0.0)?;
    let ledger = &viscous.totals.ledger;
    let stored = |at: f64| {
        let s = rows[((rows.len() - 1) as f64 * at) as usize];
        s.stored_balance_error_J / s.external_work_J.abs()
    };
    let mut claims = named(&elastic, &viscous);
    claims.extend([
        Claim::at_least("steps taken", "", viscous.totals.steps as f64, 1e6, "what was promised"),
        Claim::relative(
            "Fx of the last tenth over that of the second",
            "",
            share(0.9, 1.0, |s| s.road_fx_N),
            share(0.1, 0.2, |s| s.road_fx_N),
            1e-3,
            "steady: each window repeats the one before",
        ),
        Claim::relative(
            "Fz of the last tenth over that of the second",
            "",
            share(0.9, 1.0, |s| s.road_fz_N),
            share(0.1, 0.2, |s| s.road_fz_N),
            1e-3,
            "the same",
        ),
        Claim::at_most(
            "error of the work balance over its largest term",
            "",
            ledger.worst_balance / ledger.largest_term,
            1e-10,
            "round-off of a million steps",
        ),
        Claim::at_most(
            "stored-energy error over the work done, at the end",
            "",
            stored(1.0).abs(),
            5e-3,
            "second order in the step, of the power that passes through",
        ),
        Claim::at_most(
            "side force over load (symmetry)",
            "",
            (share(0.5, 1.0, |s| s.road_fy_N) / share(0.5, 1.0, |s| s.road_fz_N)).abs(),
            1e-6,
            "round-off that symmetry does not amplify",
        ),
    ]);
    Ok(claims)
}

//! Histories at a high rate: what they say of bodies whose motion is known, and that they change nothing.

#![allow(non_snake_case)] // X: reference positions

use std::f64::consts::PI;

use hexroll::cpu::{self, Precision};
use hexroll::model::Model;
use hexroll::record::{History, Sample, Values};
use hexroll::run;
use hexroll::scene::Scene;
use hexroll::signal::spectrum::Welch;
use hexroll_lab::rig::Recorder;

/// A rubber bar along x; `rest`: what else the scene has.
fn bar(mesh: &str, body: &str, rest: &str) -> String {
    format!(
        "title = \"bar\"\n[body]\ndensity = \"1100 kg/m3\"\n{body}\n[body.mesh]\ngenerator = \"block\"\n{mesh}\n\
         [body.material]\nlaw = \"neo-hookean\"\nshear_modulus = \"2.64 MPa\"\nbulk_modulus = \"65.1 MPa\"\n{rest}"
    )
}

fn ran(text: &str, threads: usize) -> (Vec<Sample>, Vec<History>) {
    let scene = Scene::parse(text, "test.toml", &[]).unwrap_or_else(|e| panic!("{e}"));
    let model = Model::new(&scene).unwrap_or_else(|e| panic!("{e}"));
    let mut engine = cpu::engine(&model, &scene, Precision::F64, threads).unwrap();
    let mut recorder = Recorder::default();
    run::run(&scene, &model, &mut *engine, &mut recorder).unwrap_or_else(|e| panic!("{e}"));
    (recorder.samples, recorder.histories)
}

fn values<'h>(history: &'h History, name: &str) -> &'h Values {
    history.values.iter().find(|v| v.name == name).unwrap_or_else(|| panic!("no {name}"))
}

/// One number of a place over time.
fn signal(history: &History, name: &str, place: usize, component: usize) -> Vec<f64> {
    let v = values(history, name);
    let width = history.nodes.len() * v.components;
    let at = place * v.components + component;
    v.values.chunks_exact(width).map(|row| f64::from(row[at])).collect()
}

const STAGE: &str = "[[stage]]\nname = \"fly\"\nmethod = \"explicit\"\n";

#[test]
fn velocities_integrate_to_displacements_and_accelerations_to_velocities() {
    let mesh = "size = [\"0.2 m\", \"20 mm\", \"20 mm\"]\nelements = [20, 2, 2]";
    let rest = format!(
        "[[hold]]\nnodes = \"x-min\"\ncomponents = \"xyz\"\n{STAGE}duration = \"50 ms\"\n[output]\nsample = \"1 ms\"\n\
         [[output.history]]\nname = \"end\"\nnodes = \"x-max\"\n\
         quantities = [\"displacement\", \"velocity\", \"acceleration\", \"position\"]\n"
    );
    let text = bar(mesh, "velocity = [\"0 m/s\", \"0 m/s\", \"0.5 m/s\"]", &rest);
    let (_, histories) = ran(&text, 1);
    let history = &histories[0];
    assert_eq!((history.rate, history.nodes.len()), (20e3, 9));
    let spacing = history.times.windows(2).map(|t| (t[1] - t[0] - 5e-5).abs()).fold(0.0, f64::max);
    assert!(spacing < 1e-12 && history.times.len() > 990, "{spacing} s, {} times", history.times.len());
    for (of, integral) in [("velocity", "displacement"), ("acceleration", "velocity")] {
        let (rate, whole) = (signal(history, of, 4, 2), signal(history, integral, 4, 2));
        // Simpson's rule over pairs of periods, away from the ends, where the filter is one-sided.
        let (from, to) = (40, history.times.len() - 40);
        let mut sum = 0.0;
        let largest = whole.iter().map(|v| v.abs()).fold(0.0, f64::max);
        for k in (from..to - 2).step_by(2) {
            sum += (rate[k] + 4.0 * rate[k + 1] + rate[k + 2]) * 5e-5 / 3.0;
            let error = (whole[k + 2] - whole[from] - sum).abs() / largest;
            assert!(error < 1e-3, "{integral} at {} s: {error:.1e}", history.times[k + 2]);
        }
    }
    // A position is the reference position and the displacement.
    let (x, u) = (signal(history, "position", 4, 2), signal(history, "displacement", 4, 2));
    let off = x.iter().zip(&u).map(|(x, u)| (x - u - history.positions[4][2]).abs()).fold(0.0, f64::max);
    // Both are kept in single precision.
    assert!(off < 4e-8, "{off}");
}

#[test]
fn a_body_that_flies_has_a_constant_velocity_without_ripple() {
    let mesh = "size = [\"40 mm\", \"20 mm\", \"20 mm\"]\nelements = [4, 2, 2]";
    let rest = format!(
        "{STAGE}duration = \"10 ms\"\n[output]\nsample = \"1 ms\"\n[[output.history]]\nname = \"all\"\nnodes = \"all\"\n\
         quantities = [\"velocity\", \"displacement\"]\nrate = \"10 kHz\"\n"
    );
    let (_, histories) = ran(&bar(mesh, "velocity = [\"3 m/s\", \"0 m/s\", \"-2 m/s\"]", &rest), 1);
    for place in 0..histories[0].nodes.len() {
        for (d, v) in [(0, 3.0), (1, 0.0), (2, -2.0)] {
            let ripple =
                signal(&histories[0], "velocity", place, d).iter().map(|x| (x - v).abs()).fold(0.0, f64::max);
            // Single precision of 3 m/s in some hundred terms.
            assert!(ripple < 3e-6, "place {place}, {d}: {ripple}");
            let way = signal(&histories[0], "displacement", place, d);
            let off = way.iter().zip(&histories[0].times).map(|(u, t)| (u - v * t).abs()).fold(0.0, f64::max);
            assert!(off < 3e-8, "place {place}, {d}: {off}");
        }
    }
}

/// A column that can only move along x, whose base is stopped: waves run with c = sqrt(M/rho), M = kappa + 4/3 G, and its
/// frequencies are (2 n - 1) c / 4 L.
#[test]
fn a_bar_struck_at_its_end_has_its_frequencies_up_to_5_khz() {
    let mesh = "size = [\"0.2 m\", \"4 mm\", \"4 mm\"]\nelements = [80, 1, 1]";
    let rest = format!(
        "[[hold]]\nnodes = \"all\"\ncomponents = \"yz\"\n[[hold]]\nnodes = \"x-min\"\ncomponents = \"x\"\n\
         {STAGE}duration = \"0.15 s\"\n[output]\nsample = \"5 ms\"\n[[output.history]]\nname = \"end\"\nnodes = \"x-max\"\n"
    );
    let (_, histories) = ran(&bar(mesh, "velocity = [\"1 mm/s\", \"0 m/s\", \"0 m/s\"]", &rest), 1);
    let v = signal(&histories[0], "velocity", 0, 0);
    let welch = Welch { rate: 20e3, segment: v.len() };
    let density = welch.density(&v);
    let c = ((65.1e6 + 4.0 / 3.0 * 2.64e6) / 1100.0_f64).sqrt();
    for n in 1..=8 {
        let expected = (2 * n - 1) as f64 * c / (4.0 * 0.2);
        let near = |k: &usize| (*k as f64 * welch.width() / expected - 1.0).abs() < 0.03;
        let peak =
            (1..density.len() - 1).filter(near).max_by(|a, b| density[*a].total_cmp(&density[*b])).unwrap();
        // Of three lines of a Hann window's peak a parabola through their logarithms has the top within 1 % of a line.
        let [a, b, d] = [peak - 1, peak, peak + 1].map(|k| density[k].ln());
        let found = (peak as f64 + 0.5 * (a - d) / (a - 2.0 * b + d)) * welch.width();
        // Lumped masses: at most (k h)^2/24 = 0.36 % at n = 8, of which central differences take back a part.
        assert!((found / expected - 1.0).abs() < 0.005, "{n}: {found:.1} Hz for {expected:.1} Hz");
    }
}

/// A block that falls on a road and slides.
const FALL: &str = "[road]\nshape = \"plane\"\n[friction]\ncoefficient = 0.5\n[[stage]]\nname = \"land\"\n\
                    method = \"explicit\"\nduration = \"6 ms\"\n[output]\nsample = \"0.5 ms\"\n";
const BLOCK: &str = "size = [\"20 mm\", \"20 mm\", \"20 mm\"]\nelements = [4, 4, 4]";
/// From 2 mm above the road, so that nothing happens at the beginning, where the filter is one-sided.
const FALLS: &str =
    "offset = [\"0 mm\", \"0 mm\", \"2 mm\"]\nvelocity = [\"0.3 m/s\", \"0 m/s\", \"-1 m/s\"]";
const BOTTOM: &str = "[[output.history]]\nname = \"bottom\"\nnodes = \"z-min\"\n\
                      quantities = [\"contact-force\", \"pressure\", \"velocity\"]\n";

#[test]
fn forces_of_nodes_add_up_to_the_roads_and_to_its_impulse() {
    let (samples, histories) = ran(&bar(BLOCK, FALLS, &[FALL, BOTTOM].concat()), 1);
    let history = &histories[0];
    let road = history.road_force.as_ref().unwrap();
    let largest = road.iter().map(|f| f.abs()).fold(0.0, f32::max);
    assert!(largest > 10.0, "{largest} N");
    for (t, total) in road.chunks_exact(3).enumerate() {
        for d in 0..3 {
            let sum: f64 = (0..history.nodes.len()).map(|p| signal(history, "contact-force", p, d)[t]).sum();
            assert!(
                (sum - f64::from(total[d])).abs() < 1e-5 * f64::from(largest),
                "{t} {d}: {sum} {}",
                total[d]
            );
        }
    }
    // Pressure times area is the normal force: the road is level.
    for place in 0..history.nodes.len() {
        let (p, f) = (signal(history, "pressure", place, 0), signal(history, "contact-force", place, 2));
        let off = p.iter().zip(&f).map(|(p, f)| (p * history.areas[place] - f).abs()).fold(0.0, f64::max);
        assert!(off < 1e-5 * f64::from(largest), "{place}: {off}");
    }
    let area: f64 = history.areas.iter().sum();
    assert!((area - 4e-4).abs() < 1e-12 && history.faces.len() == 16, "{area}");
    assert!(history.normals.iter().all(|n| (n[2] + 1.0).abs() < 1e-12));
    // The impulse of the whole impact, as history.csv has it: the filter keeps a signal's integral.
    let impulse: f64 = samples.iter().map(|s| s.road_fz_N * 0.5e-3).sum();
    let found: f64 = road.chunks_exact(3).map(|f| f64::from(f[2]) * 5e-5).sum();
    assert!((found / impulse - 1.0).abs() < 2e-3, "{found} {impulse}");
}

#[test]
fn a_history_changes_no_bit_of_a_run_and_has_the_same_bits_on_any_threads() {
    let bare = ran(&bar(BLOCK, FALLS, FALL), 1).0;
    let text = bar(BLOCK, FALLS, &[FALL, BOTTOM].concat());
    let (samples, histories) = ran(&text, 1);
    assert_eq!(bare, samples);
    let (again, others) = ran(&text, 3);
    assert_eq!((again, others), (samples, histories));
}

#[test]
fn a_rate_beyond_the_steps_is_an_error_that_says_what_would_do() {
    let mesh = "size = [\"0.2 m\", \"0.1 m\", \"0.1 m\"]\nelements = [2, 1, 1]";
    let rest = format!(
        "{STAGE}duration = \"10 ms\"\n[output]\nsample = \"2 ms\"\n[[output.history]]\nname = \"all\"\nnodes = \"all\"\n"
    );
    let scene = Scene::parse(&bar(mesh, "", &rest), "test.toml", &[]).unwrap();
    let model = Model::new(&scene).unwrap();
    let mut engine = cpu::engine(&model, &scene, Precision::F64, 1).unwrap();
    let error = run::run(&scene, &model, &mut *engine, &mut Recorder::default()).unwrap_err().to_string();
    assert!(error.contains("output.history.0.rate") && error.contains("write a rate of at most"), "{error}");
}

/// A ring that turns without a road. Unturned places stand still while it turns.
#[test]
fn unturned_places_stand_while_the_wheel_turns() {
    let text = "title = \"ring\"\n[body]\ndensity = \"1100 kg/m3\"\n[body.mesh]\ngenerator = \"ring\"\n\
        outer_radius = \"39 mm\"\ninner_radius = \"17 mm\"\nwidth = \"17.5 mm\"\nelements = [16, 1, 1]\n\
        [body.material]\nshear_modulus = \"2.64 MPa\"\nbulk_modulus = \"65.1 MPa\"\nlaw = \"neo-hookean\"\n\
        [rim]\nnodes = \"inner\"\n[[stage]]\nname = \"turn\"\nmethod = \"explicit\"\nduration = \"20 ms\"\n\
        initial_velocity = \"rim\"\n[stage.rim]\nx = { velocity = \"2 m/s\" }\nspin = { velocity = \"50 rad/s\" }\n\
        [output]\nsample = \"2 ms\"\n[[output.history]]\nname = \"tread\"\nnodes = \"outer\"\nturning = false\nrate = \"8 kHz\"\n\
        quantities = [\"position\", \"velocity\", \"displacement\"]\n";
    let (samples, histories) = ran(text, 1);
    let history = &histories[0];
    assert!(!history.turning && history.nodes.len() == 32 && history.faces.len() == 16);
    assert!(samples.last().unwrap().rim_angle_rad > 0.99, "it has turned by a radian");
    let axle = |t: f64| [2.0 * t, 0.0, 39e-3];
    let mut motion: f64 = 0.0;
    for (place, X) in history.positions.iter().enumerate() {
        let [x, z, vx, vz, ux, uz] = [
            ("position", 0),
            ("position", 2),
            ("velocity", 0),
            ("velocity", 2),
            ("displacement", 0),
            ("displacement", 2),
        ]
        .map(|(name, d)| signal(history, name, place, d));
        for (k, t) in history.times.iter().enumerate().skip(20).take(history.times.len() - 40) {
            let (arm, at) = ([X[0], X[2] - 39e-3], [x[k] - axle(*t)[0], z[k] - axle(*t)[2]]);
            let off = (arm[0].atan2(arm[1]) - at[0].atan2(at[1]) + PI).rem_euclid(2.0 * PI) - PI;
            // Elastic waves of the start turn the tread by some 1e-3; the wheel has turned by up to 1.
            assert!(off.abs() < 0.01, "place {place} at {t}: {off} rad");
            // omega x r, about the axle that moves along x.
            let expected = [2.0 + 50.0 * at[1], -50.0 * at[0]];
            assert!(
                (vx[k] - expected[0]).hypot(vz[k] - expected[1]) < 0.1,
                "{place} {t}: {} {}",
                vx[k],
                vz[k]
            );
            motion = motion.max(ux[k].hypot(uz[k]));
        }
    }
    // Centrifugal: some 1e-4 m; a displacement from a place that turns would be of the size of the wheel.
    assert!(motion < 1e-3, "{motion} m");
}

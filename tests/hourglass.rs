//! Hourglass energy that is more than a remedy is named, and ends a run where the scene says so.

use hexroll::cpu::{self, Precision};
use hexroll::model::Model;
use hexroll::output::summary::HourglassShare;
use hexroll::scene::Scene;
use hexroll::{Error, Result};
use hexroll_lab::rig::{Recorder, close, simulate_on};

/// From which share on a run warns.
const WARNED: f64 = 0.1;

/// A block thrown onto its corner: the corner's elements bend and twist.
const CORNER: &str = r#"
title = "uniform-gradient block dropped on its corner"
[body]
density = "1000 kg/m3"
velocity = ["0.33333333 m/s", "0.66666667 m/s", "-0.66666667 m/s"]
element = "uniform-gradient"
[body.mesh]
generator = "block"
size = ["40 mm", "40 mm", "40 mm"]
elements = [6, 6, 6]
[body.material]
shear_modulus = "1 MPa"
bulk_modulus = "20 MPa"
[road]
normal = [-1, -2, 2]
point = ["40 mm", "40 mm", "0 mm"]
[friction]
coefficient = 1.0
[[stage]]
method = "explicit"
duration = "10 ms"
[output]
sample = "0.1 ms"
"#;

/// One layer of elements bends: with mean gradients that is hourglass modes and little else.
const CANTILEVER: &str = r#"
title = "cantilever under its weight"
gravity = ["0 m/s2", "0 m/s2", "-9.81 m/s2"]
[body]
density = "1100 kg/m3"
element = "uniform-gradient"
[body.mesh]
generator = "block"
size = ["100 mm", "20 mm", "20 mm"]
elements = [10, 1, 1]
[body.material]
law = "neo-hookean"
shear_modulus = "2.64 MPa"
bulk_modulus = "65.1 MPa"
[rim]
nodes = "x-min"
[[stage]]
method = "quasi-static"
duration = "4 s"
mass_damping = "100 1/s"
[output]
sample = "5 ms"
"#;

struct Ran {
    rows: Recorder,
    share: Option<HourglassShare>,
    error: Option<Error>,
}

/// What a run leaves, finished or not.
fn ran(text: &str, sets: &[&str], precision: Precision) -> Ran {
    let sets: Vec<String> = sets.iter().map(|s| s.to_string()).collect();
    let scene = Scene::parse(text, "hourglass.toml", &sets).unwrap_or_else(|e| panic!("{e}"));
    let model = Model::new(&scene).unwrap();
    let mut engine = cpu::engine(&model, &scene, precision, 1).unwrap();
    let mut rows = Recorder::default();
    let result: Result<_> = simulate_on(&scene, &model, &mut *engine, &mut rows);
    let volume = model.mass.iter().sum::<f64>() / scene.body.density;
    let rounding =
        hexroll::record::rounding_of_energy(scene.body.law.shear_modulus(), volume, precision.epsilon());
    if let Ok(totals) = &result {
        assert_eq!(totals.energy_rounding, rounding);
    }
    let share = HourglassShare::of(&rows.samples, rounding);
    Ran { rows, share, error: result.err() }
}

fn share(ran: &Ran) -> f64 {
    assert!(ran.error.is_none(), "{:?}", ran.error);
    ran.share.expect("a share").of_strain_energy
}

#[test]
fn a_corner_that_lands_first_is_named() {
    for precision in [Precision::F64, Precision::F32] {
        let ran = ran(CORNER, &[], precision);
        let found = share(&ran);
        let samples = &ran.rows.samples;
        let worst = samples.iter().find(|s| s.time_s == ran.share.unwrap().time_s).unwrap();
        assert_eq!(worst.hourglass_J / worst.strain_J, found);
        // 32 % where most is stored, more on the way back, when half of that is.
        let fullest = samples.iter().max_by(|a, b| a.stored().total_cmp(&b.stored())).unwrap();
        close("share", fullest.hourglass_J / fullest.strain_J, 0.32, 0.05);
        assert!(found > 0.32 && worst.stored() >= 0.25 * fullest.stored(), "{found}");
    }
}

#[test]
fn a_cantilever_of_one_layer_is_named() {
    let implicit = [
        "stage.0={ method = \"implicit\", duration = \"1 s\", implicit = { scheme = \"static\", increments = 4 } }",
    ];
    // Single precision loses the strain energy, 3e-6 J, in rounding, 5e-5 J, and takes that for it.
    let cases =
        [(&[][..], Precision::F64, 67.0), (&[], Precision::F32, 4.5), (&implicit, Precision::F64, 67.0)];
    for (sets, precision, expected) in cases {
        let found = share(&ran(CANTILEVER, sets, precision));
        assert!(found > 0.9 * expected, "{precision}, {sets:?}: {found}");
    }
}

#[test]
fn a_limit_ends_the_run_and_keeps_its_rows() {
    let implicit = [
        "stage.0={ method = \"implicit\", duration = \"1 s\", implicit = { scheme = \"static\", increments = 4 } }",
    ];
    for (text, sets) in [(CORNER, &[][..]), (CANTILEVER, &[]), (CANTILEVER, &implicit)] {
        let ran = ran(text, &[sets, &["body.hourglass_limit=0.25"]].concat(), Precision::F64);
        let Some(Error::Hourglass { step, time, share, limit }) = ran.error else {
            panic!("no such error: {:?}", ran.error)
        };
        assert!(step > 0 && limit == 0.25 && share > limit);
        // The row that is beyond the limit is the last.
        let last = ran.rows.samples.last().unwrap();
        assert_eq!((last.time_s, last.hourglass_J / last.strain_J), (time, share));
        let error = Error::Hourglass { step, time, share, limit };
        assert_eq!(error.exit_code(), 5);
        for said in ["body.hourglass_limit = 0.25", "element = \"q1p0\"", "finer mesh"] {
            assert!(error.to_string().contains(said), "{error}");
        }
    }
}

/// What the limit allows goes on; elements without such modes, a block that lands flat, and bodies that store nothing but
/// rounding have nothing to say.
#[test]
fn what_is_no_more_than_a_remedy_stays_silent() {
    assert!(ran(CORNER, &["body.hourglass_limit=5.0"], Precision::F64).error.is_none());
    assert_eq!(ran(CORNER, &["body.element=q1p0"], Precision::F64).share, None);
    let flat = [
        "road={ point = [\"0 m\", \"0 m\", \"-1 mm\"] }",
        "friction.coefficient=0",
        "body.velocity=[\"0 m/s\", \"0 m/s\", \"-1 m/s\"]",
        "body.hourglass_limit=0.1",
    ];
    for precision in [Precision::F64, Precision::F32] {
        let ran = ran(CORNER, &flat, precision);
        assert!(ran.error.is_none(), "{:?}", ran.error);
        assert!(ran.rows.samples.iter().any(|s| s.strain_J > 1e-3), "it has landed");
        assert!(ran.share.is_none_or(|s| s.of_strain_energy < WARNED), "{:?}", ran.share);
    }
    let flying = ["road={ point = [\"0 m\", \"0 m\", \"-1 m\"] }", "body.hourglass_limit=1e-3"];
    let ran = ran(CORNER, &flying, Precision::F32);
    assert!(ran.error.is_none() && ran.share.is_none(), "{:?} {:?}", ran.error, ran.share);
}

#[test]
fn a_limit_needs_an_element_with_such_modes() {
    let sets = ["body.element=q1p0".into(), "body.hourglass_limit=0.3".into()];
    let error = Scene::parse(CORNER, "hourglass.toml", &sets).unwrap_err().to_string();
    assert!(error.contains("body.hourglass_limit: this element has no hourglass modes"), "{error}");
    let error = Scene::parse(CORNER, "hourglass.toml", &["body.hourglass_limit=0".into()]).unwrap_err();
    assert!(error.to_string().contains("not positive"), "{error}");
}

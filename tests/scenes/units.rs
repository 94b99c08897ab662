//! Every unit of every dimension converts to SI; what is not a quantity is refused with the units that are.

use hexroll::Error;
use hexroll::physics::material::NeoHookean;
use hexroll::scene::{Drive, Law, Scene};

use crate::good;

/// Sets `key` to each text and checks the SI value that `get` finds.
fn converts(key: &str, get: fn(&Scene) -> f64, texts: &[(&str, f64)]) {
    for (text, si) in texts {
        let scene = good(&[&format!("{key}={text}")]).unwrap_or_else(|e| panic!("{key} = {text}: {e}"));
        let value = get(&scene);
        // Decimal factors round a few times: a relative 4e-15 is some units in the last place.
        assert!((value - si).abs() <= 4e-15 * si.abs(), "{key} = {text}: {value:e} is not {si:e}");
    }
}

/// Target, or load and mass, of a drive.
fn numbers(drive: Drive) -> (f64, f64) {
    match drive {
        Drive::Hold => panic!("not driven"),
        Drive::Displacement { to, ramp } | Drive::Velocity { to, ramp } => (to, ramp),
        Drive::Free { mass, load, .. } => (load, mass),
    }
}

#[test]
fn units_of_the_body() {
    let modulus = |s: &Scene| match s.body.law {
        Law::NeoHookean(NeoHookean { g1, .. }) => g1,
        other => panic!("{other:?}"),
    };
    converts(
        "body.density",
        |s| s.body.density,
        &[("1100 kg/m3", 1100.0), ("1.1 g/cm^3", 1100.0), ("1.1 t/m³", 1100.0)],
    );
    converts(
        "body.offset.0",
        |s| s.body.offset[0],
        &[("2 m", 2.0), ("39mm", 0.039), ("3 cm", 0.03), ("5 µm", 5e-6), ("5 um", 5e-6), ("1 in", 0.0254)],
    );
    converts(
        "body.material.shear_modulus",
        modulus,
        &[("7 Pa", 7.0), ("7 kPa", 7e3), ("2 MPa", 2e6), ("1 GPa", 1e9), ("1 bar", 1e5), ("2 N/mm2", 2e6)],
    );
    converts(
        "body.material.viscosity",
        |s| s.body.viscosity.unwrap(),
        &[("20 Pa s", 20.0), ("20 Pa*s", 20.0), ("20 Pa·s", 20.0), ("20 mPa s", 0.02)],
    );
    converts("gravity.2", |s| s.gravity[2], &[("-9.81 m/s2", -9.81), ("1 m/s²", 1.0), ("5 mm/s2", 0.005)]);
}

#[test]
fn units_of_motion() {
    let pi = std::f64::consts::PI;
    converts(
        "stage.1.duration",
        |s| s.stages[1].duration,
        &[("2 s", 2.0), ("50 ms", 0.05), ("5e4 us", 0.05), ("1e8 ns", 0.1), ("1 min", 60.0)],
    );
    converts("stage.0.mass_damping", |s| s.stages[0].mass_damping, &[("9 1/s", 9.0), ("3 1/ms", 3000.0)]);
    converts(
        "stage.1.rim.x.velocity",
        |s| numbers(s.stages[1].rim.x).0,
        &[("2.59 m/s", 2.59), ("5 mm/s", 0.005), ("5 cm/s", 0.05), ("36 km/h", 10.0)],
    );
    converts(
        "stage.1.rim.steer.angle",
        |s| numbers(s.stages[1].rim.steer).0,
        &[("0.5 rad", 0.5), ("45 deg", pi / 4.0), ("45°", pi / 4.0), ("1 rev", 2.0 * pi)],
    );
    let spin: fn(&Scene) -> f64 = |s| numbers(s.stages[1].rim.spin).0;
    for (text, si) in [("70 rad/s", 70.0), ("180 deg/s", pi), ("2 rev/s", 4.0 * pi), ("600 rpm", 20.0 * pi)] {
        let set = format!("stage.1.rim.spin={{ velocity = \"{text}\" }}");
        let value = spin(&good(&[&set]).unwrap());
        assert!((value - si).abs() <= 4e-15 * si, "{text}: {value:e} is not {si:e}");
    }
}

#[test]
fn units_of_loads() {
    converts(
        "stage.1.rim.z.force",
        |s| numbers(s.stages[1].rim.z).0,
        &[("-300 N", -300.0), ("-0.3 kN", -300.0), ("5 mN", 0.005), ("1 MN", 1e6)],
    );
    converts(
        "stage.1.rim.z.mass",
        |s| numbers(s.stages[1].rim.z).1,
        &[("50 g", 0.05), ("2 kg", 2.0), ("5 mg", 5e-6), ("0.001 t", 1.0)],
    );
    converts(
        "stage.1.rim.spin.moment",
        |s| numbers(s.stages[1].rim.spin).0,
        &[("4.6 N m", 4.6), ("0 N m", 0.0), ("2 N mm", 0.002), ("2 kN m", 2e3), ("2 mN m", 0.002)],
    );
    converts(
        "stage.1.rim.spin.inertia",
        |s| numbers(s.stages[1].rim.spin).1,
        &[("1e-5 kg m2", 1e-5), ("10 kg mm2", 1e-5), ("100 g cm^2", 1e-5)],
    );
}

#[test]
fn what_is_no_quantity_is_refused_with_the_units_that_are() {
    for (value, problem) in [
        ("1100", "the number 1100 has no unit"),
        ("11.5", "the number 11.5 has no unit"),
        ("\"1100\"", "has no unit"),
        ("2.64 MPa", "\"MPa\" is the unit of a stress or modulus, not of a density"),
        ("39 mm", "\"mm\" is the unit of a length, not of a density"),
        ("5 furlongs", "\"furlongs\" is not a unit of a density"),
        ("heavy", "does not start with a number"),
        ("nan kg/m3", "is not a finite number"),
        ("inf kg/m3", "is not a finite number"),
        ("1e999 kg/m3", "is not a finite number"),
        ("1e308 g/cm3", "is too large"),
        ("true", "a density is expected here, not true or false"),
        ("[1]", "a density is expected here, not an array"),
    ] {
        let Err(Error::Scene { key, problem: p, remedy, .. }) = good(&[&format!("body.density={value}")])
        else {
            panic!("{value} was not refused as a scene error");
        };
        assert_eq!(key, "body.density");
        assert!(p.contains(problem), "{value}: {p}");
        let right = "write a density such as \"1100 kg/m3\" (units: kg/m3, g/cm3, t/m3)";
        assert_eq!(remedy, right, "{value}");
    }
}

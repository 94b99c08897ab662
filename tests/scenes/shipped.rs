//! The scenes that come with the program: each loads, explains itself and says what its name promises.

use std::path::{Path, PathBuf};

use hexroll::Error;
use hexroll::physics::friction::Coulomb;
use hexroll::physics::material::NeoHookean;
use hexroll::physics::road::Plane;
use hexroll::scene::{
    Drive, Element, Friction, ImplicitScheme, InitialVelocity, Law, MeshSpec, Method, Rim, Road, Scene,
};
use hexroll_lab::rig::at_once;
use hexroll_lab::rig::given::{
    AT_5_DEGREES, AT_45_DEGREES, BULK_MODULUS, DENSITY, DEPTH, INNER_RADIUS, LOAD, MESH, OUTER_RADIUS,
    PRESSING, ROLLING, SHEAR_MODULUS, SPIN, STRAIGHT, VISCOSITY, WIDTH,
};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}

fn load(stem: &str) -> Scene {
    Scene::load(&folder().join(format!("{stem}.toml")), &[]).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn every_shipped_scene_loads_and_explains_itself() {
    let mut count = 0;
    for entry in std::fs::read_dir(folder()).unwrap() {
        let path = entry.unwrap().path();
        let scene = Scene::load(&path, &[]).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(scene.file, path);
        assert!(
            !scene.title.is_empty() && !scene.source.is_empty() && !scene.expected.is_empty(),
            "{path:?}"
        );
        let text = std::fs::read_to_string(&path).unwrap();
        let head: String = text.lines().take_while(|l| l.starts_with('#')).collect();
        for word in ["# Claim: ", "# Source: ", "# Expected: "] {
            assert!(head.contains(word), "{path:?} does not begin with its {word}");
        }
        count += 1;
    }
    assert!(count >= 18, "{count} scenes");
}

#[test]
fn every_wheel_is_the_papers() {
    for (stem, eta, mu) in [
        ("lat100_static", None, 1.0),
        ("lat100_static_relaxed", None, 1.0),
        ("lat100_static_height", None, 1.0),
        ("lat100_straight", None, 1.0),
        ("lat100_straight_viscous", Some(VISCOSITY), 1.0),
        ("lat100_straight_relaxed", Some(VISCOSITY), 1.0),
        ("lat100_straight_implicit", Some(VISCOSITY), 1.0),
        ("lat100_slip45", None, 0.5),
        ("lat100_slip45_viscous", Some(VISCOSITY), 0.5),
        ("lat100_slip5_viscous", Some(VISCOSITY), 1.0),
    ] {
        let scene = load(stem);
        let MeshSpec::Ring { outer_radius, inner_radius, width, elements } = scene.body.mesh else {
            panic!("{stem}: no ring")
        };
        let micrometers = [outer_radius, inner_radius, width].map(|l| (l * 1e6).round());
        let given = [OUTER_RADIUS, INNER_RADIUS, WIDTH].map(|l| (l * 1e6).round());
        assert_eq!((micrometers, elements), (given, MESH), "{stem}");
        let Law::NeoHookean(NeoHookean { g0, g1 }) = scene.body.law else { panic!("{stem}: another law") };
        assert_eq!(
            (g0.round(), g1.round(), scene.body.density),
            (BULK_MODULUS, SHEAR_MODULUS, DENSITY),
            "{stem}"
        );
        assert_eq!((scene.body.element, scene.body.viscosity), (Element::Q1p0, eta), "{stem}");
        assert_eq!(scene.friction, Some(Friction::Coulomb(Coulomb { mu })), "{stem}");
        assert_eq!((scene.gravity, scene.rim), ([0.0; 3], Some(Rim { nodes: "inner".into() })), "{stem}");
        let rest = Road::Plane(Plane { point: [0.0; 3], normal: [0.0, 0.0, 1.0], velocity: [0.0; 3] });
        assert_eq!(scene.road, Some(rest), "{stem}");
        // Into equilibrium by the implicit scheme, or relaxed by damped steps.
        match scene.stages[0].method {
            Method::QuasiStatic { .. } => assert_eq!(scene.stages[0].mass_damping, 3000.0, "{stem}"),
            Method::Implicit(i) => assert_eq!(i.scheme, ImplicitScheme::Static { increments: 10 }, "{stem}"),
            Method::Explicit => panic!("{stem}: no equilibrium"),
        }
    }
}

#[test]
fn rolling_wheels_start_at_once_on_their_pressed_shape() {
    for (stem, [x, y]) in [
        ("lat100_straight", STRAIGHT),
        ("lat100_straight_viscous", STRAIGHT),
        ("lat100_straight_relaxed", STRAIGHT),
        ("lat100_slip45", AT_45_DEGREES),
        ("lat100_slip45_viscous", AT_45_DEGREES),
        ("lat100_slip5_viscous", AT_5_DEGREES),
    ] {
        let stages = load(stem).stages;
        let [press, roll] = &stages[..] else { panic!("{stem}: two stages") };
        let Drive::Displacement { to, ramp } = press.rim.z else { panic!("{stem}: not pressed") };
        assert_eq!(
            ((to * 1e9).round(), (ramp * 1e9).round()),
            ((-1e9 * DEPTH).round(), (1e9 * PRESSING).round()),
            "{stem}"
        );
        assert_eq!(roll.rim.x, at_once(x), "{stem}");
        assert_eq!(roll.rim.y, if y == 0.0 { Drive::Hold } else { at_once(y) }, "{stem}");
        assert_eq!((roll.rim.z, roll.rim.spin), (Drive::Hold, at_once(SPIN)), "{stem}");
        assert_eq!(roll.initial_velocity, Some(InitialVelocity::Rim), "{stem}");
        assert_eq!(
            (roll.method, roll.mass_damping, roll.duration),
            (Method::Explicit, 0.0, ROLLING),
            "{stem}"
        );
    }
}

#[test]
fn the_static_wheels_are_each_others_inverse() {
    let (force, height) = (load("lat100_static"), load("lat100_static_height"));
    let Drive::Free { mass, load, .. } = force.stages[0].rim.z else { panic!("z is not free") };
    assert_eq!((mass, load), (0.05, -LOAD));
    assert!(matches!(height.stages[0].rim.z, Drive::Displacement { .. }));
    assert_eq!((force.body, force.friction), (height.body, height.friction));
}

#[test]
fn small_scenes_have_only_what_they_claim() {
    let (bar, spin, bounce) = (load("bar_wave"), load("spinning_block"), load("bouncing_block"));
    assert_eq!((bar.road, bar.rim), (None, Some(Rim { nodes: "x-min".into() })));
    assert_eq!((spin.road, spin.rim, spin.gravity), (None, None, [0.0; 3]));
    assert!(spin.body.angular_velocity[2] > 0.0);
    assert!(bounce.road.is_some() && bounce.friction.is_none() && bounce.body.velocity[2] < 0.0);
    let (slope, pressed) = (load("block_on_slope"), load("pressed_block"));
    let [x, _, z] = slope.gravity;
    // The closed form rests on 9.81 m/s2 at 30 deg, typed with 16 digits.
    assert!((x.hypot(z) - 9.81).abs() < 1e-14 && (x / -z - 1.0 / 3.0_f64.sqrt()).abs() < 1e-14);
    assert!(slope.body.viscosity.is_some() && slope.stages[0].mass_damping > 0.0);
    assert_eq!(slope.stages[1].mass_damping, 0.0);
    assert_eq!(pressed.rim, Some(Rim { nodes: "z-max".into() }));
}

#[test]
fn a_file_that_cannot_be_read_is_named() {
    let error = Scene::load(Path::new("no/such/scene.toml"), &[]).unwrap_err();
    assert!(matches!(error, Error::Io { .. }));
    assert!(error.to_string().contains("no/such/scene.toml: cannot read the scene"), "{error}");
}

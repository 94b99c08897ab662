//! A scene says what its file says, in SI, with documented defaults.

use std::path::Path;

use hexroll::physics::friction::{Coulomb, PressureVelocity, Stribeck, Viscous};
use hexroll::physics::material::{MooneyRivlin, MooneyRivlinEq4, NeoHookean};
use hexroll::physics::road::Plane;
use hexroll::scene::{
    Body, Drive, Element, Field, Friction, Hold, InitialVelocity, Law, MeshSpec, Method, Picture, Rim, Road,
    Scene, Snapshots,
};

use crate::{GOOD, good};

fn near(a: f64, b: f64) {
    // A conversion rounds a few times: a relative 1e-15 is a few units in the last place.
    assert!((a - b).abs() <= 1e-15 * b.abs(), "{a:e} is not {b:e}");
}

#[test]
fn a_scene_is_read_whole_and_in_si() {
    let scene = good(&[]).unwrap();
    assert_eq!((scene.title.as_str(), scene.source.as_str()), ("a wheel", "none"));
    assert_eq!((scene.expected.as_str(), scene.file.as_path()), ("nothing", Path::new("good.toml")));
    assert_eq!(scene.gravity, [0.0, 0.0, -9.81]);
    let Body { density, law, viscosity, element, offset, .. } = &scene.body;
    assert_eq!((*density, *viscosity, *element), (1100.0, None, Element::UniformGradient { hourglass: 0.2 }));
    assert_eq!(*offset, [0.001, 0.0, 0.0]);
    let Law::NeoHookean(NeoHookean { g0, g1 }) = *law else { panic!("g2 = 0 is neo-Hookean") };
    near(g0, 65.1e6);
    near(g1, 2.64e6);
    let MeshSpec::Ring { outer_radius, elements, .. } = scene.body.mesh else { panic!("not a ring") };
    near(outer_radius, 0.039);
    assert_eq!(elements, [12, 2, 2]);
    assert_eq!(scene.rim, Some(Rim { nodes: "inner".into() }));
    let (normal, velocity) = ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
    assert_eq!(scene.road, Some(Road::Plane(Plane { point: [0.0; 3], normal, velocity })));
    assert_eq!((scene.friction, scene.safety), (Some(Friction::Coulomb(Coulomb { mu: 0.8 })), 0.8));
    assert_eq!(scene.output.pictures, [Picture::Body(Field::VonMises), Picture::Footprint]);
    assert_eq!((scene.output.sample, scene.output.snapshots), (0.001, Snapshots::Every(0.01)));
}

#[test]
fn stages_keep_their_order_and_their_rim_motion() {
    let stages = good(&[]).unwrap().stages;
    assert_eq!(stages.iter().map(|s| s.name.as_str()).collect::<Vec<_>>(), ["press", "roll"]);
    let [press, roll] = &stages[..] else { panic!("two stages") };
    assert_eq!(press.method, Method::QuasiStatic { kinetic_ratio: 1e-8, residual: 1e-4 });
    assert_eq!((press.mass_damping, press.duration, press.initial_velocity), (3000.0, 0.2, None));
    let Drive::Displacement { to, ramp } = press.rim.z else { panic!("z is displaced") };
    near(to, -0.0022);
    near(ramp, 0.02);
    assert_eq!((press.rim.x, press.rim.spin), (Drive::Hold, Drive::Hold));
    assert_eq!((roll.method, roll.mass_damping), (Method::Explicit, 0.0));
    assert_eq!(roll.initial_velocity, Some(InitialVelocity::Rim));
    assert_eq!(roll.rim.x, Drive::Velocity { to: 2.59, ramp: 0.001 });
    assert_eq!(roll.rim.z, Drive::Free { mass: 0.05, load: -300.0, ramp: 0.0 });
    assert_eq!(roll.rim.spin, Drive::Free { mass: 1e-5, load: 0.0, ramp: 0.0 });
    let Drive::Displacement { to, .. } = roll.rim.steer else { panic!("steer is displaced") };
    near(to, 5.0 / 180.0 * std::f64::consts::PI);
}

#[test]
fn what_is_left_out_has_the_documented_default() {
    let text = r#"
        title = "least"
        body.density = "1 g/cm3"
        body.mesh = { generator = "block", size = ["1 m", "2 m", "3 m"], elements = [1, 2, 3] }
        body.material = { shear_modulus = "1 MPa", bulk_modulus = "2 MPa" }
        stage = [{ method = "explicit", duration = "1 s" }]
        output.sample = "1 s"
    "#;
    let scene = Scene::parse(text, "least.toml", &[]).unwrap();
    assert_eq!((scene.gravity, scene.safety), ([0.0; 3], 0.9));
    assert_eq!((scene.rim, scene.road, scene.friction), (None, None, None));
    assert_eq!((scene.body.element, scene.body.viscosity), (Element::Q1p0, None));
    assert_eq!((scene.body.velocity, scene.body.angular_velocity), ([0.0; 3], [0.0; 3]));
    assert_eq!((scene.stages[0].name.as_str(), scene.stages[0].rim.x), ("stage 1", Drive::Hold));
    assert_eq!((scene.output.snapshots, scene.output.pictures), (Snapshots::StageEnds, vec![]));
    assert_eq!(scene.body.density, 1000.0);
}

/// The body of a scene with another material.
fn law(material: &str) -> Law {
    good(&[&format!("body.material={{{material}}}")]).unwrap().body.law
}

#[test]
fn moduli_and_constants_map_as_the_law_says() {
    let both = r#"shear_modulus = "3 MPa", bulk_modulus = "60 MPa""#;
    assert_eq!(law(both), Law::NeoHookean(NeoHookean { g0: 60e6, g1: 3e6 }));
    assert_eq!(
        law(&format!("law = \"neo-hookean\", {both}")),
        Law::NeoHookean(NeoHookean { g0: 60e6, g1: 3e6 })
    );
    // Eq. 4's undeviatored terms add 2/3 G to the bulk modulus.
    let eq4 = Law::MooneyRivlinEq4(MooneyRivlinEq4 { g0: 58e6, g1: 3e6, g2: 0.0 });
    assert_eq!(law(&format!("law = \"mooney-rivlin-eq4\", {both}")), eq4);
    let three = r#"g0 = "60 MPa", g1 = "2 MPa", g2 = "1 MPa""#;
    assert_eq!(law(three), Law::MooneyRivlin(MooneyRivlin { g0: 60e6, g1: 2e6, g2: 1e6 }));
    let eq4 = Law::MooneyRivlinEq4(MooneyRivlinEq4 { g0: 60e6, g1: 2e6, g2: 1e6 });
    assert_eq!(law(&format!("law = \"mooney-rivlin-eq4\", {three}")), eq4);
    assert_eq!(law(r#"g0 = "60 MPa", g1 = "2 MPa""#), Law::NeoHookean(NeoHookean { g0: 60e6, g1: 2e6 }));
}

#[test]
fn zero_viscosity_and_zero_friction_are_absent() {
    assert_eq!(good(&["body.material.viscosity=0 Pa s"]).unwrap().body.viscosity, None);
    assert_eq!(good(&["body.material.viscosity=20 Pa s"]).unwrap().body.viscosity, Some(20.0));
    assert_eq!(good(&["friction.coefficient=0"]).unwrap().friction, None);
}

/// The material's Prony series, and the shear modulus of its law [Pa].
fn relaxing(section: &str) -> (Vec<(f64, f64)>, f64) {
    let text = GOOD.replace("[rim]", &format!("[body.material.relaxation]\n{section}\n[rim]"));
    let body = Scene::parse(&text, "relaxing.toml", &[]).unwrap().body;
    (body.relaxation.terms.iter().map(|t| (t.ratio, t.time)).collect(), body.law.shear_modulus())
}

#[test]
fn a_prony_series_is_read_in_every_convention() {
    let modulus = good(&[]).unwrap().body.law.shear_modulus();
    let term = "terms = [{ ratio = 0.3, time = \"0.1 s\" }]";
    let (terms, law) = relaxing(term);
    near(terms[0].0, 0.3 / 0.7);
    assert_eq!((terms.len(), terms[0].1, law), (1, 0.1, modulus));
    // The law of a sudden strain: 0.7 of it is left.
    let (terms, law) = relaxing(&format!("{term}\nconstants = \"instantaneous\""));
    near(terms[0].0, 0.3 / 0.7);
    near(law, 0.7 * modulus);
    let (terms, law) = relaxing(
        "terms = [{ ratio = 0.5, time = \"1 s\" }, { ratio = 1.5, time = \"2 ms\" }]\nratios = \"of-long-term\"",
    );
    assert_eq!((terms, law), (vec![(0.5, 1.0), (1.5, 0.002)], modulus));
    // At the reference nothing is shifted; c1 = 10, c2 = 40 and 10 K above it make all times 100 times shorter.
    let shifted = |temperature: f64| {
        let shift = format!("shift = {{ c1 = 10, c2 = 40, reference = 20, temperature = {temperature} }}");
        relaxing(&format!("{term}\n{shift}")).0[0].1
    };
    near(shifted(20.0), 0.1);
    near(shifted(30.0), 0.001);
}

#[test]
fn a_prony_series_that_cannot_be_is_refused() {
    let refused = |section: &str, key: &str, problem: &str| {
        let text = GOOD.replace("[rim]", &format!("[body.material.relaxation]\n{section}\n[rim]"));
        let shown = Scene::parse(&text, "bad.toml", &[]).expect_err("a mistake").to_string();
        assert!(shown.contains(key) && shown.contains(problem), "{section}: {shown}");
    };
    refused("terms = []", "body.material.relaxation.terms", "without a term");
    refused(
        "terms = [{ ratio = 0.6, time = \"1 s\" }, { ratio = 0.4, time = \"2 s\" }]",
        "terms",
        "nothing is left",
    );
    refused("terms = [{ ratio = -0.1, time = \"1 s\" }]", "terms.0.ratio", "positive");
    refused("terms = [{ ratio = 0.1, time = \"0 s\" }]", "terms.0.time", "positive");
    refused("terms = [{ ratio = 0.1, tau = \"1 s\" }]", "terms.0.tau", "unknown key");
    let cold = "terms = [{ ratio = 0.1, time = \"1 s\" }]\nshift = { c1 = 17, c2 = 50, reference = 20, temperature = -40 }";
    refused(cold, "shift.temperature", "no end");
    let dynamic =
        GOOD.replace("[rim]", "[body.material.relaxation]\nterms = [{ ratio = 0.1, time = \"1 s\" }]\n[rim]");
    let eq4 = dynamic.replace("law = \"mooney-rivlin\"", "law = \"mooney-rivlin-eq4\"");
    let shown = Scene::parse(&eq4, "bad.toml", &[]).expect_err("a mistake").to_string();
    assert!(shown.contains("no isochoric part"), "{shown}");
}

#[test]
fn a_road_normal_has_length_one_whatever_is_written() {
    for scale in [1e-200, 1.0, 3.0, 1e200] {
        let set = format!("road.normal=[0, {:e}, {:e}]", -3.0 * scale, 4.0 * scale);
        let Some(Road::Plane(Plane { normal, .. })) = good(&[&set]).unwrap().road else { panic!("a plane") };
        near(normal[1], -0.6);
        near(normal[2], 0.8);
    }
}

#[test]
fn a_displacement_needs_no_ramp_where_the_rim_already_is() {
    let stays = r#"stage.1.rim={ z = { displacement = "-2.2 mm" } }"#;
    let z = good(&[stays]).unwrap().stages[1].rim.z;
    assert!(matches!(z, Drive::Displacement { ramp: 0.0, .. }), "{z:?}");
}

#[test]
fn holds_gradings_and_friction_laws_are_read() {
    let scene = good(&[
        "hold=[{ nodes = \"all\", components = \"y\" }]",
        "body.mesh.grading=[4, 0.5, 1]",
        "body.mesh.fine_arc=90 deg",
        "friction={ law = \"pressure-velocity\", a = 0.5, b = 0.6, pressure = \"0.3 MPa\", c = 0.3, speed = \"0.5 m/s\" }",
    ])
    .unwrap();
    assert_eq!(
        scene.holds,
        [Hold { nodes: "all".into(), components: [false, true, false], reaction: false }]
    );
    assert_eq!(scene.body.grading.ratio, [4.0, 0.5, 1.0]);
    near(scene.body.grading.fine_arc, std::f64::consts::FRAC_PI_2);
    let Some(Friction::PressureVelocity(PressureVelocity { a, b, pressure, c, speed })) = scene.friction
    else {
        panic!("the fit")
    };
    for (got, expected) in [(a, 0.5), (b, 0.6), (pressure, 3e5), (c, 0.3), (speed, 0.5)] {
        near(got, expected);
    }
    let law = |text: &str| good(&[text]).unwrap().friction;
    let Some(Friction::Viscous(Viscous { slope })) = law("friction={ law = \"viscous\", slope = \"2 s/m\" }")
    else {
        panic!("viscous")
    };
    near(slope, 2.0);
    let text = "friction={ law = \"stribeck\", static = 1.2, kinetic = 0.8, speed = \"100 mm/s\" }";
    let Some(Friction::Stribeck(Stribeck { still, kinetic, speed, slope })) = law(text) else {
        panic!("Stribeck")
    };
    for (got, expected) in [(still, 1.2), (kinetic, 0.8), (speed, 0.1), (slope, 0.0)] {
        near(got, expected);
    }
}

//! Scene files say what is meant, and every mistake is answered with file, line, key and what would be right.

use std::path::{Path, PathBuf};

use hexroll::Error;
use hexroll::scene::{
    Body, Drive, Element, Field, Friction, InitialVelocity, Law, MeshSpec, Method, NodeSet, Picture, Rim, Road,
    Scene, Snapshots,
};

/// A small scene that uses every section; mistakes are edited into it.
const GOOD: &str = r#"title = "a wheel"
source = "none"
expected = "nothing"
gravity = ["0 m/s2", "0 m/s2", "-9.81 m/s2"]

[body]
density = "1100 kg/m3"
element = "uniform-gradient"
hourglass = 0.2
offset = ["1 mm", "0 mm", "0 mm"]

[body.mesh]
generator = "ring"
outer_radius = "39 mm"
inner_radius = "17 mm"
width = "17.5 mm"
elements = [12, 2, 2]

[body.material]
shear_modulus = "2.64 MPa"
bulk_modulus = "65.1 MPa"

[rim]
nodes = "inner"

[road]
shape = "plane"
point = ["0 m", "0 m", "0 m"]
normal = [0, 0, 2]
velocity = ["1 m/s", "0 m/s", "0 m/s"]

[friction]
law = "coulomb"
coefficient = 0.8

[time_step]
safety = 0.8

[[stage]]
name = "press"
method = "quasi-static"
duration = "0.2 s"
mass_damping = "3000 1/s"
settle = { kinetic_ratio = 1e-8, residual = 1e-4 }

[stage.rim]
z = { displacement = "-2.2 mm", ramp = "20 ms" }

[[stage]]
name = "roll"
method = "explicit"
duration = "50 ms"
initial_velocity = "rim"

[stage.rim]
x = { velocity = "2.59 m/s", ramp = "1 ms" }
z = { force = "-300 N", mass = "50 g" }
steer = { angle = "5 deg", ramp = "5 ms" }
spin = { moment = "0 N m", inertia = "1e-5 kg m2" }

[output]
sample = "1 ms"
snapshots = "10 ms"
pictures = ["body:von-mises", "footprint"]
"#;

fn good(overrides: &[&str]) -> Result<Scene, Error> {
    Scene::parse(GOOD, "good.toml", &overrides.iter().map(|s| s.to_string()).collect::<Vec<_>>())
}

fn near(a: f64, b: f64) {
    // One conversion rounds twice at most: a relative 1e-15 is a few units in the last place.
    assert!((a - b).abs() <= 1e-15 * b.abs(), "{a:e} is not {b:e}");
}

fn shipped() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut paths: Vec<_> = (std::fs::read_dir(folder).unwrap()).map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

fn shipped_scene(stem: &str) -> Scene {
    let path = shipped().into_iter().find(|p| p.file_stem().is_some_and(|s| s == stem)).unwrap();
    Scene::load(&path, &[]).unwrap()
}

#[test]
fn a_scene_is_read_whole_and_in_si() {
    let scene = good(&[]).unwrap();
    assert_eq!((scene.title.as_str(), scene.source.as_str()), ("a wheel", "none"));
    assert_eq!((scene.expected.as_str(), scene.file.as_path()), ("nothing", Path::new("good.toml")));
    assert_eq!(scene.gravity, [0.0, 0.0, -9.81]);
    let Body { density, law, viscosity, element, offset, .. } = &scene.body;
    assert_eq!((*density, *viscosity, *element), (1100.0, None, Element::UniformGradient { hourglass: 0.2 }));
    assert_eq!((*law, *offset), (Law::NeoHookean { g0: 65.1e6, g1: 2.64e6 }, [0.001, 0.0, 0.0]));
    let MeshSpec::Ring { outer_radius, elements, .. } = scene.body.mesh else { panic!("not a ring") };
    near(outer_radius, 0.039);
    assert_eq!(elements, [12, 2, 2]);
    assert_eq!(scene.rim, Some(Rim { nodes: NodeSet::Inner }));
    let (normal, velocity) = ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
    assert_eq!(scene.road, Some(Road::Plane { point: [0.0; 3], normal, velocity }));
    assert_eq!((scene.friction, scene.safety), (Some(Friction::Coulomb { mu: 0.8 }), 0.8));
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

#[test]
fn every_unit_converts_to_si() {
    let tau = std::f64::consts::TAU;
    let density = |s: Scene| s.body.density;
    let length = |s: Scene| s.body.offset[0];
    let modulus = |s: Scene| match s.body.law {
        Law::NeoHookean { g1, .. } => g1,
        other => panic!("{other:?}"),
    };
    let time = |s: Scene| s.stages[1].duration;
    let rate = |s: Scene| s.stages[0].mass_damping;
    let speed = |s: Scene| s.body.velocity[0];
    let spin = |s: Scene| s.body.angular_velocity[2];
    let gravity = |s: Scene| s.gravity[2];
    let eta = |s: Scene| s.body.viscosity.unwrap();
    let load = |d: Drive| match d {
        Drive::Free { load, .. } => load,
        other => panic!("{other:?}"),
    };
    let mass = |d: Drive| match d {
        Drive::Free { mass, .. } => mass,
        other => panic!("{other:?}"),
    };
    let force = |s: Scene| load(s.stages[1].rim.z);
    let weight = |s: Scene| mass(s.stages[1].rim.z);
    let moment = |s: Scene| load(s.stages[1].rim.spin);
    let inertia = |s: Scene| mass(s.stages[1].rim.spin);
    let angle = |s: Scene| match s.stages[1].rim.steer {
        Drive::Displacement { to, .. } => to,
        other => panic!("{other:?}"),
    };
    let (density_key, offset, g) = ("body.density", "body.offset.0", "body.material.shear_modulus");
    let (duration, alpha, viscosity) = ("stage.1.duration", "stage.0.mass_damping", "body.material.viscosity");
    let (v, omega) = ("body.velocity=[\"?\", \"0 m/s\", \"0 m/s\"]", "body.angular_velocity=[\"0 rpm\", \"0 rpm\", \"?\"]");
    let (z, m) = ("stage.1.rim.z.force", "stage.1.rim.z.mass");
    let (torque, J) = ("stage.1.rim.spin.moment", "stage.1.rim.spin.inertia");
    let cases: [(&str, &dyn Fn(Scene) -> f64, &[(&str, f64)]); 14] = [
        (density_key, &density, &[("1100 kg/m3", 1100.0), ("1.1 g/cm^3", 1100.0), ("1.1 t/m³", 1100.0)]),
        (
            offset,
            &length,
            &[("2 m", 2.0), ("39mm", 0.039), ("3 cm", 0.03), ("5 µm", 5e-6), ("5 um", 5e-6), ("1 km", 1e3), ("1 in", 0.0254)],
        ),
        (
            g,
            &modulus,
            &[("7 Pa", 7.0), ("7 kPa", 7e3), ("2.64 MPa", 2.64e6), ("1 GPa", 1e9), ("1 bar", 1e5), ("2 N/mm2", 2e6)],
        ),
        (duration, &time, &[("2 s", 2.0), ("50 ms", 0.05), ("5e4 us", 0.05), ("1e8 ns", 0.1), ("1 min", 60.0)]),
        (alpha, &rate, &[("3000 1/s", 3000.0), ("3 1/ms", 3000.0)]),
        (v, &speed, &[("2.59 m/s", 2.59), ("5 mm/s", 0.005), ("5 cm/s", 0.05), ("36 km/h", 10.0)]),
        (omega, &spin, &[("70 rad/s", 70.0), ("180 deg/s", tau / 2.0), ("2 rev/s", 2.0 * tau), ("600 rpm", 10.0 * tau)]),
        ("gravity.2", &gravity, &[("-9.81 m/s2", -9.81), ("-9.81 m/s^2", -9.81), ("5 mm/s2", 0.005)]),
        (viscosity, &eta, &[("20 Pa s", 20.0), ("20 Pa*s", 20.0), ("20 Pa·s", 20.0), ("20 mPa s", 0.02)]),
        (z, &force, &[("-300 N", -300.0), ("-0.3 kN", -300.0), ("5 mN", 0.005), ("1 MN", 1e6)]),
        (m, &weight, &[("50 g", 0.05), ("2 kg", 2.0), ("5 mg", 5e-6), ("0.001 t", 1.0)]),
        (torque, &moment, &[("4.6 N m", 4.6), ("2 N mm", 0.002), ("2 kN m", 2e3), ("2 mN m", 0.002)]),
        (J, &inertia, &[("1e-5 kg m2", 1e-5), ("10 kg mm2", 1e-5), ("100 g cm^2", 1e-5)]),
        (
            "stage.1.rim.steer.angle",
            &angle,
            &[("0.5 rad", 0.5), ("45 deg", tau / 8.0), ("45°", tau / 8.0), ("1 rev", tau)],
        ),
    ];
    for (key, get, texts) in cases {
        for (text, si) in texts {
            let set = if key.contains('?') { key.replace('?', text) } else { format!("{key}={text}") };
            let value = get(good(&[&set]).unwrap_or_else(|e| panic!("{set}: {e}")));
            // uom multiplies by decimal factors: a few roundings.
            assert!((value - si).abs() <= 1e-15 * si.abs() * 4.0, "{set}: {value:e} is not {si:e}");
        }
    }
}

/// One mistake: the text of GOOD that it replaces (its faulty line ends in `#!`), and the answer.
struct Mistake(&'static str, &'static str, &'static str, &'static str, &'static str);

/// Edits a mistake into GOOD and checks file, line, key, problem and remedy of the error.
fn check(&Mistake(from, to, key, problem, remedy): &Mistake) {
    assert_eq!(GOOD.matches(from).count(), 1, "{from:?} must stand once in the good scene");
    let text = GOOD.replace(from, to);
    let faulty = text.lines().position(|l| l.contains("#!")).map(|i| i + 1);
    let error = match Scene::parse(&text, "bad.toml", &[]) {
        Ok(_) => panic!("{to:?} was accepted"),
        Err(error) => error,
    };
    let shown = error.to_string();
    let Error::Scene { file, line, key: k, problem: p, remedy: r } = error else { panic!("{to:?}: {shown}") };
    assert_eq!(file, "bad.toml", "{shown}");
    assert_eq!(line, faulty, "{to:?}: {shown}");
    assert_eq!(k, key, "{to:?}: {shown}");
    assert!(p.contains(problem), "{to:?}: problem of {shown}");
    assert!(r.contains(remedy), "{to:?}: remedy of {shown}");
    assert!(shown.starts_with(&format!("bad.toml:{}: {key}: ", line.unwrap())), "{shown}");
}

const DENSITY: &str = "density = \"1100 kg/m3\"";
const MODULI: &str = "shear_modulus = \"2.64 MPa\"\nbulk_modulus = \"65.1 MPa\"";
const MOTION: &str = "x = { velocity = \"2.59 m/s\", ramp = \"1 ms\" }";
const PRESS: &str = "z = { displacement = \"-2.2 mm\", ramp = \"20 ms\" }";

#[test]
fn unknown_keys_and_names_are_answered_with_the_known_ones() {
    [
        Mistake(DENSITY, "densty = \"1100 kg/m3\" #!", "body.densty", "unknown key", "did you mean density?"),
        Mistake("[time_step]", "[tme_step] #!", "tme_step", "unknown key", "did you mean time_step?"),
        Mistake("width =", "breite = 1 #!\nwidth =", "body.mesh.breite", "unknown key", "elements, "),
        Mistake("residual = 1e-4 }", "resid = 1e-4 } #!", "stage.0.settle.resid", "unknown", "did you mean residual?"),
        Mistake(MOTION, "u = { velocity = \"1 m/s\" } #!", "stage.1.rim.u", "unknown key", "x, y, z, steer"),
        Mistake("\"-300 N\", mass", "\"-300 N\", masse", "stage.1.rim.z.masse", "unknown key", "did you mean mass?"),
        Mistake("safety = 0.8", "safty = 0.8 #!", "time_step.safty", "unknown key", "did you mean safety?"),
        Mistake("snapshots = ", "snapshot = 1 #!\nsnapshots = ", "output.snapshot", "unknown key", "mean snapshots?"),
        Mistake("\"uniform-gradient\"", "\"q1p1\" #!", "body.element", "\"q1p1\" is not known", "did you mean q1p0?"),
        Mistake("generator = \"ring\"", "generator = \"sphere\" #!", "body.mesh.generator", "not known", "ring, block"),
        Mistake(MODULI, "law = \"hooke\" #!", "body.material.law", "not known", "neo-hookean"),
        Mistake("shape = \"plane\"", "shape = \"plain\" #!", "road.shape", "not known", "did you mean plane?"),
        Mistake("law = \"coulomb\"", "law = \"columb\" #!", "friction.law", "not known", "did you mean coulomb?"),
        Mistake("\"explicit\"", "\"explizit\" #!", "stage.1.method", "not known", "did you mean explicit?"),
        Mistake("= \"rim\"", "= \"rum\" #!", "stage.1.initial_velocity", "not known", "did you mean rim?"),
        Mistake("\"footprint\"]", "\"foot\"] #!", "output.pictures.1", "not known", "footprint, body:displacement"),
        Mistake("\"10 ms\"", "\"never\" #!", "output.snapshots", "not known", "\"none\", \"stage-ends\" or a time"),
    ]
    .iter()
    .for_each(|mistake| {
        let Mistake(from, to, key, problem, remedy) = *mistake;
        // One of them ends in the middle of a line: its mark goes there.
        if to.contains("#!") { check(mistake) } else { mark(from, to, key, problem, remedy) }
    });
}

/// A mistake inside an inline table: the whole line is the faulty one.
fn mark(from: &'static str, to: &'static str, key: &'static str, problem: &'static str, remedy: &'static str) {
    let line = GOOD.lines().find(|l| l.contains(from)).unwrap();
    let faulty = format!("{} #!", line.replace(from, to));
    let (line, faulty) = (Box::leak(line.to_string().into_boxed_str()), Box::leak(faulty.into_boxed_str()));
    check(&Mistake(line, faulty, key, problem, remedy));
}

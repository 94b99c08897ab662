//! Every mistake is answered with file, line, key, what is wrong and what would be right.

use hexroll::Error;
use hexroll::model::Model;
use hexroll::scene::Scene;

use crate::{GOOD, good};

/// What stands once in the good scene, what replaces it, and the answer: key, part of the problem, part of the
/// remedy.
type Mistake = (&'static str, &'static str, &'static str, &'static str, &'static str);

/// Line of the good scene on which a text starts.
fn line_of(text: &str) -> usize {
    1 + GOOD[..GOOD.find(text).unwrap()].matches('\n').count()
}

/// The answer must name the line that was edited.
fn check(mistake: Mistake) {
    check_at(line_of(mistake.0), mistake);
}

fn check_at(line: usize, (from, to, key, problem, remedy): Mistake) {
    assert_eq!(GOOD.matches(from).count(), 1, "{from:?} must stand once in the good scene");
    let shown = match Scene::parse(&GOOD.replace(from, to), "bad.toml", &[]) {
        Err(error @ Error::Scene { .. }) => error.to_string(),
        other => panic!("{to:?} gives {other:?}"),
    };
    assert!(shown.starts_with(&format!("bad.toml:{line}: {key}: ")), "{to:?}, line {line}, {key}: {shown}");
    let (said, advised) = shown.split_once("; ").unwrap();
    assert!(said.contains(problem), "{to:?}: {problem:?} is not in {said:?}");
    assert!(advised.contains(remedy), "{to:?}: {remedy:?} is not in {advised:?}");
}

#[test]
fn unknown_keys_are_answered_with_the_known_ones() {
    const UNKNOWN: [Mistake; 15] = [
        ("title =", "titel =", "titel", "unknown key", "did you mean title?"),
        ("[time_step]", "[tme_step]", "tme_step", "unknown key", "did you mean time_step?"),
        ("density =", "densty =", "body.densty", "unknown key", "did you mean density?"),
        (
            "width =",
            "breite =",
            "body.mesh.breite",
            "unknown key",
            "outer_radius, inner_radius, width, elements",
        ),
        ("shear_modulus", "young", "body.material.young", "unknown key", "shear_modulus, bulk_modulus"),
        ("nodes =", "node =", "rim.node", "unknown key", "did you mean nodes?"),
        ("point =", "points =", "road.points", "unknown key", "did you mean point?"),
        ("coefficient =", "mu =", "friction.mu", "unknown key", "law, coefficient"),
        ("safety =", "safty =", "time_step.safty", "unknown key", "did you mean safety?"),
        ("residual =", "resid =", "stage.0.settle.resid", "unknown key", "kinetic_ratio, residual"),
        ("name = \"roll\"", "nam = \"roll\"", "stage.1.nam", "unknown key", "did you mean name?"),
        ("steer =", "stear =", "stage.1.rim.stear", "unknown key", "did you mean steer?"),
        ("\"50 g\"", "\"50 g\", colour = 1", "stage.1.rim.z.colour", "unknown key", "force, mass, ramp"),
        ("ramp = \"1 ms\"", "mas = \"1 g\"", "stage.1.rim.x.mas", "unknown key", "velocity, ramp"),
        ("snapshots =", "snapshot =", "output.snapshot", "unknown key", "did you mean snapshots?"),
    ];
    UNKNOWN.into_iter().for_each(check);
}

#[test]
fn unknown_names_are_answered_with_the_known_ones() {
    const NAMES: [Mistake; 9] = [
        ("\"uniform-gradient\"", "\"q1p1\"", "body.element", "\"q1p1\" is not known", "did you mean q1p0?"),
        ("\"ring\"", "\"sphere\"", "body.mesh.generator", "not known", "ring, block"),
        ("\"mooney-rivlin\"", "\"hooke\"", "body.material.law", "not known", "neo-hookean"),
        ("\"plane\"", "\"plain\"", "road.shape", "not known", "did you mean plane?"),
        ("\"coulomb\"", "\"columb\"", "friction.law", "not known", "did you mean coulomb?"),
        ("\"explicit\"", "\"explizit\"", "stage.1.method", "not known", "did you mean explicit?"),
        ("\"rim\"", "\"rum\"", "stage.1.initial_velocity", "not known", "did you mean rim?"),
        ("\"footprint\"", "\"foot\"", "output.pictures.1", "not known", "footprint, body:displacement"),
        ("\"10 ms\"", "\"never\"", "output.snapshots", "not known", "\"none\", \"stage-ends\" or a time"),
    ];
    NAMES.into_iter().for_each(check);
}

#[test]
fn what_is_missing_is_asked_for_at_its_table() {
    const ROLL: &str = "[[stage]]\nname = \"roll\"";
    const PRESS: &str = "[[stage]]\nname = \"press\"";
    const MISSING: [(&str, Mistake); 14] = [
        ("title", ("title = \"a wheel\"\n", "", "title", "missing", "add title = ")),
        ("[body]", ("density = \"1100 kg/m3\"\n", "", "body.density", "missing", "\"1100 kg/m3\"")),
        (
            "[body.mesh]",
            ("generator = \"ring\"\n", "", "body.mesh.generator", "missing", "\"ring\" or \"block\""),
        ),
        ("[body.mesh]", ("width = \"17.5 mm\"\n", "", "body.mesh.width", "missing", "add width = \"39 mm\"")),
        ("[body.mesh]", ("elements = [12, 2, 2]\n", "", "body.mesh.elements", "missing", "[44, 4, 5]")),
        ("[body.mat", ("bulk_modulus = \"65.1 MPa\"", "", "body.material.bulk_modulus", "missing", "MPa")),
        ("[rim]", ("nodes = \"inner\"\n", "", "rim.nodes", "missing", "\"inner\"")),
        (
            "[friction]",
            ("coefficient = 0.8\n", "", "friction.coefficient", "missing", "add coefficient = 1.0"),
        ),
        (ROLL, ("method = \"explicit\"\n", "", "stage.1.method", "missing", "\"explicit\"")),
        (ROLL, ("duration = \"50 ms\"\n", "", "stage.1.duration", "missing", "add duration = \"20 ms\"")),
        (
            PRESS,
            (
                "mass_damping = \"3000 1/s\"\n",
                "",
                "stage.0.mass_damping",
                "missing",
                "add mass_damping = \"3000 1/s\"",
            ),
        ),
        ("[output]", ("sample = \"1 ms\"\n", "", "output.sample", "missing", "add sample = ")),
        ("z = { force", (", mass = \"50 g\"", "", "stage.1.rim.z.mass", "missing", "add mass = \"50 g\"")),
        ("z = { disp", (", ramp = \"20 ms\"", "", "stage.0.rim.z.ramp", "missing", "add ramp = \"20 ms\"")),
    ];
    // The line is that of the table, not of a key that is not there.
    MISSING.into_iter().for_each(|(table, mistake)| check_at(line_of(table), mistake));
    for (section, advised) in [("body", "[body]"), ("stage", "[[stage]]"), ("output", "[output]")] {
        let cut: Vec<_> =
            GOOD.split("\n\n").filter(|p| !p.trim_start_matches('[').starts_with(section)).collect();
        let shown = Scene::parse(&cut.join("\n\n"), "bad.toml", &[]).unwrap_err().to_string();
        assert!(
            shown.starts_with(&format!("bad.toml:1: {section}: missing; add a section {advised}")),
            "{shown}"
        );
    }
}

/// In one piece: a list.
#[test]
fn wrong_units_and_kinds_of_value_are_answered_with_right_ones() {
    const KINDS: [Mistake; 16] = [
        (
            "\"a wheel\"",
            "7",
            "title",
            "a string is expected here, not a whole number",
            "put the text in quotes",
        ),
        (
            "\"-9.81 m/s2\"]",
            "\"-9.81 m/s\"]",
            "gravity.2",
            "unit of a velocity, not of an acc",
            "(units: m/s2,",
        ),
        ("\"-9.81 m/s2\"]", "-9.81]", "gravity.2", "the number -9.81 has no unit", "such as \"-9.81 m/s2\""),
        (
            "\"0 m/s2\", \"-9.81",
            "\"-9.81",
            "gravity",
            "2 entries where 3 are needed",
            "write e.g. [\"-9.81 m/s2\",",
        ),
        ("\"39 mm\"", "39", "body.mesh.outer_radius", "the number 39 has no unit", "(units: m, cm, mm, um"),
        (
            "\"39 mm\"",
            "\"39 MPa\"",
            "body.mesh.outer_radius",
            "stress or modulus, not of a length",
            "\"39 mm\"",
        ),
        (
            "[12, 2, 2]",
            "[12.0, 2, 2]",
            "body.mesh.elements.0",
            "whole number is expected",
            "without quotes or dec",
        ),
        ("[12, 2, 2]", "12", "body.mesh.elements", "an array is expected here", "square brackets"),
        ("[0, 0, 2]", "[0, 0]", "road.normal", "2 entries where 3 are needed", "[0, 0, 1]"),
        (
            "coefficient = 0.8",
            "coefficient = \"0.8\"",
            "friction.coefficient",
            "not a string",
            "without quotes",
        ),
        (
            "\"3000 1/s\"",
            "\"3000 Hz\"",
            "stage.0.mass_damping",
            "\"Hz\" is the unit of a frequency",
            "(units: 1/s, 1/ms)",
        ),
        ("\"50 ms\"", "\"50 mm\"", "stage.1.duration", "unit of a length, not of a time", "(units: s, ms"),
        (
            "\"0 N m\"",
            "\"0 N\"",
            "stage.1.rim.spin.moment",
            "unit of a force, not of a moment",
            "(units: N m",
        ),
        ("\"10 ms\"", "10", "output.snapshots", "the number 10 has no unit", "(units: s, ms"),
        (
            "spin = { moment = \"0 N m\", inertia = \"1e-5 kg m2\" }",
            "spin = 3",
            "stage.1.rim.spin",
            "a table",
            "{ key",
        ),
        ("\"a wheel\"", "1979-05-27", "title", "dates are not used", "in quotes"),
    ];
    KINDS.into_iter().for_each(check);
}

/// In one piece: a list.
#[test]
fn an_impossible_body_is_refused() {
    const SUM: &str = "g0 = \"1 MPa\"\ng1 = \"1 MPa\"\ng2 = \"-1 MPa\"";
    const MATERIAL: &str = "\"mooney-rivlin\"\nshear_modulus = \"2.64 MPa\"\nbulk_modulus = \"65.1 MPa\"";
    const NEO: &str = "\"neo-hookean\"\ng0 = \"1 Pa\"\ng1 = \"1 Pa\"\ng2 = \"1 Pa\"";
    const CONSTANTS: &str = "shear_modulus = \"2.64 MPa\"\nbulk_modulus = \"65.1 MPa\"";
    const BODY: [Mistake; 17] = [
        (
            "\"1100 kg/m3\"",
            "\"-1 kg/m3\"",
            "body.density",
            "\"-1 kg/m3\" is not positive",
            "greater than zero",
        ),
        ("\"1100 kg/m3\"", "\"0 kg/m3\"", "body.density", "is not positive", "greater than zero"),
        ("\"1100 kg/m3\"", "\"nan kg/m3\"", "body.density", "is not a finite number", "\"1100 kg/m3\""),
        ("\"1100 kg/m3\"", "nan", "body.density", "has no unit", "\"1100 kg/m3\""),
        ("= 0.2", "= 0", "body.hourglass", "0 is not positive", "greater than zero"),
        (
            "\"17 mm\"",
            "\"39 mm\"",
            "body.mesh.inner_radius",
            "inside-out ring: 0.039 m",
            "less than outer_radius",
        ),
        ("\"17 mm\"", "\"40 mm\"", "body.mesh.inner_radius", "inside-out ring", "less than outer_radius"),
        ("\"17 mm\"", "\"0 mm\"", "body.mesh.inner_radius", "is not positive", "greater than zero"),
        ("\"17.5 mm\"", "\"-17.5 mm\"", "body.mesh.width", "is not positive", "greater than zero"),
        (
            "[12, 2, 2]",
            "[2, 2, 2]",
            "body.mesh.elements.0",
            "2 is too few",
            "at least 3 are needed to close a ring",
        ),
        ("[12, 2, 2]", "[12, 0, 2]", "body.mesh.elements.1", "0 is too few", "at least 1 is needed"),
        ("[12, 2, 2]", "[12, 2, -2]", "body.mesh.elements.2", "-2 is too few", "at least 1 is needed"),
        ("[12, 2, 2]", "[12000, 2000, 2000]", "body.mesh.elements", "too many elements", "536 million"),
        ("\"65.1 MPa\"", "\"0 MPa\"", "body.material.bulk_modulus", "is not positive", "greater than zero"),
        (
            "\"2.64 MPa\"",
            "\"-2.64 MPa\"",
            "body.material.shear_modulus",
            "is not positive",
            "greater than zero",
        ),
        (
            "[rim]",
            "viscosity = \"-1 Pa s\"\n[rim]",
            "body.material.viscosity",
            "is negative",
            "zero or a positive",
        ),
        (CONSTANTS, "g0 = \"-1 Pa\"\ng1 = \"1 Pa\"", "body.material.g0", "bulk modulus -1 Pa", "a larger g0"),
    ];
    BODY.into_iter().for_each(check);
    // In these the faulty line comes after the first edited one.
    const LATER: [(usize, Mistake); 4] = [
        (1, ("uniform-gradient", "q1p0", "body.hourglass", "no hourglass modes", "\"uniform-gradient\"")),
        (
            1,
            (
                "shear_mod",
                "g0 = \"1 Pa\"\nshear_mod",
                "body.material.shear_modulus",
                "besides g0",
                "either the moduli",
            ),
        ),
        (1, (CONSTANTS, SUM, "body.material.g1", "shear modulus 0 Pa is not", "a larger g1")),
        (3, (MATERIAL, NEO, "body.material.g2", "neo-hookean has no g2", "remove the key")),
    ];
    LATER.into_iter().for_each(|(lines, mistake)| check_at(line_of(mistake.0) + lines, mistake));
}

#[test]
fn an_impossible_road_or_friction_is_refused() {
    const ROAD: [Mistake; 8] = [
        ("[0, 0, 2]", "[0, 0, 0]", "road.normal", "no direction", "e.g. [0, 0, 1]"),
        ("[0, 0, 2]", "[0, 0, inf]", "road.normal.2", "inf is not a finite number", "finite"),
        ("[0, 0, 2]", "[0, nan, 1]", "road.normal.1", "is not a finite number", "finite"),
        ("[\"1 m/s\",", "[\"nan m/s\",", "road.velocity.0", "is not a finite number", "m/s"),
        (
            "= 0.8\n\n[time",
            "= -0.1\n\n[time",
            "friction.coefficient",
            "-0.1 is negative",
            "zero or a positive",
        ),
        ("= 0.8\n\n[time", "= nan\n\n[time", "friction.coefficient", "not a finite number", "finite"),
        ("safety = 0.8", "safety = 0", "time_step.safety", "0 is not positive", "greater than zero"),
        ("safety = 0.8", "safety = -1.5", "time_step.safety", "-1.5 is not positive", "greater than zero"),
    ];
    ROAD.into_iter().for_each(check);
    let leaves = "normal = [0, 0, 2]\nvelocity = [\"0 m/s\", \"0 m/s\", \"1e-3 m/s\"]";
    let line = line_of("normal =") + 1;
    let good = "normal = [0, 0, 2]\nvelocity = [\"1 m/s\", \"0 m/s\", \"0 m/s\"]";
    check_at(
        line,
        (good, leaves, "road.velocity", "leave its plane at 0.001 m/s", "perpendicular to the normal"),
    );
}

/// The good scene without the paragraphs that start with one of `heads`.
fn without(heads: &[&str]) -> String {
    let kept = GOOD.split("\n\n").filter(|p| !heads.iter().any(|h| p.starts_with(h)));
    kept.collect::<Vec<_>>().join("\n\n")
}

#[test]
fn what_needs_a_rim_or_a_road_says_so() {
    for (cut, key, said, advised) in [
        (
            &["[road]"][..],
            "friction",
            "friction without a road",
            "add a section [road], or remove [friction]",
        ),
        (&["[road]", "[friction]"], "output.pictures.1", "no contact without a road", "add a section [road]"),
        (&["[rim]"], "stage.0.rim", "the scene has no rim", "add a section [rim], or remove this one"),
        (&["[rim]", "[stage.rim]"], "stage.1.initial_velocity", "the scene has no rim", "or write \"zero\""),
    ] {
        let text = without(cut);
        let shown = Scene::parse(&text, "bad.toml", &[]).unwrap_err().to_string();
        let Some((line, rest)) = shown.strip_prefix("bad.toml:").and_then(|s| s.split_once(": ")) else {
            panic!("no line in {shown}");
        };
        let text_there = text.lines().nth(line.parse::<usize>().unwrap() - 1).unwrap();
        let last = key.split('.').rfind(|k| k.parse::<usize>().is_err()).unwrap();
        assert!(text_there.contains(last), "line {line} is {text_there:?}, not {key}");
        assert!(
            rest.starts_with(&format!("{key}: ")) && rest.contains(said) && rest.contains(advised),
            "{shown}"
        );
    }
}

/// In one piece: a list.
#[test]
fn an_impossible_stage_is_refused() {
    const STAGE: [Mistake; 16] = [
        ("\"50 ms\"", "\"-50 ms\"", "stage.1.duration", "\"-50 ms\" is not positive", "greater than zero"),
        ("\"50 ms\"", "\"0 s\"", "stage.1.duration", "is not positive", "greater than zero"),
        ("\"3000 1/s\"", "\"-3 1/s\"", "stage.0.mass_damping", "is negative", "zero or a positive"),
        (
            "\"3000 1/s\"",
            "\"0 1/s\"",
            "stage.0.mass_damping",
            "without damping nothing settles",
            "\"3000 1/s\"",
        ),
        ("1e-8", "0", "stage.0.settle.kinetic_ratio", "0 is not positive", "greater than zero"),
        ("1e-4", "-1e-4", "stage.0.settle.residual", "-0.0001 is not positive", "greater than zero"),
        ("\"20 ms\"", "\"0 ms\"", "stage.0.rim.z.ramp", "nothing can be moved at once", "e.g. \"20 ms\""),
        ("\"20 ms\"", "\"-20 ms\"", "stage.0.rim.z.ramp", "is negative", "zero or a positive"),
        (
            "\"20 ms\"",
            "\"1 s\"",
            "stage.0.rim.z.ramp",
            "longer than the stage of 0.2 s",
            "shorter ramp or a longer",
        ),
        ("\"50 g\"", "\"0 g\"", "stage.1.rim.z.mass", "is not positive", "greater than zero"),
        (
            "\"1e-5 kg m2\"",
            "\"-1 kg m2\"",
            "stage.1.rim.spin.inertia",
            "is not positive",
            "greater than zero",
        ),
        ("\"-300 N\"", "\"inf N\"", "stage.1.rim.z.force", "is not a finite number", "\"-300 N\""),
        (
            "angle = \"5 deg\"",
            "moment = \"1 N m\"",
            "stage.1.rim.steer",
            "cannot be free",
            "{ angle = .., ramp = .. }",
        ),
        ("angle = \"5 deg\", ", "", "stage.1.rim.steer", "no motion", "exactly one of angle, velocity"),
        (
            "force =",
            "displacement = \"1 mm\", force =",
            "stage.1.rim.z",
            "displacement and force exclude",
            "exactly one",
        ),
        (
            "displacement = \"-2.2 mm\"",
            "velocity = \"1 m/s\"",
            "stage.0.rim.z.velocity",
            "never settles",
            "displacement",
        ),
    ];
    STAGE.into_iter().for_each(check);
    let lasts = "an explicit stage lasts its whole duration";
    check_at(
        line_of("settle ="),
        ("\"quasi-static\"", "\"explicit\"", "stage.0.settle", lasts, "\"quasi-static\""),
    );
    let none = good(&["stage=[]"]).unwrap_err().to_string();
    assert!(none.starts_with("good.toml: stage: no stage (from --set); add a section [[stage]]"), "{none}");
}

#[test]
fn an_impossible_output_is_refused() {
    const OUTPUT: [Mistake; 6] = [
        ("sample = \"1 ms\"", "sample = \"0 ms\"", "output.sample", "is not positive", "greater than zero"),
        ("sample = \"1 ms\"", "sample = \"-1 ms\"", "output.sample", "is not positive", "greater than zero"),
        (
            "sample = \"1 ms\"",
            "sample = \"60 ms\"",
            "output.sample",
            "longer than stage \"roll\" of 0.05 s",
            "no longer",
        ),
        (
            "\"10 ms\"",
            "\"0.5 ms\"",
            "output.snapshots",
            "shorter than a sample of 0.001 s",
            "one or more samples",
        ),
        ("\"10 ms\"", "\"-10 ms\"", "output.snapshots", "is not positive", "greater than zero"),
        ("\"footprint\"", "7", "output.pictures.1", "a string is expected", "in quotes"),
    ];
    OUTPUT.into_iter().for_each(check);
}

#[test]
fn toml_syntax_errors_name_their_line() {
    check(("[rim]", "[rim", "TOML syntax", "", "https://toml.io"));
    check(("[time_step]", "[rim]", "TOML syntax", "duplicate key", "https://toml.io"));
    check(("safety = 0.8", "safety = 99999999999999999999", "time_step.safety", "out of range", "64 bits"));
}

#[test]
fn what_comes_later_is_called_unavailable_not_unknown() {
    for (set, what, instead) in [
        ("road.shape=sphere", "road.shape: \"sphere\"", "\"plane\""),
        ("road.shape=rough", "road.shape: \"rough\"", "\"height-field\""),
        ("road.roughness=1 mm", "road.roughness", "height-field"),
        ("friction.law=table", "friction.law: \"table\"", "\"coulomb\""),
        ("body.mesh.generator=import", "body.mesh.generator: \"import\"", "write file = \"wheel.inp\""),
        ("stage.1.friction.coefficient=0.5", "stage.1.friction", "the same in every stage"),
        ("sweep.mu=[0.1, 0.2]", "sweep", "--set"),
        ("checkpoint.every=1 s", "checkpoint", "in one piece"),
    ] {
        let Err(error @ Error::Unsupported { .. }) = good(&[set]) else { panic!("{set} is not answered so") };
        let shown = error.to_string();
        assert!(shown.contains("is not available in this version"), "{shown}");
        assert!(shown.contains(what) && shown.contains(instead), "{shown}");
        assert_eq!(error.exit_code(), 3);
    }
    let text = GOOD.replace("shape = \"plane\"", "shape = \"sphere\"");
    let shown = Scene::parse(&text, "bad.toml", &[]).unwrap_err().to_string();
    let line = line_of("shape =");
    assert!(shown.starts_with(&format!("bad.toml:{line}: road.shape")), "{shown}");
}

/// Node sets belong to the mesh: what it does not have is answered where the scene names it, once it is meshed.
#[test]
fn node_sets_are_those_of_the_mesh() {
    let meshed = |overrides: &[&str]| match Model::new(&good(overrides).unwrap()) {
        Ok(model) => Ok(model.mesh.rim.len()),
        Err(error) => Err(error.to_string()),
    };
    let line = line_of("nodes =");
    let block = r#"body.mesh={ generator = "block", size = ["1 m", "1 m", "1 m"], elements = [1, 1, 1] }"#;
    assert_eq!(
        meshed(&[block]).unwrap_err(),
        format!(
            "good.toml:{line}: rim.nodes: the mesh has no node set \"inner\"; \
             known here: all, x-min, x-max, y-min, y-max, z-min, z-max"
        )
    );
    assert_eq!(meshed(&[block, "rim.nodes=y-max"]), Ok(4));
    assert_eq!(
        meshed(&["rim.nodes=iner"]).unwrap_err(),
        "good.toml: rim.nodes: the mesh has no node set \"iner\" (from --set); \
         did you mean inner? known here: all, inner, outer, y-min, y-max"
    );
    let holds = [
        "gravity=[\"0 m/s2\", \"0 m/s2\", \"0 m/s2\"]",
        "hold=[{ nodes = \"all\", components = \"y\" }, { nodes = \"x-min\", components = \"y\" }]",
    ];
    let shown = meshed(&holds).unwrap_err();
    assert!(shown.starts_with("good.toml: hold.1.nodes: the mesh has no node set \"x-min\""), "{shown}");
    let shown = meshed(&["rim.nodes=all"]).unwrap_err();
    assert!(shown.contains("rim.nodes: the rim has every node"), "{shown}");
}

#[test]
fn sizes_of_a_block_are_positive() {
    let block = r#"body.mesh={ generator = "block", size = ["1 m", "1 m", "1 m"], elements = [1, 1, 1] }"#;
    let flat = block.replace("\"1 m\"]", "\"0 m\"]");
    let shown = good(&[&flat]).unwrap_err().to_string();
    assert!(
        shown.starts_with("good.toml: body.mesh.size.2: \"0 m\" is not positive (from --set)"),
        "{shown}"
    );
}

#[test]
fn holds_gradings_and_friction_laws_are_checked() {
    let wrong = |sets: &[&str], key: &str, problem: &str| {
        let shown = good(sets).unwrap_err().to_string();
        assert!(shown.contains(key) && shown.contains(problem), "{sets:?}: {shown}");
    };
    wrong(&["hold=[{ nodes = \"all\" }]"], "hold.0.components", "missing");
    wrong(&["hold=[{ nodes = \"all\", components = \"yw\" }]"], "hold.0.components", "names no components");
    wrong(&["hold=[{ nodes = \"all\", components = \"z\" }]"], "hold.0", "normal points along");
    wrong(&["hold=[{ nodes = \"all\", components = \"x\" }]"], "hold.0", "road moves along");
    wrong(&["body.mesh.grading=[1, 0, 1]"], "body.mesh.grading.1", "not positive");
    wrong(&["body.mesh.grading=[1, 1, 1e6]"], "body.mesh.grading.2", "differ by a factor");
    wrong(&["body.mesh.fine_arc=20 deg"], "body.mesh.fine_arc", "all elements round the ring are equal");
    wrong(&["body.mesh.fine_arc=400 deg", "body.mesh.grading=[4, 1, 1]"], "body.mesh.fine_arc", "whole turn");
    wrong(&["friction={ law = \"viscous\", slope = 2 }"], "friction.slope", "no unit");
    wrong(&["friction={ law = \"stribeck\", static = 1 }"], "friction.kinetic", "missing");
    let falls = "friction={ law = \"pressure-velocity\", a = 0.1, b = -0.2, pressure = \"1 MPa\", c = 0, speed = \"1 m/s\" }";
    wrong(&[falls], "friction.a", "would fall to");
    let implicit = "stage.0.method=implicit";
    let scheme = "stage.0.implicit={ scheme = \"static\" }";
    let Err(Error::Unsupported { what, .. }) = Scene::parse(
        &GOOD
            .replace("settle = { kinetic_ratio = 1e-8, residual = 1e-4 }\n", "")
            .replace("mass_damping = \"3000 1/s\"\n", ""),
        "bad.toml",
        &[implicit, scheme, "hold=[{ nodes = \"all\", components = \"y\" }]"].map(String::from),
    ) else {
        panic!("an implicit stage holds no components beside a road")
    };
    assert!(what.contains("hold"), "{what}");
}

//! `hexroll check` and `hexroll adapters`: what they say, and that nothing runs.

use serde_json::Value;

use super::program::{Place, shipped};

fn check(place: &Place, arguments: &[&str]) -> Value {
    let done = place.hexroll(&[&["check", "--json"], arguments].concat()).expect(0);
    serde_json::from_str(&done.stdout).unwrap()
}

fn program<'v>(check: &'v Value, kernel: &str) -> &'v Value {
    let programs = check["gpu"]["programs"].as_array().unwrap();
    programs.iter().find(|p| p["kernel"] == kernel).unwrap_or_else(|| panic!("no {kernel} in {programs:#?}"))
}

fn strings(value: &Value) -> Vec<&str> {
    value.as_array().unwrap().iter().map(|v| v.as_str().unwrap()).collect()
}

fn bindings(check: &Value, kernel: &str) -> Vec<String> {
    let list = program(check, kernel)["bindings"].as_array().unwrap();
    list.iter().map(|b| b["name"].as_str().unwrap().to_string()).collect()
}

#[test]
fn the_check_says_what_is_modelled_and_runs_nothing() {
    let place = Place::new();
    let text = place.hexroll(&["check", &shipped("lat100_straight.toml")]).expect(0).stdout;
    for part in [
        "880 elements of 4 shapes",
        "1,320 nodes",
        "G = 2.64 MPa, kappa = 65.1 MPa",
        "viscosity      -  left out",
        "gravity        -  left out",
        "Coulomb, mu = 1",
        "rigid, prescribed",
        "implicit, static, 10 increments or more",
        "element_force",
        "bindings",
        "measured now",
        "CPU memory of a run",
        "search for the critical step",
        "warning: friction on a purely elastic material chatters",
    ] {
        assert!(text.contains(part), "{part:?} is missing in\n{text}");
    }
    let left: Vec<_> = std::fs::read_dir(place.dir.path()).unwrap().collect();
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn the_wave_speed_and_step_are_those_of_the_material() {
    let place = Place::new();
    let check = check(&place, &[&shipped("lat100_straight.toml")]);
    let number = |path: &str| check.pointer(path).unwrap().as_f64().unwrap();
    // c_d = sqrt((kappa + 4/3 G)/rho) = sqrt(68.62e6/1100) m/s
    assert!((number("/body/wave_speed_m_s") - 249.763_6).abs() < 1e-3);
    // Single elements are below the step of the assembled wheel, but not by half.
    let assembled = hexroll_lab::rig::reference("at-rest.dt").value;
    let bound = number("/steps/element_bound_s");
    assert!((0.5 * assembled..assembled).contains(&bound), "{bound}");
    assert!((number("/steps/dt_s") / bound - 0.95).abs() < 1e-12);
    // Ten increments of statics, then explicit steps.
    let at_most = 10.0 + (0.1 / (0.95 * bound)).ceil();
    assert_eq!(number("/steps/total"), at_most);
    assert!(number("/estimates/0/updates_per_s") > 0.0);
}

#[test]
fn programs_hold_only_what_the_scene_uses() {
    let place = Place::new();
    place.scene("block.toml", |text| text);
    let full = check(&place, &["block.toml"]);
    let parts = strings(&program(&full, "boundary")["parts"]);
    assert!(parts.contains(&"friction/coulomb") && parts.contains(&"gravity/uniform"), "{parts:?}");
    assert!(bindings(&full, "boundary").contains(&"surface_sums".into()));
    // Nodes inside the body meet no road.
    let inside = strings(&program(&full, "node")["parts"]);
    assert!(!inside.contains(&"friction/coulomb") && inside.contains(&"gravity/uniform"), "{inside:?}");
    assert!(bindings(&full, "element_force").contains(&"viscous_work".into()));

    let bare = check(
        &place,
        &["block.toml", "--set", "friction.coefficient=0", "--set", "body.material.viscosity=0 Pa s"],
    );
    let parts = strings(&program(&bare, "boundary")["parts"]);
    assert!(!parts.contains(&"friction/coulomb") && parts.contains(&"rub/none"), "{parts:?}");
    assert!(!bindings(&bare, "element_force").contains(&"viscous_work".into()));

    let bar = check(&place, &[&shipped("bar_wave.toml")]);
    assert!(!bindings(&bar, "boundary").contains(&"surface_sums".into()), "no road, no contact");
    assert!(bindings(&bar, "boundary").contains(&"rim_sums".into()));
}

/// The kernel of small meshes is there where it would be taken, with what the stage has and no more.
#[test]
fn a_mesh_for_one_work_group_has_its_kernel() {
    let place = Place::new();
    let kernels = |arguments: &[&str]| -> Vec<String> {
        let check = check(&place, arguments);
        let programs = check["gpu"]["programs"].as_array().unwrap();
        programs.iter().map(|p| p["kernel"].as_str().unwrap().to_string()).collect()
    };
    let wheel = shipped("lat100_straight_viscous.toml");
    assert!(kernels(&[&wheel]).contains(&"resident".into()));
    assert!(
        !kernels(&[&wheel, "--set", "body.mesh.elements=[44, 5, 5]"]).contains(&"resident".into()),
        "1,584 nodes"
    );
    let free = shipped("lat100_free_rolling.toml");
    let check = check(&place, &[&free]);
    let stages = strings(&program(&check, "resident")["stages"]);
    let rolling = strings(&program(&check, "rim")["stages"]);
    assert!(
        !rolling.is_empty() && rolling.iter().all(|stage| !stages.contains(stage)),
        "{stages:?} {rolling:?}"
    );
}

/// Each program is WGSL that stands by itself.
#[test]
fn programs_are_written_where_they_are_asked_for() {
    let place = Place::new();
    let folder = place.dir.path().join("wgsl");
    // A stage's name is anybody's text.
    let (scene, name) = (shipped("lat100_free_rolling.toml"), "stage.0.name=\"../a/b\\nc\"");
    let check = check(&place, &[&scene, "--set", name, "--programs", folder.to_str().unwrap()]);
    let files: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|f| f.unwrap().path()).collect();
    assert_eq!(files.len(), check["gpu"]["programs"].as_array().unwrap().len(), "{files:?}");
    for file in &files {
        let text = std::fs::read_to_string(file).unwrap();
        naga::front::wgsl::parse_str(&text)
            .unwrap_or_else(|e| panic!("{file:?}: {}", e.emit_to_string(&text)));
    }
    assert!(folder.join("element_force.wgsl").is_file(), "{files:?}");
}

#[test]
fn memory_grows_with_the_mesh() {
    let place = Place::new();
    place.scene("block.toml", |text| text);
    let slots = |elements: &str| {
        let check = check(&place, &["block.toml", "--set", &format!("body.mesh.elements={elements}")]);
        let buffers = check["gpu"]["buffers"].as_array().unwrap().clone();
        buffers.iter().find(|b| b["name"] == "slots").unwrap()["bytes"].as_u64().unwrap()
    };
    // Four single-precision numbers for two corners of a face, for 64 chains side by side, and two more corners where a row
    // ends: two rows, and five. Chains of so small meshes have one element, and two faces, each; one layer of them stands on
    // the other along z.
    assert_eq!(
        (slots("[2, 2, 2]"), slots("[4, 5, 6]")),
        (2 * 2 * 16 * 2 * (64 + 2), 6 * 2 * 16 * 2 * (64 + 5))
    );
}

/// On a GPU a generator's mesh needs no tables, and chains side by side share their slots: the state is 34 B an element, what the
/// element pass hands to the node pass 39 B, and the rest is little.
#[test]
fn a_large_wheel_takes_at_most_120_bytes_an_element() {
    let place = Place::new();
    let wheel = shipped("lat100_straight_viscous.toml");
    let check = check(&place, &[&wheel, "--set", "body.mesh.elements=[352, 40, 32]"]);
    let elements = check["body"]["elements"].as_u64().unwrap();
    assert_eq!(elements, 352 * 40 * 32);
    let each = check["gpu"]["bytes"].as_f64().unwrap() / elements as f64;
    assert!((80.0..120.0).contains(&each), "{each} B");
}

/// What a mesh does not have is said: a block that spins on a road has no rows of nodes round its axle.
#[test]
fn a_body_without_rows_round_its_axle_is_named() {
    let place = Place::new();
    let rim = "\n[rim]\nnodes = \"z-max\"\n\n[road]";
    place.scene("block.toml", |text| text.replace("\n[road]", rim));
    let spin = ["block.toml", "--set", "stage.0.rim={ spin = { velocity = \"10 rad/s\" } }"];
    let [still, spun, wheel] = [&spin[..1], &spin, &[&shipped("lat100_straight_viscous.toml")]]
        .map(|arguments| check(&place, arguments));
    let named = |check: &Value| check["warnings"].to_string().contains("no rows of outermost nodes");
    assert_eq!([named(&still), named(&spun), named(&wheel)], [false, true, false]);
    assert_eq!((&spun["body"]["around"], &wheel["body"]["around"]), (&Value::Null, &44.into()));
    assert_eq!(strings(&wheel["body"]["node_sets"]), ["all", "inner", "outer", "y-min", "y-max"]);
}

#[test]
fn a_coarse_wheel_is_warned_of() {
    let place = Place::new();
    let warnings = |elements: &str| {
        let set = format!("body.mesh.elements={elements}");
        let check = check(&place, &[&shipped("lat100_straight_viscous.toml"), "--set", &set]);
        check["warnings"].to_string()
    };
    assert_eq!(warnings("[44, 4, 5]"), "[]");
    let coarse = warnings("[12, 1, 5]");
    for part in ["polygon", "one element thick", "spans only"] {
        assert!(coarse.contains(part), "{part:?} is missing in {coarse}");
    }
}

#[test]
fn adapters_are_listed_with_the_one_that_is_taken() {
    let place = Place::new();
    let text = place.hexroll(&["adapters"]).expect(0);
    assert!(text.stdout.contains("--engine auto takes "), "{}", text.stdout);
    assert!(!text.stderr.contains("XDG_RUNTIME_DIR"), "{}", text.stderr);
    let json: Value = serde_json::from_str(&place.hexroll(&["adapters", "--json"]).expect(0).stdout).unwrap();
    let seen = hexroll::gpu::adapters();
    let names: Vec<_> =
        json["adapters"].as_array().unwrap().iter().map(|a| a["name"].as_str().unwrap()).collect();
    assert_eq!(names, seen.iter().map(|a| a.name.as_str()).collect::<Vec<_>>());
}

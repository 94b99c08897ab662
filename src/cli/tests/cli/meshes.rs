//! `hexroll mesh`, and scenes whose mesh is a file.

use super::program::{Place, shipped};

/// A ring exported and imported: `check` says what is in the file; two programs read the rest.
#[test]
fn a_mesh_is_written_and_taken_by_a_scene() {
    let place = Place::new();
    let sets = ["--set", "body.mesh.elements=[12, 2, 2]"];
    let done = place.hexroll(
        &[&["mesh", &shipped("lat100_straight.toml"), "--out", "m", "--only", "inp"], &sets[..]].concat(),
    );
    assert!(done.expect(0).stdout.contains("mesh.inp"));
    let left: Vec<_> = std::fs::read_dir(place.path("m")).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(left, ["mesh.inp"]);
    let text = std::fs::read_to_string(shipped("lat100_straight.toml")).unwrap();
    let from = text.find("[body.mesh]").unwrap();
    let to = from + 1 + text[from + 1..].find("\n[").unwrap();
    let file = "[body.mesh]\nfile = \"m/mesh.inp\"\nunit = \"m\"\naxle = [\"0 mm\", \"0 mm\", \"39 mm\"]\n";
    std::fs::write(place.path("imported.toml"), format!("{}{file}{}", &text[..from], &text[to..])).unwrap();
    let check = place.hexroll(&["check", "imported.toml"]).expect(0).stdout;
    for part in [
        "mesh.inp: Abaqus deck, coordinates in m; axle at (0.0000, 0.0000, 39.0000) mm, as the scene says",
        "48 elements of 2 shapes",
        "12 elements round the axle; node sets: all, inner, outer, y-min, y-max",
        "worst scaled Jacobian",
        "elements that limit the step:",
    ] {
        assert!(check.contains(part), "{part:?} is missing in\n{check}");
    }
}

/// A scene that says no material is answered with what the deck says.
#[test]
fn a_deck_says_its_material_where_the_scene_does_not() {
    let place = Place::new();
    let deck = "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n*ELEMENT, TYPE=C3D8\n1,1,2,3,4,5,6,7,8\n\
                *MATERIAL, NAME=RUBBER\n*DENSITY\n1.1e-9\n*HYPERELASTIC, NEO HOOKE\n1.32, 0.04\n";
    std::fs::write(place.path("cube.inp"), deck).unwrap();
    let scene = "title = \"t\"\n[body]\n[body.mesh]\nfile = \"cube.inp\"\nunit = \"mm\"\n[[stage]]\nmethod = \"explicit\"\nduration = \"1 ms\"\n\
                 [output]\nsample = \"1 ms\"\n";
    std::fs::write(place.path("cube.toml"), scene).unwrap();
    let error = place.hexroll(&["check", "cube.toml"]).expect(2).stderr;
    for part in [
        "density = \"1100 kg/m3\"",
        "shear_modulus = \"2640000 Pa\"",
        "bulk_modulus = \"50000000 Pa\"",
        "line 14",
    ] {
        assert!(error.contains(part), "{part:?} is missing in\n{error}");
    }
}

/// Without a unit nothing is read: a wheel of 39 m would be.
#[test]
fn the_unit_of_a_file_has_to_be_said() {
    let place = Place::new();
    let file = shipped("lat100_straight.toml");
    let error = place.hexroll(&["check", &file, "--set", "body.mesh={ file = \"a.inp\" }"]).expect(2).stderr;
    assert!(error.contains("body.mesh.unit: missing: files of meshes have no units"), "{error}");
    let error = place
        .hexroll(&["check", &file, "--set", "body.mesh={ file = \"a.inp\", unit = \"N\" }"])
        .expect(2)
        .stderr;
    assert!(error.contains("\"N\" is not a unit of a length"), "{error}");
    let error = place
        .hexroll(&["check", &file, "--set", "body.mesh={ file = \"a.stl\", unit = \"m\" }"])
        .expect(2)
        .stderr;
    assert!(error.contains("files that end in \"stl\" are not read"), "{error}");
}

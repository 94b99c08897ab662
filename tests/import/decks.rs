//! Decks that other people wrote: read, or refused by name with the line.

use std::path::Path;

use hexroll::model::mesh::Mesh;
use hexroll::model::mesh::import::materials;
use hexroll::scene::{LengthUnit, MeshFile};

use crate::rig::{metres, numbers, parts};

fn deck(name: &str) -> MeshFile {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/decks").join(name);
    MeshFile { unit: LengthUnit { name: "mm".into(), metres: 1e-3 }, ..metres(&path) }
}

fn volume(mesh: &Mesh) -> f64 {
    let det = |hex: &[u32; 8]| {
        let corners = hex.map(|n| mesh.nodes[n as usize]);
        hexroll::physics::element::Class::<f64>::new(&corners, 0.0, 0.0).unwrap().volume
    };
    mesh.hexes.iter().map(det).sum()
}

/// FrontISTR's quarter of a cylinder that is a little thinner in its middle: counts of its result file, sets of its mesh.
#[test]
fn the_cylinder_of_frontistr_is_read() {
    let mesh = Mesh::imported(&deck("frontistr_mooney_cylinder.msh"), None).unwrap();
    assert_eq!((mesh.nodes.len(), mesh.hexes.len()), (629, 432));
    let sizes = ["LOADS", "FIX", "YSYMM", "XSYMM", "SECT1"].map(|set| mesh.set(set).unwrap().len());
    // Counted in the file: 38..74; 1..37; 7 + 7 + 15 + 15 + 75; 1 + 6 + 7 + 15 + 90.
    assert_eq!(sizes, [37, 37, 119, 119, 629]);
    // Radii 6.297 and 6.413 mm, 26.667 mm long: the faceted quarter lies between inscribed and full circles.
    let quarter = |r: f64| 0.25 * std::f64::consts::PI * r * r * 26.667e-9;
    let volume = volume(&mesh);
    assert!((0.98 * quarter(6.297)..quarter(6.413)).contains(&volume), "{volume:e}");
    assert!(mesh.notes.iter().any(|n| n.contains("361")), "{:?}", mesh.notes);
}

#[test]
fn the_beam_of_frontistr_is_read() {
    let mesh = Mesh::imported(&deck("frontistr_beam_hyper.msh"), None).unwrap();
    assert_eq!((mesh.nodes.len(), mesh.hexes.len()), (24, 5));
    assert_eq!(numbers(&mesh, "SET-1"), ["21", "22", "23", "24"]);
    assert_eq!(numbers(&mesh, "SET-2"), ["1", "3"]);
    assert!((volume(&mesh) - 5e-9).abs() < 1e-20);
}

/// What was posted as a tyre is tetrahedra: named with count, line and what to do.
#[test]
fn the_tractor_wheel_is_refused_by_name() {
    let (line, problem, remedy) = parts(Mesh::imported(&deck("chrono_tractor_wheel_excerpt.INP"), None));
    assert_eq!(line, Some(12));
    assert!(problem.contains("of type C3D10"), "{problem}");
    assert!(remedy.contains("hexahedra"), "{remedy}");
}

/// A control file is no mesh, and says so by its ending.
#[test]
fn other_endings_are_refused() {
    let (_, problem, remedy) = parts(Mesh::imported(&deck("frontistr_beam_hyper.cnt"), None));
    assert!(problem.contains("\"cnt\"") && remedy.contains(".inp"), "{problem}; {remedy}");
}

/// FrontISTR writes materials into the control file: the mesh says none that could be used.
#[test]
fn meshes_without_materials_say_none() {
    assert!(materials(&deck("frontistr_beam_hyper.msh")).unwrap().is_empty());
}

//! One wheel in the files of Gmsh, meshio and VTK: the same body from each.

use std::path::Path;

use hexroll::cpu::Precision;
use hexroll::model::Model;
use hexroll::model::mesh::{Mesh, quality};
use hexroll::scene::{Axis, Drive, LengthUnit, MeshFile, MeshSpec, NodeSet, Rim};
use hexroll_lab::rig::{explicit, simulate_with, wheel};

use crate::rig::metres;

fn file(name: &str) -> MeshFile {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/meshes").join(name);
    let unit = LengthUnit { name: "mm".into(), metres: 1e-3 };
    MeshFile { unit, axis: Axis::Z, ..metres(&path) }
}

const WITH_GROUPS: [&str; 5] =
    ["wheel-4.1.msh", "wheel-4.1-binary.msh", "wheel-2.2.msh", "wheel-2.2-binary.msh", "wheel.inp"];
const GRIDS: [&str; 5] = [
    "wheel-meshio.vtu",
    "wheel-vtk-ascii.vtu",
    "wheel-vtk-binary.vtu",
    "wheel-vtk-appended.vtu",
    "wheel-vtk-raw.vtu",
];

/// Corners of every element, sorted by element: a body without numbers. Text of Gmsh has 16 digits.
fn body(mesh: &Mesh) -> Vec<Vec<[i64; 3]>> {
    let corner = |n: &u32| mesh.nodes[*n as usize].map(|c| (c * 1e12).round() as i64);
    let mut all: Vec<Vec<[i64; 3]>> = mesh.hexes.iter().map(|hex| hex.iter().map(corner).collect()).collect();
    all.sort_unstable();
    all
}

#[test]
fn every_file_has_the_same_body() {
    let expected = body(&Mesh::imported(&file("wheel-4.1.msh"), None).unwrap());
    assert_eq!(expected.len(), 64);
    for name in WITH_GROUPS.into_iter().chain(GRIDS) {
        let mesh = Mesh::imported(&file(name), None).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!((mesh.nodes.len(), mesh.hexes.len()), (144, 64), "{name}");
        assert!(body(&mesh) == expected, "{name}");
    }
}

/// Groups are sets; the axle is found from the rim's nodes; the file's z is along y.
#[test]
fn groups_are_sets_and_the_rim_has_the_axle() {
    for name in WITH_GROUPS {
        let mesh = Mesh::imported(&file(name), Some(&NodeSet::from("rim"))).unwrap();
        let sizes = ["rim", "tread", "rubber"].map(|set| mesh.set(set).unwrap().len());
        // 16 nodes round, 3 across; 3 radii.
        assert_eq!(sizes, [48, 48, 144], "{name}");
        for (got, wanted) in mesh.axle.into_iter().zip([0.020, 0.005, 0.010]) {
            assert!((got - wanted).abs() < 1e-12, "{name}: {:?}", mesh.axle);
        }
        for (set, radius) in [("rim", 0.017), ("tread", 0.039)] {
            for n in mesh.set(set).unwrap() {
                let [x, y, z] = mesh.nodes[n as usize];
                let arm = (x - mesh.axle[0]).hypot(z - mesh.axle[2]);
                assert!((arm - radius).abs() < 1e-9, "{name}: {set} at {arm}");
                assert!((y - 0.005).abs() < 0.00875 + 1e-12);
            }
        }
        let ring = mesh.ring().unwrap();
        assert_eq!(ring.around, 16, "{name}");
        // Chords of 22.5 degrees: the corner angles of trapezoids, whose sine is cos 11.25 degrees.
        let (worst, _) = quality::worst(&mesh).unwrap();
        assert!((worst - (11.25f64).to_radians().cos()).abs() < 1e-6, "{name}: {worst}");
    }
}

/// The wheel of Gmsh is the ring generator's of 16 x 2 x 2 elements under other numbers, and at another place: pressed on the road
/// while it turns, it has the same forces.
#[test]
fn gmsh_and_the_generator_have_the_same_forces() {
    let mut scene = wheel([16, 2, 2], 0.8);
    scene.output.sample = 2e-4;
    let mut stage = explicit("roll", 4e-4);
    stage.rim.z = Drive::Displacement { to: -2e-3, ramp: 4e-4 };
    stage.rim.spin = Drive::Velocity { to: 30.0, ramp: 0.0 };
    scene.stages.push(stage);
    let mut other = scene.clone();
    other.body.mesh = MeshSpec::File(file("wheel-2.2-binary.msh"));
    // From (20, 5, 10) mm to the generator's axle.
    other.body.offset = [-0.020, -0.005, 0.039 - 0.010];
    other.rim = Some(Rim { nodes: "rim".into() });
    let forces = [&scene, &other].map(|scene| {
        let run = simulate_with(scene, Model::new(scene).unwrap(), Precision::F64, 1).unwrap();
        let last = run.last();
        [last.road_fx_N, last.road_fy_N, last.road_fz_N, last.rim_my_Nm, last.strain_J]
    });
    assert!(forces[0][2] > 1.0, "the wheel is on the road");
    for (a, b) in forces[0].iter().zip(forces[1]) {
        // Points that Gmsh puts on its circles to 1e-10 m, of a press of 2 mm. A side force is zero, and round-off of the others.
        assert!((a - b).abs() <= 2e-7 * a.abs() + 1e-9 * forces[0][2], "{forces:?}");
    }
}

/// Without a rim the axle is the middle of the body.
#[test]
fn a_body_without_rim_has_its_middle() {
    let mesh = Mesh::imported(&file("wheel-vtk-raw.vtu"), None).unwrap();
    for (got, wanted) in mesh.axle.into_iter().zip([0.020, 0.005, 0.010]) {
        assert!((got - wanted).abs() < 1e-12, "{:?}", mesh.axle);
    }
    assert!(mesh.description.contains("the middle of the body"), "{}", mesh.description);
}

#[test]
fn tetrahedra_are_refused_by_name() {
    let (_, problem, remedy) = crate::rig::parts(Mesh::imported(&file("tetrahedra.msh"), None));
    assert!(problem.contains("of type \"tetrahedron\""), "{problem}");
    assert!(remedy.contains("hexahedra"), "{remedy}");
}

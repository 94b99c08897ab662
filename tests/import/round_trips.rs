//! Meshes written and read back are the same to the last bit, and so is what they do.

use std::path::Path;

use hexroll::cpu::Precision;
use hexroll::model::Model;
use hexroll::model::mesh::Mesh;
use hexroll::model::shuffle::shuffled;
use hexroll::output::mesh::{Msh, write_inp, write_msh, write_vtu};
use hexroll::record::Sample;
use hexroll::scene::{Drive, MeshFile, MeshSpec, Scene};
use hexroll_lab::rig::{Outcome, block, explicit, simulate_with, wheel};
use tempfile::TempDir;

use crate::rig::metres;

type Write = fn(&mut Vec<u8>, &Mesh) -> std::io::Result<()>;

/// Every format that is written.
const FORMATS: [(&str, Write); 6] = [
    ("inp", |out, mesh| write_inp(out, mesh)),
    ("vtu", |out, mesh| write_vtu(out, mesh)),
    ("msh", |out, mesh| write_msh(out, mesh, Msh { old: false, binary: false })),
    ("msh", |out, mesh| write_msh(out, mesh, Msh { old: false, binary: true })),
    ("msh", |out, mesh| write_msh(out, mesh, Msh { old: true, binary: false })),
    ("msh", |out, mesh| write_msh(out, mesh, Msh { old: true, binary: true })),
];

fn written(folder: &Path, mesh: &Mesh, (ending, write): (&str, Write)) -> MeshFile {
    let mut bytes = Vec::new();
    write(&mut bytes, mesh).unwrap();
    let path = folder.join(format!("mesh.{ending}"));
    std::fs::write(&path, bytes).unwrap();
    // A generator knows its axle; a file's is said by the scene.
    MeshFile { axle: Some(mesh.axle), ..metres(&path) }
}

fn bits(nodes: &[[f64; 3]]) -> Vec<[u64; 3]> {
    nodes.iter().map(|x| x.map(f64::to_bits)).collect()
}

#[test]
fn a_mesh_comes_back_as_it_was() {
    let ring = wheel([12, 2, 3], 1.0).body.mesh;
    for spec in [ring, MeshSpec::Block { size: [0.1, 0.2, 0.3], elements: [2, 3, 4] }] {
        let mesh = Mesh::generate(&spec);
        for format in FORMATS {
            let folder = TempDir::new().unwrap();
            let back = Mesh::imported(&written(folder.path(), &mesh, format), None).unwrap();
            assert_eq!(bits(&back.nodes), bits(&mesh.nodes), "{}", format.0);
            assert_eq!(back.hexes, mesh.hexes);
            assert_eq!((&back.facets, &back.surface), (&mesh.facets, &mesh.surface));
            assert_eq!(back.axle.map(f64::to_bits), mesh.axle.map(f64::to_bits));
            for set in mesh.sets.iter() {
                assert_eq!(back.set(&set.name).unwrap(), set.nodes, "{} of {}", set.name, format.0);
            }
            assert_eq!(back.lattice(), mesh.lattice());
            assert!(back.notes.iter().all(|n| n.contains("type C3D8")), "{:?}", back.notes);
        }
    }
}

/// A set that no faces make up is a group of points, and comes back too.
#[test]
fn a_set_of_single_nodes_comes_back() {
    let mut mesh = Mesh::generate(&MeshSpec::Block { size: [1.0; 3], elements: [2, 2, 2] });
    mesh.sets.insert("some", "nodes 3, 13, 20", vec![3, 13, 20]);
    for format in FORMATS {
        let folder = TempDir::new().unwrap();
        let back = Mesh::imported(&written(folder.path(), &mesh, format), None).unwrap();
        assert_eq!(back.set("some").unwrap(), [3, 13, 20], "{}", format.0);
    }
}

fn pressed() -> Scene {
    let mut scene = wheel([12, 2, 3], 0.8);
    scene.output.sample = 2e-4;
    let mut stage = explicit("roll", 4e-4);
    stage.rim.z = Drive::Displacement { to: -2e-3, ramp: 4e-4 };
    stage.rim.spin = Drive::Velocity { to: 30.0, ramp: 0.0 };
    scene.stages.push(stage);
    scene
}

fn simulate(scene: &Scene, precision: Precision) -> Outcome {
    simulate_with(scene, Model::new(scene).unwrap(), precision, 1).unwrap()
}

/// Positions and forces of a run are those of the generated mesh, bit by bit.
#[test]
fn a_run_of_an_imported_mesh_has_the_same_bits() {
    let scene = pressed();
    let mesh = Mesh::generate(&scene.body.mesh);
    let expected = simulate(&scene, Precision::F32);
    assert!(expected.last().road_fz_N > 1.0, "the wheel is on the road");
    for format in FORMATS {
        let folder = TempDir::new().unwrap();
        let mut other = scene.clone();
        other.body.mesh = MeshSpec::File(written(folder.path(), &mesh, format));
        let run = simulate(&other, Precision::F32);
        assert_eq!(run.samples, expected.samples, "{}", format.0);
        assert_eq!(bits(&run.snapshots[0].x), bits(&expected.snapshots[0].x));
    }
    // A block in empty space that turns, in f64.
    let mut scene = block([0.04, 0.03, 0.02], [3, 2, 2]);
    scene.body.angular_velocity = [3.0, 200.0, 40.0];
    let expected = simulate(&scene, Precision::F64);
    let mesh = Mesh::generate(&scene.body.mesh);
    let folder = TempDir::new().unwrap();
    scene.body.mesh = MeshSpec::File(written(folder.path(), &mesh, FORMATS[0]));
    assert_eq!(simulate(&scene, Precision::F64).samples, expected.samples);
}

/// New numbers of nodes and elements change the order of sums, and so nothing but round-off.
#[test]
fn a_shuffled_import_gives_the_same_forces() {
    let scene = pressed();
    let model = Model::new(&scene).unwrap();
    let mut other = shuffled(&model, &scene.body).mesh;
    assert_ne!(other.nodes, model.mesh.nodes);
    other.sets = Default::default();
    other.sets.insert("inner", "rim", other.rim.clone());
    let folder = TempDir::new().unwrap();
    let mut imported = scene.clone();
    imported.body.mesh = MeshSpec::File(written(folder.path(), &other, FORMATS[0]));
    let [a, b] = [&scene, &imported].map(|s| simulate(s, Precision::F64));
    let (a, b) = (a.last(), b.last());
    // Some hundred steps of f64, whose errors do not grow: a share of 1e-16 each, of forces that cancel by a factor of ten.
    let force = |s: &Sample| [s.road_fx_N, s.road_fy_N, s.road_fz_N];
    let (a, b) = (force(a), force(b));
    let largest = a.iter().fold(0.0f64, |m, f| m.max(f.abs()));
    for d in 0..3 {
        let off = (a[d] - b[d]).abs() / largest;
        assert!(off < 1e-11, "component {d}: {off:e}");
    }
}

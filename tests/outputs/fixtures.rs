//! A small wheel, fields without symmetry, and runs made of them.

use std::path::{Path, PathBuf};

use hexroll::Error;
use hexroll::Precision;
use hexroll::model::mesh::Mesh;
use hexroll::output::RunWriter;
use hexroll::output::summary::{Summary, Versions};
use hexroll::record::{ContactNode, ContactState, Sample, Snapshot};
use hexroll::scene::MeshSpec;
use tempfile::TempDir;

/// A wheel away from the origin, so that no coordinate is special.
pub fn wheel() -> Mesh {
    let spec =
        MeshSpec::Ring { outer_radius: 0.04, inner_radius: 0.0175, width: 0.019, elements: [10, 3, 2] };
    let mesh = Mesh::generate(&spec).moved([0.3, -0.1, 0.002]);
    mesh.with_rim("inner").expect("a ring has an inner cylinder")
}

pub fn block() -> Mesh {
    Mesh::generate(&MeshSpec::Block { size: [1.0; 3], elements: [2, 1, 3] })
}

/// Numbers without a pattern that a permutation could keep: another one for every (field, index).
fn scramble(field: usize, i: usize) -> f64 {
    ((field * 7919 + i * 104_729) as f64 * 0.618_033_988_749_894_9).fract() - 0.4
}

/// A snapshot with other values everywhere; every third surface node is free and without force.
pub fn snapshot(mesh: &Mesh, time: f64) -> Snapshot {
    let vector = |field, i| std::array::from_fn(|d| scramble(field + d, i));
    let states = [ContactState::Free, ContactState::Stick, ContactState::Slip];
    let contact = |(i, &node): (usize, &u32)| ContactNode {
        node,
        force: if i % 3 == 0 { [0.0; 3] } else { vector(20, i) },
        area: scramble(30, i),
        pressure: scramble(31, i),
        slip_speed: scramble(32, i),
        friction_energy: scramble(33, i),
        state: states[i % 3],
    };
    let scalars = |field| (0..mesh.hexes.len()).map(|e| scramble(field, e)).collect();
    let nodes = || mesh.nodes.iter().enumerate();
    Snapshot {
        time,
        step: 12_345_678_901,
        force_time: 1e-3,
        x: nodes().map(|(i, X)| std::array::from_fn(|d| X[d] + 1e-3 * scramble(d, i))).collect(),
        v: nodes().map(|(i, _)| vector(10, i)).collect(),
        contact: mesh.surface.iter().enumerate().map(contact).collect(),
        volume_ratio: scalars(40),
        pressure: scalars(41),
        von_mises: scalars(42),
        axle: Some(([0.1, 0.2, 0.3], [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]])),
    }
}

/// A row with numbers that need all their digits.
pub fn sample(stage: &str, time_s: f64) -> Sample {
    Sample {
        time_s,
        stage: stage.into(),
        road_fx_N: 100.0 * time_s,
        road_fz_N: 300.0,
        kinetic_J: 1e-300,
        contact_nodes: 1.0 / 3.0,
        min_jacobian: 0.1 + 0.2,
        dt_s: f64::MIN_POSITIVE,
        ..Sample::default()
    }
}

/// A finished run of ten rows of 1 ms in two stages, a snapshot at the end of each, changed by `change`.
pub fn run(dir: &Path, mesh: &Mesh, change: impl Fn(&mut Sample, &mut Snapshot)) {
    let mut writer = RunWriter::create(dir, mesh, Some("title = 'a'\n")).unwrap();
    for row in 1..=10 {
        let stage = if row <= 4 { "press" } else { "roll" };
        let mut sample = sample(stage, 1e-3 * row as f64);
        let mut snapshot = snapshot(mesh, sample.time_s);
        change(&mut sample, &mut snapshot);
        writer.sample(&sample).unwrap();
        if row == 4 || row == 10 {
            writer.snapshot(&snapshot, stage).unwrap();
        }
    }
    writer.finish(&summary()).unwrap();
}

pub fn summary() -> Summary {
    Summary {
        engine: "cpu".into(),
        precision: Precision::F64,
        steps: 1000,
        dt_min_s: 1e-6,
        versions: Versions::current(),
        warnings: vec!["one \"warning\"".into()],
        ..Summary::default()
    }
}

/// A folder that does not exist yet; it goes with the first of the two.
pub fn folder() -> (TempDir, PathBuf) {
    let temp = TempDir::new().unwrap();
    let dir = temp.path().join("runs/a");
    (temp, dir)
}

/// The problem of a format error, which has to be about `path`.
pub fn problem<T>(result: hexroll::Result<T>, path: &Path) -> String {
    match result {
        Err(Error::Format { path: at, problem }) => {
            assert_eq!(at, path);
            problem
        }
        Err(other) => panic!("not a format error: {other}"),
        Ok(_) => panic!("no error"),
    }
}

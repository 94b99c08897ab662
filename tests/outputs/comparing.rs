//! Differences between two runs are found, where they are, and nowhere else.

use std::fs;
use std::path::{Path, PathBuf};

use hexroll::Precision;
use hexroll::model::mesh::Mesh;
use hexroll::output::RunWriter;
use hexroll::output::compare::{Comparison, compare};
use hexroll::output::summary::Summary;
use hexroll::record::Sample;
use hexroll::scene::MeshSpec;
use tempfile::TempDir;

use crate::fixtures::*;

fn two() -> (TempDir, [PathBuf; 2]) {
    let temp = TempDir::new().unwrap();
    let dirs = ["a", "b"].map(|name| temp.path().join(name));
    (temp, dirs)
}

/// A run of rows without snapshots that was killed.
fn rows(dir: &Path, rows: impl IntoIterator<Item = Sample>) {
    let mesh = wheel();
    let mut writer = RunWriter::create(dir, &mesh, None).unwrap();
    rows.into_iter().for_each(|row| writer.sample(&row).unwrap());
}

#[test]
fn a_run_with_itself_finds_nothing() {
    let (_temp, [a, b]) = two();
    run(&a, &wheel(), |_, _| ());
    run(&b, &wheel(), |_, _| ());
    let found = compare(&a, &b).unwrap();
    assert_eq!((found.notes.len(), found.settings.len()), (0, 0), "{found}");
    assert_eq!((found.history.matched, found.history.columns.len()), (10, 39));
    assert!(found.history.columns.iter().all(|c| c.max_difference == 0.0 && c.relative_l2 == Some(0.0)));
    assert_eq!(found.snapshots.len(), 2);
    assert!(found.snapshots.iter().all(|s| s.fields.len() == 8));
    let mut fields = found.snapshots.iter().flat_map(|s| &s.fields);
    assert!(fields.all(|e| e.max_difference == 0.0 && e.relative_l2 == Some(0.0)));
}

/// The reference, and a run with known changes.
fn reference_and_changed() -> Comparison {
    let (_temp, [a, b]) = two();
    let mesh = wheel();
    run(&a, &mesh, |_, _| ());
    run(&b, &mesh, |row, fields| {
        row.road_fz_N *= 1.01;
        row.rim_my_Nm = if row.stage == "roll" { 2.0 } else { 0.0 };
        fields.x[17][1] += 3e-3;
        fields.v.as_flattened_mut().iter_mut().for_each(|v| *v *= 0.5);
        fields.von_mises[5] += 7.0;
        fields.contact[4].force[0] += 9.0;
    });
    let changed = Summary { precision: Precision::F32, dt_min_s: 2e-6, wall_time_s: 5.0, ..summary() };
    fs::write(b.join("summary.json"), serde_json::to_vec(&changed).unwrap()).unwrap();
    compare(&a, &b).unwrap()
}

#[test]
fn known_differences_of_histories_are_found() {
    let found = reference_and_changed();
    let names: Vec<_> = found.settings.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["precision", "dt_min_s"]);
    let column = |name: &str| found.history.columns.iter().find(|c| c.name == name).unwrap();
    let fz = column("road_fz_N");
    // Round-off of 303 - 300, and of sums of ten squares.
    assert!((fz.max_difference - 3.0).abs() < 1e-12 && (fz.relative_l2.unwrap() - 0.01).abs() < 1e-14);
    assert!((fz.mean_a - 300.0).abs() < 1e-10 && (fz.mean_b - 303.0).abs() < 1e-10);
    let my = column("rim_my_Nm");
    assert_eq!((my.max_difference, my.relative_l2, my.mean_a), (2.0, None, 0.0));
    assert!((my.mean_b - 2.0).abs() < 1e-14);
    assert_eq!(found.history.means_of_stage.as_deref(), Some("roll"));
    assert_eq!(column("strain_J").max_difference, 0.0);
}

#[test]
fn known_differences_of_fields_are_found_where_they_are() {
    let found = reference_and_changed();
    assert_eq!(found.snapshots.len(), 2);
    for snapshot in &found.snapshots {
        let field = |name: &str| snapshot.fields.iter().find(|e| e.name == name).unwrap();
        let displacement = field("displacement");
        assert_eq!((displacement.worst, displacement.entity), (17, "node"));
        // Positions of 0.3 m carry a round-off of 6e-17 each.
        assert!((displacement.max_difference - 3e-3).abs() < 1e-15);
        assert_eq!(field("velocity").relative_l2, Some(0.5));
        let force = field("contact_force");
        assert_eq!(force.worst, wheel().surface[4] as usize);
        // 9 added to a number below 1, and taken off again.
        assert!((force.max_difference - 9.0).abs() < 1e-14);
        let stress = field("von_mises");
        assert_eq!((stress.worst, stress.entity), (5, "element"));
        assert_eq!(field("J").max_difference, 0.0);
    }
}

#[test]
fn a_comparison_prints_as_a_table_and_as_json() {
    let found = reference_and_changed();
    let table = found.to_string();
    for part in ["precision        f64 ", "road_fz_N", "element 5", "node 17", "displacement [m]"] {
        assert!(table.contains(part), "{part}\n{table}");
    }
    let json = serde_json::to_value(&found).unwrap();
    assert_eq!(json["snapshots"][1]["fields"][0]["worst"], 17);
    assert_eq!(json["settings"][0]["b"], "f32");
}

#[test]
fn stages_that_end_elsewhere_still_match_from_their_start() {
    let (_temp, [a, b]) = two();
    let mesh = wheel();
    run(&a, &mesh, |_, _| ());
    // B settled two windows earlier; from the start of each stage on, its force is A's.
    let mut writer = RunWriter::create(&b, &mesh, None).unwrap();
    for i in 1..=8 {
        let (stage, row_of_a) = if i <= 2 { ("press", i) } else { ("roll", i + 2) };
        let row = Sample { road_fx_N: 0.1 * f64::from(row_of_a), ..sample(stage, 1e-3 * f64::from(i)) };
        writer.sample(&row).unwrap();
    }
    writer.snapshot(&snapshot(&mesh, 8e-3), "roll").unwrap();
    drop(writer);
    let found = compare(&a, &b).unwrap();
    assert_eq!(found.history.matched, 8);
    // 100 x time against 0.1 x row: round-off of numbers below 1.
    assert!(found.history.columns[0].max_difference < 1e-14, "{found}");
    assert_eq!(found.snapshots.len(), 1);
    assert_eq!((found.snapshots[0].time_a, found.snapshots[0].time_b), (0.01, 0.008));
    let notes = found.notes.join("\n");
    for part in ["did not finish", "ends at 4.0", "10 rows and B 8", "2 snapshots and B 1"] {
        assert!(notes.contains(part), "{part}: {notes}");
    }
}

#[test]
fn other_windows_are_said() {
    let (_temp, [a, b]) = two();
    rows(&a, (1..=4).map(|i| sample("roll", 1e-3 * f64::from(i))));
    rows(&b, (1..=8).map(|i| sample("roll", 5e-4 * f64::from(i))));
    let found = compare(&a, &b).unwrap();
    assert_eq!((found.history.matched, found.history.columns[0].max_difference), (4, 0.0));
    let notes = found.notes.join("\n");
    assert!(notes.contains("windows differ in 4 of the matched rows"), "{notes}");
}

#[test]
fn a_run_without_rows_compares_to_nothing() {
    let (_temp, [a, b]) = two();
    rows(&a, []);
    run(&b, &wheel(), |_, _| ());
    for (a, b) in [(&a, &b), (&b, &a)] {
        let found = compare(a, b).unwrap();
        assert_eq!((found.history.matched, found.history.columns.len(), found.snapshots.len()), (0, 0, 0));
    }
}

#[test]
fn a_nan_is_never_the_smaller_error() {
    let (_temp, [a, b]) = two();
    run(&a, &wheel(), |_, _| ());
    run(&b, &wheel(), |row, fields| {
        row.strain_J = -f64::NAN;
        fields.v[3][2] = -f64::NAN;
        fields.v[9][0] = 1e30;
    });
    let found = compare(&a, &b).unwrap();
    let strain = found.history.columns.iter().find(|c| c.name == "strain_J").unwrap();
    assert!(strain.max_difference.is_nan() && strain.relative_l2.unwrap().is_nan());
    let velocity = &found.snapshots[0].fields[1];
    assert!(velocity.max_difference.is_nan());
    assert_eq!(velocity.worst, 3);
}

#[test]
fn other_meshes_are_an_error() {
    let (_temp, [a, b]) = two();
    run(&a, &wheel(), |_, _| ());
    let mut moved = wheel();
    moved.nodes[8][2] += 1e-6;
    run(&b, &moved, |_, _| ());
    let text = problem(compare(&a, &b), &b);
    assert!(text.contains("node 8 stands 1.000e-6 m elsewhere"), "{text}");
    let block = Mesh::generate(&MeshSpec::Block { size: [1.0; 3], elements: [2; 3] });
    run(&b, &block, |_, _| ());
    let text = problem(compare(&a, &b), &b);
    assert!(text.contains("(8, 27) elements and nodes"), "{text}");
}

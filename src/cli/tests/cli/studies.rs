//! `hexroll study` and `hexroll sweep`: runs that are kept, reports, what is refused.

use hexroll::output::read;

use super::program::{Place, shipped};

/// A block pressed on a road: a second or two on three meshes.
fn pressed(place: &Place, command: &[&str]) -> super::program::Done {
    let scene = shipped("pressed_block.toml");
    place.hexroll(
        &[
            &command[..1],
            &[&scene, "--engine", "cpu", "--set", "body.mesh.elements=[2, 2, 1]"],
            &command[1..],
        ]
        .concat(),
    )
}

#[test]
fn a_study_extrapolates_and_keeps_what_has_run() {
    let place = Place::new();
    let study = ["study", "--refine", "1,2,3", "--report", "report/mesh.md"];
    let done = pressed(&place, &study).expect(0);
    for part in ["[1/3]", "[3/3]", "done"] {
        assert!(done.stderr.contains(part), "{part:?} is missing in\n{}", done.stderr);
    }
    let text = std::fs::read_to_string(place.path("report/mesh.md")).unwrap();
    for part in ["2x2x1", "4x4x2", "6x6x3", "| Fz [N] |", "extrapolated", "mesh-pressed_block.png"] {
        assert!(text.contains(part), "{part:?} is missing in\n{text}");
    }
    assert!(done.stdout.contains(&text), "the report is printed");
    let picture = image::open(place.path("report/mesh-pressed_block.png")).unwrap();
    assert!(picture.width() > 500);

    // The table's numbers are the runs' own.
    let numbers = std::fs::read_to_string(place.path("report/mesh.csv")).unwrap();
    let row = numbers.lines().find(|l| l.starts_with("pressed_block,road_fz,N,")).unwrap();
    let cells: Vec<f64> = row.split(',').skip(3).take(3).map(|c| c.parse().unwrap()).collect();
    for (k, cell) in cells.iter().enumerate() {
        let dir = place.path(&format!("runs/study/pressed_block/refine_{}", k + 1));
        let summary = read::summary(&dir).unwrap().unwrap();
        assert!(summary.finished);
        // A number that has been through JSON may have lost its last digit.
        let mean = summary.stages.last().unwrap().mean_road_fz_N;
        assert!((mean - cell).abs() <= 1e-12 * cell.abs(), "{mean} {cell}");
    }

    // One run is lost; the same command makes that one only, and the same report but for the wall time.
    std::fs::remove_file(place.path("runs/study/pressed_block/refine_2/summary.json")).unwrap();
    let again = pressed(&place, &study).expect(0);
    let kept = |n: usize| again.stderr.contains(&format!("[{n}/3] pressed_block refine {n}: kept"));
    assert!(kept(1) && !kept(2) && kept(3), "{}", again.stderr);
    let forces = |text: &str| -> Vec<f64> {
        let row = text.lines().find(|l| l.starts_with("pressed_block,road_fz,N,")).unwrap();
        row.split(',').skip(3).filter_map(|cell| cell.parse().ok()).collect()
    };
    let (first, second) =
        (forces(&numbers), forces(&std::fs::read_to_string(place.path("report/mesh.csv")).unwrap()));
    assert_eq!(first.len(), second.len());
    // A number that has been through JSON may have lost its last digit.
    assert!(first.iter().zip(&second).all(|(a, b)| (a - b).abs() <= 1e-12 * a.abs()), "{first:?} {second:?}");
    // Another scene is another run.
    let other = pressed(&place, &[&study[..], &["--set", "friction.coefficient=0.3"]].concat()).expect(0);
    assert!(!other.stderr.contains("kept"), "{}", other.stderr);
}

#[test]
fn a_study_over_precisions_and_steps_needs_no_other_mesh() {
    let place = Place::new();
    pressed(&place, &["study", "--over", "precision=f64,f32"]).expect(0);
    let text = std::fs::read_to_string(place.path("runs/study/study.md")).unwrap();
    assert!(
        text.contains("cpu f64") && text.contains("cpu f32") && text.contains("largest difference"),
        "{text}"
    );
    pressed(&place, &["study", "--over", "dt-safety=0.9,0.45,0.225", "--report", "dt.md"]).expect(0);
    let text = std::fs::read_to_string(place.path("dt.md")).unwrap();
    assert!(text.contains("| dt safety | elements |") && text.contains("| 0.225 |"), "{text}");
}

#[test]
fn a_sweep_runs_every_combination_side_by_side() {
    let place = Place::new();
    place.scene("block.toml", |text| text);
    let over = ["--over", "friction.coefficient=0.2,0.4", "--over", "dt-safety=0.8,0.9"];
    let command = [&["sweep", "block.toml", "--engine", "cpu", "--jobs", "2"], &over[..]].concat();
    place.hexroll(&command).expect(0);
    let folder = place.path("runs/sweep/block");
    for mu in ["0.2", "0.4"] {
        for safety in ["0.8", "0.9"] {
            let run = folder.join(format!("friction.coefficient_{mu}_dt-safety_{safety}"));
            let text = read::scene_text(&run).unwrap().unwrap();
            assert!(
                text.contains(&format!("coefficient = {mu}")) && text.contains(&format!("safety = {safety}")),
                "{text}"
            );
        }
    }
    let numbers = std::fs::read_to_string(folder.join("sweep.csv")).unwrap();
    assert_eq!(numbers.lines().count(), 5, "{numbers}");
    assert!(folder.join("sweep.png").exists() && folder.join("sweep.md").exists());
    let again = place.hexroll(&command).expect(0);
    assert_eq!(again.stderr.matches("kept").count(), 4, "{}", again.stderr);
}

#[test]
fn one_failing_run_does_not_keep_the_others_from_running() {
    let place = Place::new();
    let scene = shipped("bouncing_block.toml");
    // The critical step exceeded by half.
    let over = ["--over", "dt-safety=1.5,0.9", "--jobs", "1"];
    let done = place.hexroll(&[&["sweep", &scene, "--engine", "cpu"], &over[..]].concat()).expect(5);
    assert!(done.stderr.contains("[1/2] dt-safety 1.5: failed"), "{}", done.stderr);
    assert!(done.stderr.contains("[2/2] dt-safety 0.9: done"), "{}", done.stderr);
}

#[test]
fn what_a_scene_does_not_have_cannot_be_varied() {
    let place = Place::new();
    place.scene("block.toml", |text| text);
    for (over, part) in [
        ("slip-angle=-5:5:3", "no stage moves its rim"),
        ("load=100,200", "no stage has a rim that is free"),
        ("deflection=1,2", "no stage displaces its rim"),
        ("slip=0,0.1", "no stage has a longitudinal slip"),
        ("refine=1.5", "not a whole number"),
        ("precision=f16", "no such precision"),
        ("no.such.key=1,2", "unknown key"),
        ("load", "no `=`"),
    ] {
        let done = place.hexroll(&["sweep", "block.toml", "--over", over]).expect(2);
        assert!(done.stderr.contains(part), "{over}: {}", done.stderr);
    }
    let both = ["study", "block.toml", "--refine", "1,2", "--over", "precision=f64,f32"];
    place.hexroll(&both).expect(2);
    place.hexroll(&["study", "block.toml"]).expect(2);
}

//! `hexroll run` on the CPU engine: files, table, overrides.

use hexroll::Precision;
use hexroll::output::read;

use super::program::{Done, Place, shipped};

fn run(place: &Place, more: &[&str]) -> Done {
    place.scene("block.toml", |text| text);
    place.hexroll(&[&["run", "block.toml", "--engine", "cpu"], more].concat())
}

#[test]
fn a_run_leaves_every_file_readable_and_says_where() {
    let place = Place::new();
    let done = run(&place, &[]).expect(0);
    let dir = place.path("runs/block");
    let history = read::history(&dir).unwrap();
    let ends: Vec<(String, usize)> = ["land", "slide"]
        .map(|stage| (stage.into(), history.iter().filter(|s| s.stage == stage).count()))
        .into();
    assert_eq!(ends, [("land".into(), 6), ("slide".into(), 4)]);
    // It has landed, and the road carries it.
    assert!(history.iter().any(|s| s.road_fz_N > 1.0));

    let snapshots = read::snapshots(&dir).unwrap();
    assert_eq!(snapshots.len(), 2, "one at the end of every stage");
    let last = read::snapshot(&snapshots[1].path).unwrap();
    assert_eq!((last.stage.as_str(), last.mesh.hexes.len()), ("slide", 8));
    assert!(read::scene_text(&dir).unwrap().unwrap().contains("A block falls"));

    let summary = read::summary(&dir).unwrap().unwrap();
    assert_eq!((summary.engine.as_str(), summary.precision), ("cpu", Precision::F64));
    assert_eq!(summary.steps, last.snapshot.step);
    assert!((summary.time_s - 1e-3).abs() < 1e-15, "{}", summary.time_s);
    assert!(summary.dt_min_s > 0.0 && summary.dt_min_s <= summary.dt_max_s);
    assert!(
        summary.dt_max_s <= 0.9 * summary.critical_dt_s * 1.01,
        "the default safety, dt follows the body"
    );
    // Round-off of some hundred steps, far below any force that were not booked.
    assert!(summary.balance.share_of_largest_term < 1e-12, "{:?}", summary.balance);
    // One unit in the last place of the block's size.
    assert!(summary.worst_penetration_m.unwrap() < 1e-17);
    assert_eq!(summary.stages.len(), 2);
    assert_eq!(summary.warnings, Vec::<String>::new());

    for part in ["A block falls", "cpu f64", "--engine cpu", "8 elements", "land", "slide", "runs/block"] {
        assert!(done.stdout.contains(part), "{part:?} is missing in\n{}", done.stdout);
    }
    assert!(!done.stdout.contains("ETA") && done.stderr.contains("ETA"), "progress goes to stderr");
    assert!(!done.stderr.contains('\u{1b}'), "no terminal codes where there is no terminal");
}

#[test]
fn progress_without_a_terminal_is_a_dozen_lines_or_fewer() {
    let place = Place::new();
    let done = run(&place, &[]).expect(0);
    let lines: Vec<&str> = done.stderr.lines().filter(|l| l.contains('%')).collect();
    assert!((2..=12).contains(&lines.len()), "{lines:?}");
    assert!(lines.last().unwrap().trim_start().starts_with("100 %"), "{lines:?}");
}

#[test]
fn set_changes_the_scene_and_out_the_folder() {
    let place = Place::new();
    let set = ["--set", "stage.1.duration=0.2 ms", "--set", "body.mesh.elements=[2, 3, 1]", "--out", "here"];
    run(&place, &set).expect(0);
    let summary = read::summary(&place.path("here")).unwrap().unwrap();
    assert_eq!((summary.elements, summary.nodes), (6, 3 * 4 * 2));
    assert_eq!(read::history(&place.path("here")).unwrap().len(), 8);
    assert!(!place.path("runs").exists());
    assert!(read::scene_text(&place.path("here")).unwrap().unwrap().contains("0.2 ms"));
}

#[test]
fn single_precision_and_threads_are_what_was_asked_for() {
    let place = Place::new();
    run(&place, &["--precision", "f32", "--threads", "1", "--out", "single"]).expect(0);
    let summary = read::summary(&place.path("single")).unwrap().unwrap();
    assert_eq!((summary.precision, summary.threads), (Precision::F32, 1));
    // Round-off of single precision, not of double.
    assert!(summary.balance.share_of_largest_term > 1e-14, "{:?}", summary.balance);
}

#[test]
fn a_run_replaces_the_run_that_was_there_and_nothing_else() {
    let place = Place::new();
    run(&place, &["--out", "out"]).expect(0);
    run(&place, &["--out", "out", "--set", "output.snapshots=none"]).expect(0);
    assert!(!place.path("out/snapshot_0.vtu").exists(), "an old snapshot is left");
    std::fs::create_dir(place.path("mine")).unwrap();
    std::fs::write(place.path("mine/letter.txt"), "dear").unwrap();
    let done = run(&place, &["--out", "mine"]).expect(6);
    assert!(done.stderr.contains("no run wrote"), "{}", done.stderr);
}

#[test]
fn the_shipped_pressed_block_runs_in_seconds() {
    let place = Place::new();
    place
        .hexroll(&["run", &shipped("pressed_block.toml"), "--engine", "cpu", "--set", "output.pictures=[]"])
        .expect(0);
    let summary = read::summary(&place.path("runs/pressed_block")).unwrap().unwrap();
    let press = &summary.stages[0];
    // At rest the plate presses what the road carries; the means span the end of the settling: 1 %.
    assert!((press.mean_road_fz_N / -press.mean_rim_fz_N - 1.0).abs() < 0.01, "{press:?}");
}

/// A cantilever one element thick, which bends in hourglass modes.
const BENT: &str = r#"title = "bent"
gravity = ["0 m/s2", "0 m/s2", "-9.81 m/s2"]
[body]
density = "1100 kg/m3"
element = "uniform-gradient"
[body.mesh]
generator = "block"
size = ["100 mm", "20 mm", "20 mm"]
elements = [10, 1, 1]
[body.material]
shear_modulus = "2.64 MPa"
bulk_modulus = "65.1 MPa"
[rim]
nodes = "x-min"
[[stage]]
method = "explicit"
duration = "20 ms"
[output]
sample = "1 ms"
"#;

/// Alone and among others, finished or ended by the limit: the warning is there, with what helps.
#[test]
fn hourglass_energy_is_named() {
    let place = Place::new();
    std::fs::write(place.path("bent.toml"), BENT).unwrap();
    let named = |text: &str| {
        text.contains("warning: hourglass energy comes to") || text.contains(": warning: hourglass energy")
    };
    let done = place.hexroll(&["run", "bent.toml", "--engine", "cpu"]).expect(0);
    assert!(named(&done.stdout) && done.stdout.contains("element = \"q1p0\""), "{}", done.stdout);
    let summary = read::summary(&place.path("runs/bent")).unwrap().unwrap();
    let share = summary.hourglass.unwrap();
    let history = read::history(&place.path("runs/bent")).unwrap();
    let row = history.iter().find(|s| s.time_s == share.time_s).unwrap();
    assert_eq!(row.hourglass_J / row.strain_J, share.of_strain_energy);

    let over = ["--over", "body.hourglass=0.1,0.2", "--jobs", "1"];
    let done = place.hexroll(&[&["sweep", "bent.toml", "--engine", "cpu"], &over[..]].concat()).expect(0);
    assert_eq!(done.stderr.lines().filter(|l| named(l)).count(), 2, "{}", done.stderr);

    let set = "body.hourglass_limit=0.5";
    let done = place.hexroll(&["run", "bent.toml", "--engine", "cpu", "--set", set]).expect(5);
    assert!(done.stderr.contains("body.hourglass_limit = 0.5"), "{}", done.stderr);
    let kept = read::history(&place.path("runs/bent")).unwrap();
    let summary = read::summary(&place.path("runs/bent")).unwrap().unwrap();
    assert!(!kept.is_empty() && kept.len() < history.len() && !summary.finished);
    assert_eq!(summary.hourglass.unwrap().time_s, kept.last().unwrap().time_s);

    let element = "body.element=q1p0";
    let done = place.hexroll(&["run", "bent.toml", "--engine", "cpu", "--set", element]).expect(0);
    assert!(!named(&done.stdout), "{}", done.stdout);
}

//! What the summary says about a run.

use std::fs;

use hexroll::output::summary::{StageMeans, Summary, WorstBalance};
use hexroll::output::{RunWriter, read, stages};
use hexroll::record::Sample;

use crate::fixtures::{folder, run, sample, summary, wheel};

#[test]
fn a_summary_comes_back_even_with_numbers_json_lacks() {
    let (_temp, dir) = folder();
    let mesh = wheel();
    run(&dir, &mesh, |_, _| ());
    assert_eq!(read::summary(&dir).unwrap(), Some(summary()));
    let odd = Summary { dt_min_s: f64::INFINITY, worst_penetration_m: Some(1e-18), ..summary() };
    RunWriter::create(&dir, &mesh, None).unwrap().finish(&odd).unwrap();
    let back = read::summary(&dir).unwrap().unwrap();
    assert!(back.dt_min_s.is_nan());
    assert_eq!(back.worst_penetration_m, Some(1e-18));
    let lock = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.lock")).unwrap();
    let wgpu = format!("name = \"wgpu\"\nversion = \"{}\"\n", back.versions.wgpu);
    assert!(lock.contains(&wgpu), "{wgpu}");
}

#[test]
fn means_are_over_the_last_30_percent_of_each_stage() {
    // press: 0 to 10 s, windows of 4, 4 and 2 s; its last 3 s are 1 s of the second and all of the third.
    let rows = [("press", 4.0, 100.0), ("press", 8.0, 10.0), ("press", 10.0, 40.0), ("roll", 11.0, 7.0)];
    let history =
        rows.map(|(stage, time, fz)| Sample { road_fz_N: fz, rim_my_Nm: -2.0 * fz, ..sample(stage, time) });
    let means = StageMeans::of(&history, &[]);
    assert_eq!(means.iter().map(|m| m.stage.as_str()).collect::<Vec<_>>(), ["press", "roll"]);
    assert_eq!((means[0].start_s, means[0].end_s, means[0].means_from_s), (0.0, 10.0, 7.0));
    assert_eq!((means[1].start_s, means[1].end_s), (10.0, 11.0));
    // (10 * 1 + 40 * 2) / 3, every number exact.
    assert_eq!((means[0].mean_road_fz_N, means[0].mean_rim_my_Nm), (30.0, -60.0));
    // 0.3 * 7 / 0.3: a few units in the last place.
    assert!((means[1].mean_road_fz_N - 7.0).abs() < 1e-14);
    assert!(stages::mean(&history, &(11.5..12.0), |s| s.road_fz_N).is_nan());
}

#[test]
fn the_worst_balance_relates_to_the_largest_term() {
    let mut rows = [sample("a", 1.0), sample("a", 2.0), sample("a", 3.0)];
    rows[0].balance_error_J = -2.0;
    rows[1].balance_error_J = 1.0;
    rows[1].friction_work_J = -8.0;
    rows[2].strain_J = 4.0;
    let worst = WorstBalance::of(&rows);
    assert_eq!((worst.worst_error_J, worst.share_of_largest_term), (2.0, 0.25));
    assert_eq!(WorstBalance::of_stored(&rows), WorstBalance::default());
    rows[1].stored_balance_error_J = f64::NAN;
    assert!(WorstBalance::of_stored(&rows).worst_error_J.is_nan());
}

//! `hexroll report run|study|sweep` and `hexroll plot`: pages of what folders hold.

use super::program::{Place, shipped};

/// The text of a page, which must ask for nothing outside it.
fn page(place: &Place, name: &str) -> String {
    let text = std::fs::read_to_string(place.path(name)).unwrap();
    assert!(text.starts_with("<!DOCTYPE html>") && text.ends_with("</html>\n"));
    for outside in ["http://", "https://", "<script", "<link", "@import", "url("] {
        assert!(!text.contains(outside), "{name} has {outside}");
    }
    text
}

#[track_caller]
fn has(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "{part:?} is missing in\n{text}");
    }
}

#[test]
fn a_page_tells_a_run_whole_and_half_written() {
    let place = Place::new();
    place.scene("block.toml", |s| s);
    place.hexroll(&["run", "block.toml", "--engine", "cpu", "--threads", "1"]).expect(0);
    let done = place.hexroll(&["report", "run", "runs/block"]).expect(0);
    assert!(done.stdout.starts_with("runs/block/report.html"), "{}", done.stdout);
    let text = page(&place, "runs/block/report.html");
    has(
        &text,
        &["A block falls", ">finished<", "2 x 2 x 2", "mooney-rivlin", "Kelvin-Voigt, 2 Pa s", "mu = 0.5"],
    );
    has(
        &text,
        &["Road on the body", "Stored energies", "Works on the body", "by work done", "by stored energy"],
    );
    has(
        &text,
        &["--engine cpu --precision f64 --threads 1", "<summary>scene.toml</summary>", "shear_modulus ="],
    );
    // The last row of the history is told to a pointer, as it stands in the file.
    let history = std::fs::read_to_string(place.path("runs/block/history.csv")).unwrap();
    let column = history.lines().next().unwrap().split(',').position(|c| c == "strain_J").unwrap();
    let strain: f64 = history.lines().last().unwrap().split(',').nth(column).unwrap().parse().unwrap();
    has(&text, &[&format!("strain: {strain:.4e}")]);

    // Killed: the summary is missing and a row is cut off.
    std::fs::remove_file(place.path("runs/block/summary.json")).unwrap();
    std::fs::write(place.path("runs/block/history.csv"), &history[..history.len() - 40]).unwrap();
    place.hexroll(&["report", "run", "runs/block", "--out", "half.html"]).expect(0);
    let text = page(&place, "half.html");
    has(
        &text,
        &["half-written", "900 us of at most 1.00 ms", "There is no summary.json", "Road on the body"],
    );
    assert!(!text.contains(">finished<"));
    // Killed before the first window.
    std::fs::write(place.path("runs/block/history.csv"), format!("{}\n", history.lines().next().unwrap()))
        .unwrap();
    place.hexroll(&["report", "run", "runs/block", "--out", "half.html"]).expect(0);
    has(&page(&place, "half.html"), &["No window has ended yet"]);
    // A rerun replaces the run, and its page with it.
    place.hexroll(&["run", "block.toml", "--engine", "cpu"]).expect(0);
    assert!(!place.path("runs/block/report.html").exists());
}

#[test]
fn what_is_no_run_has_no_page() {
    let place = Place::new();
    std::fs::create_dir(place.path("empty")).unwrap();
    for (kind, dir, message) in [
        ("run", "empty", "holds no run"),
        ("run", "nowhere", "no such folder"),
        ("study", "empty", "has no study.json"),
        ("sweep", "empty", "has no sweep.json"),
    ] {
        let done = place.hexroll(&["report", kind, dir]).expect(6);
        assert!(done.stderr.contains(message), "{}", done.stderr);
    }
}

#[test]
fn pages_of_a_study_and_a_sweep_name_what_is_missing() {
    let place = Place::new();
    let scene = shipped("pressed_block.toml");
    let small =
        ["--engine", "cpu", "--set", "body.mesh.elements=[2, 2, 1]", "--set", "output.snapshots=none"];
    place.hexroll(&[&["study", &scene, "--refine", "1,2"], &small[..]].concat()).expect(0);
    place.hexroll(&["report", "study", "runs/study"]).expect(0);
    let text = page(&place, "runs/study/report.html");
    has(
        &text,
        &[
            "Mesh study: pressed_block",
            "all 2 runs have finished",
            ">2x2x1<",
            ">4x4x2<",
            "<svg",
            "--refine 1,2",
        ],
    );

    let over = ["--over", "friction.coefficient=0.2,0.4", "--out", "curve"];
    place.hexroll(&[&["sweep", &scene], &over[..], &small[..]].concat()).expect(0);
    std::fs::remove_file(place.path("curve/friction.coefficient_0.4/summary.json")).unwrap();
    place.hexroll(&["report", "sweep", "curve"]).expect(0);
    let text = page(&place, "curve/report.html");
    has(
        &text,
        &[
            "1 of 2 runs have finished",
            "friction.coefficient_0.4 has not finished",
            "<td class=\"number\">0.2</td>",
        ],
    );
}

#[test]
fn curves_of_several_runs_share_a_plot() {
    let place = Place::new();
    place.scene("block.toml", |s| s);
    for (out, mu) in [("a", "0.5"), ("b", "0.1")] {
        let set = format!("friction.coefficient={mu}");
        place.hexroll(&["run", "block.toml", "--engine", "cpu", "--set", &set, "--out", out]).expect(0);
    }
    place.hexroll(&["plot", "a", "b", "--column", "road_fx_N", "--column", "kinetic_J"]).expect(0);
    let picture = image::open(place.path("plot.png")).unwrap();
    assert_eq!(picture.width(), 2 * 620);
    place.hexroll(&["plot", "a", "b", "--from", "0.0005", "--out", "plot.html"]).expect(0);
    let text = page(&place, "plot.html");
    has(&text, &[">a<", ">b<", "time_s: 5.0000e-4"]);
    assert!(!text.contains("time_s: 4.0000e-4"), "windows before --from are left out");
    for (arguments, message) in [
        (["plot", "a", "--column", "road_fq"], "no column \"road_fq\""),
        (["plot", "a", "--out", "plot.pdf"], "neither .png nor .html"),
    ] {
        let done = place.hexroll(&arguments).expect(2);
        assert!(done.stderr.contains(message), "{}", done.stderr);
    }
}

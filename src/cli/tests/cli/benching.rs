//! `hexroll bench` from end to end on the smallest mesh, and mistakes in its arguments.

use super::program::Place;

#[test]
fn a_bench_writes_its_record() {
    let place = Place::new();
    let done = place
        .hexroll(&[
            "bench",
            "--engines",
            "cpu-f64,cpu-f32",
            "--elements",
            "uniform-gradient",
            "--sizes",
            "880",
            "--seconds",
            "0.05",
            "--threads",
            "1,2",
            "--json",
            "speed.json",
            "--out",
            "records",
        ])
        .expect(0);
    assert!(done.stdout.contains("updates/s") && done.stdout.contains("cpu-f32"), "{}", done.stdout);
    let text = std::fs::read_to_string(place.path("speed.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&text).unwrap();
    let rows = report["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 4);
    for row in rows {
        let number = |key: &str| row[key].as_f64().unwrap();
        assert_eq!(row["elements"], 880);
        let rate = 880.0 * 1e6 / row["us_per_step"]["median"].as_f64().unwrap();
        assert!((number("updates_per_s") / rate - 1.0).abs() < 1e-9);
        assert!(number("error") <= number("error_limit"), "{row}");
        let fraction = number("floor_us") / row["us_per_step"]["median"].as_f64().unwrap();
        assert!((number("fraction") / fraction - 1.0).abs() < 1e-9);
        assert_eq!(row["reason"].is_null(), fraction >= 0.5, "{row}");
    }
    // Threads and lanes differ in rounding at most; f32 does not.
    assert!(rows[0]["error"].as_f64().unwrap() < 1e-8);
    let folder = std::fs::read_dir(place.path("records")).unwrap().next().unwrap().unwrap().path();
    assert!(folder.file_name().unwrap().to_str().unwrap().ends_with("-cpu"), "{folder:?}");
    for file in ["bench.json", "bench.md", "scaling.png"] {
        assert!(folder.join(file).exists(), "{file}");
    }
}

#[test]
fn a_size_that_does_not_fit_is_skipped_with_the_reason() {
    let place = Place::new();
    // 880 * 40^3 elements need 90 GB a copy, and there are a thousand copies.
    let done = place
        .hexroll(&[
            "bench",
            "--engines",
            "cpu-f64",
            "--elements",
            "q1p0",
            "--sizes",
            "56320000",
            "--copies",
            "1000",
        ])
        .expect(0);
    assert!(done.stdout.is_empty() || !done.stdout.contains("| cpu-f64"), "{}", done.stdout);
    assert!(done.stdout.contains("skipped") && done.stdout.contains("GiB"), "{}", done.stdout);
}

#[test]
fn mistakes_name_what_would_be_right() {
    let place = Place::new();
    for (arguments, right) in [
        (&["--sizes", "1000"][..], "880 n^3"),
        (&["--engines", "cpu-f16"], "cpu-f64"),
        (&["--elements", "hex20"], "uniform-gradient"),
        (&["--viscosity", "-3"], "negative"),
        (&["--viscosity", "honey"], "Pa s"),
        (&["--seconds", "0"], "between"),
        (&["--lanes", "sse9"], "avx512"),
        (&["--contact", "maybe"], "both"),
        (&["--parts", "everything"], "straight"),
        (&["--copies", "0"], "1"),
    ] {
        let done = place.hexroll(&[&["bench"][..], arguments].concat()).expect(2);
        assert!(done.stderr.contains(right), "{right:?} is missing in\n{}", done.stderr);
        assert_eq!(done.stdout, "");
    }
    let done = place.hexroll(&["bench", "--engines", "gpu-f32", "--adapter", "no such adapter"]).expect(4);
    assert!(done.stderr.contains("no GPU adapter found"), "{}", done.stderr);
}

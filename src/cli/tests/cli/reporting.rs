//! `hexroll report`: pages of claims.

use super::program::Place;

#[test]
fn a_page_names_its_source_its_claims_and_its_machine() {
    let place = Place::new();
    let done = place.hexroll(&["report", "verification", "--only", "constitutive"]).expect(0);
    for part in
        ["# Verification", "Made by `hexroll report verification`", "Source: ", "| claim |", "| yes |"]
    {
        assert!(done.stdout.contains(part), "{part:?} is not in {}", done.stdout);
    }
    assert!(!place.path("docs").exists(), "a part of the cases does not replace the page of all");
    place.hexroll(&["report", "verification", "--only", "constitutive", "--out", "page/claims.md"]).expect(0);
    assert!(std::fs::read_to_string(place.path("page/claims.md")).unwrap().contains("incompressible"));
}

#[test]
fn a_hard_case_names_its_limit_and_what_ends_it() {
    let done = Place::new().hexroll(&["report", "stability", "--only", "corner"]).expect(0);
    let row = done.stdout.lines().find(|l| l.contains("corner first")).expect("its row");
    assert!(row.contains("inverted at step") && row.contains("| yes |"), "{row}");
}

#[test]
fn an_unknown_case_is_answered_with_the_known_ones() {
    for kind in ["verification", "stability", "accuracy"] {
        let done = Place::new().hexroll(&["report", kind, "--only", "nothing"]).expect(2);
        assert!(done.stderr.contains("\"nothing\"") && done.stderr.contains("known"), "{}", done.stderr);
    }
}

#[test]
fn a_measurement_keeps_its_rows_until_it_has_ended() {
    let place = Place::new();
    let arguments = ["report", "accuracy", "--only", "wave", "--finest", "1", "--split", "0", "--out", "out"];
    place.hexroll(&arguments).expect(0);
    let table = std::fs::read_to_string(place.path("out/accuracy.csv")).unwrap();
    assert_eq!(table.lines().filter(|l| l.starts_with("wave,")).count(), 6, "{table}");
    assert!(!place.path("out/accuracy.partial.csv").exists(), "all rows are in accuracy.csv");
    // Where rows cannot be kept the measurement ends at the first of them.
    std::fs::create_dir_all(place.path("full/accuracy.partial.csv")).unwrap();
    let done = place.hexroll(&["report", "accuracy", "--only", "wave", "--finest", "1", "--out", "full"]);
    let done = done.expect(6);
    assert!(done.stderr.contains("accuracy.partial.csv"), "{}", done.stderr);
    assert!(!place.path("full/accuracy.csv").exists());
}

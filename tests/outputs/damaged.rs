//! Files that this program did not write like that: errors with the path and what is wrong.

use std::fs;
use std::path::Path;

use hexroll::Error;
use hexroll::output::{RunWriter, read};

use crate::fixtures::*;

#[test]
fn a_truncated_snapshot_is_an_error_wherever_it_is_cut() {
    let (_temp, dir) = folder();
    let mesh = wheel();
    RunWriter::create(&dir, &mesh, None).unwrap().snapshot(&snapshot(&mesh, 0.0), "roll").unwrap();
    let path = dir.join("snapshot_0.vtu");
    let whole = fs::read(&path).unwrap();
    // The last byte is a line end, which nothing needs.
    for end in (0..whole.len() - 1).step_by(997).chain([whole.len() - 2]) {
        fs::write(&path, &whole[..end]).unwrap();
        let text = problem(read::snapshot(&path), &path);
        assert!(text.contains("not a complete XML file"), "cut at {end}: {text}");
    }
}

#[test]
fn a_damaged_snapshot_is_an_error_that_names_the_damage() {
    let (_temp, dir) = folder();
    let mesh = wheel();
    RunWriter::create(&dir, &mesh, None).unwrap().snapshot(&snapshot(&mesh, 0.0), "roll").unwrap();
    let path = dir.join("snapshot_0.vtu");
    let whole = fs::read_to_string(&path).unwrap();
    let points = format!("NumberOfPoints=\"{}\"", mesh.nodes.len());
    let end = whole.rfind("\n  </AppendedData>").unwrap();
    let cases = [
        ("type=\"UnstructuredGrid\"", "type=\"PolyData\"", "UnstructuredGrid is expected"),
        ("\"LittleEndian\"", "\"MiddleEndian\"", "byte_order"),
        ("Name=\"velocity\"", "Name=\"speed\"", "\"velocity\": there is none"),
        ("type=\"Float64\" Name=\"J\"", "type=\"Float32\" Name=\"J\"", "1 x Float32; 1 x Float64"),
        (&points, "NumberOfPoints=\"7\"", "do not make the tuples"),
        (&points, "NumberOfPoints=\"many\"", "not a whole number"),
        // The end of the last array, taken out of a file that is still XML.
        (&whole[end - 40..end], "", "\"von_mises\": its data is cut off"),
        ("encoding=\"base64\">\n_", "encoding=\"base64\">\n_%%%%", "cut off or damaged"),
    ];
    for (from, to, expected) in cases {
        assert!(whole.contains(from), "{from}");
        fs::write(&path, whole.replacen(from, to, 1)).unwrap();
        let text = problem(read::snapshot(&path), &path);
        assert!(text.contains(expected), "{from} -> {to}: {text}");
    }
    fs::write(&path, [0xff, 0xfe]).unwrap();
    assert_eq!(problem(read::snapshot(&path), &path), "not a text file");
}

#[test]
fn a_snapshot_with_impossible_nodes_is_an_error() {
    let (_temp, dir) = folder();
    let mut mesh = wheel();
    mesh.hexes[7][3] = 123_456;
    RunWriter::create(&dir, &mesh, None).unwrap().snapshot(&snapshot(&mesh, 0.0), "roll").unwrap();
    let path = dir.join("snapshot_0.vtu");
    let text = problem(read::snapshot(&path), &path);
    assert!(text.contains("node 123456"), "{text}");
}

/// Replaces text in a file, calls `check`, and puts the file back.
fn damaged(path: &Path, from: &str, to: &str, check: impl FnOnce()) {
    let whole = fs::read_to_string(path).unwrap();
    assert!(whole.contains(from), "{from:?} is not in\n{whole}");
    fs::write(path, whole.replacen(from, to, 1)).unwrap();
    check();
    fs::write(path, whole).unwrap();
}

#[test]
fn a_bad_history_is_an_error_with_the_line_or_the_column() {
    let (_temp, dir) = folder();
    run(&dir, &wheel(), |_, _| ());
    let path = dir.join("history.csv");
    for (from, to, expected) in [
        ("rim_fx_N,", "", "column 9 is \"rim_fy_N\"; \"rim_fx_N\" is expected"),
        (",dissipation_J", ",dissipation_J,more", "column 42 is \"more\"; no further column"),
        ("\n0.002,press,0.2", "\n0.002,press,zero", "line: 3"),
        ("\n0.002,press,0.2", "\n0.002,press", "line: 3"),
        ("time_s", "\u{1}", "column 1"),
    ] {
        damaged(&path, from, to, || {
            let text = problem(read::history(&dir), &path);
            assert!(text.contains(expected), "{text}");
        });
    }
    fs::write(&path, "").unwrap();
    assert!(problem(read::history(&dir), &path).contains("column 1 is missing"));
    assert!(matches!(read::history(&dir.join("nowhere")), Err(Error::Io { .. })));
}

#[test]
fn bad_collections_and_summaries_are_errors() {
    let (_temp, dir) = folder();
    run(&dir, &wheel(), |_, _| ());
    let (pvd, summary) = (dir.join("run.pvd"), dir.join("summary.json"));
    damaged(&pvd, "timestep=\"", "time=\"", || {
        assert!(problem(read::snapshots(&dir), &pvd).starts_with("line 4: "));
    });
    damaged(&pvd, "</VTKFile>", "", || {
        assert!(problem(read::snapshots(&dir), &pvd).contains("not a complete XML file"));
    });
    damaged(&summary, "\"steps\": 1000", "\"steps\": \"many\"", || {
        assert!(problem(read::summary(&dir), &summary).contains("not a run's summary"));
    });
}

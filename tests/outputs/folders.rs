//! Who may write to a folder, and what a killed run leaves there.

use std::fs;

use hexroll::output::folder::write_whole;
use hexroll::output::{RunWriter, read};

use crate::fixtures::*;

#[test]
fn a_killed_run_reads_up_to_the_kill() {
    let (_temp, dir) = folder();
    let mesh = wheel();
    let mut writer = RunWriter::create(&dir, &mesh, None).unwrap();
    let rows: Vec<_> = (1..=3).map(|i| sample("roll", 1e-3 * f64::from(i))).collect();
    rows.iter().for_each(|row| writer.sample(row).unwrap());
    writer.snapshot(&snapshot(&mesh, 2e-3), "roll").unwrap();
    // No destructor runs in a killed process; the file it was writing stays behind, incomplete.
    std::mem::forget(writer);
    fs::write(dir.join("snapshot_1.vtu.part"), "<VTKFile").unwrap();
    let path = dir.join("history.csv");
    let whole = fs::read(&path).unwrap();
    let last_row = whole[..whole.len() - 1].iter().rposition(|&b| b == b'\n').unwrap() + 1;
    for end in last_row..whole.len() {
        fs::write(&path, &whole[..end]).unwrap();
        assert_eq!(read::history(&dir).unwrap(), rows[..2], "cut at byte {end}");
    }
    let files = read::snapshots(&dir).unwrap();
    assert_eq!(files.len(), 1);
    assert_eq!(read::snapshot(&files[0].path).unwrap().snapshot, snapshot(&mesh, 2e-3));
    assert_eq!(read::summary(&dir).unwrap(), None);
    assert_eq!(read::scene_text(&dir).unwrap(), None);
}

#[test]
fn a_run_killed_before_its_first_row_has_an_empty_history() {
    let (_temp, dir) = folder();
    let mesh = wheel();
    std::mem::forget(RunWriter::create(&dir, &mesh, Some("a = 1\n")).unwrap());
    assert_eq!(read::history(&dir).unwrap(), []);
    assert_eq!(read::snapshots(&dir).unwrap(), []);
    assert_eq!(read::scene_text(&dir).unwrap().as_deref(), Some("a = 1\n"));
}

#[test]
fn an_older_run_is_replaced_and_other_files_stay() {
    let (_temp, dir) = folder();
    let mesh = wheel();
    run(&dir, &mesh, |_, _| ());
    let left = ["my_body.png", "notes.txt", "snapshot_best.vtu"];
    let replaced = ["body_von_mises_0.png", "footprint_1.png", "contact_1.csv.part"];
    left.iter().chain(&replaced).for_each(|name| fs::write(dir.join(name), "x").unwrap());
    RunWriter::create(&dir, &mesh, None).unwrap();
    let names = fs::read_dir(&dir).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names.collect();
    names.sort();
    let fresh = [".hexroll", "history.csv", "run.pvd"];
    let mut expected: Vec<_> = fresh.iter().chain(&left).copied().collect();
    expected.sort();
    assert_eq!(names, expected);
}

#[test]
fn a_folder_with_other_files_is_left_alone() {
    let (_temp, dir) = folder();
    fs::create_dir_all(&dir).unwrap();
    fs::write(dir.join("history.csv"), "mine").unwrap();
    let mesh = wheel();
    let text = problem(RunWriter::create(&dir, &mesh, None), &dir);
    assert!(text.contains("no run wrote"), "{text}");
    assert_eq!(fs::read_dir(&dir).unwrap().count(), 1);
    assert_eq!(fs::read_to_string(dir.join("history.csv")).unwrap(), "mine");
}

#[test]
fn two_runs_do_not_share_a_folder() {
    let (_temp, dir) = folder();
    let mesh = wheel();
    let mut first = RunWriter::create(&dir, &mesh, None).unwrap();
    first.sample(&sample("roll", 1e-3)).unwrap();
    let text = problem(RunWriter::create(&dir, &mesh, None), &dir);
    assert!(text.contains("another run"), "{text}");
    assert_eq!(read::history(&dir).unwrap().len(), 1);
    drop(first);
    RunWriter::create(&dir, &mesh, None).unwrap();
    assert_eq!(read::history(&dir).unwrap(), []);
}

/// A write that fails, on the way or when the file gets its name, leaves neither the file nor a part of it.
#[test]
fn a_failed_write_leaves_nothing() {
    let (_temp, dir) = folder();
    fs::create_dir_all(&dir).unwrap();
    let names = || fs::read_dir(&dir).unwrap().map(|e| e.unwrap().file_name()).collect::<Vec<_>>();
    let full = || std::io::Error::from(std::io::ErrorKind::StorageFull);
    let half = |out: &mut dyn std::io::Write| out.write_all(b"half").and_then(|()| Err(full()));
    let error = write_whole(&dir.join("run.pvd"), half).unwrap_err();
    assert!(error.to_string().contains("run.pvd") && !error.to_string().contains("part"), "{error}");
    assert!(names().is_empty(), "{:?}", names());
    // A folder stands under the name.
    fs::create_dir(dir.join("summary.json")).unwrap();
    write_whole(&dir.join("summary.json"), |out| out.write_all(b"{}")).unwrap_err();
    assert_eq!(names(), ["summary.json"]);
    // What was there whole stays.
    write_whole(&dir.join("run.pvd"), |out| out.write_all(b"whole")).unwrap();
    write_whole(&dir.join("run.pvd"), half).unwrap_err();
    assert_eq!(fs::read(dir.join("run.pvd")).unwrap(), b"whole");
    assert_eq!(names().len(), 2, "{:?}", names());
}

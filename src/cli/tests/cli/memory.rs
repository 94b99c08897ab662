//! A mesh that does not fit in memory: an error with numbers, before anything is taken; what it says would fit, does.

#![cfg(unix)]

use std::os::unix::process::CommandExt;

use rustix::process::{Resource, Rlimit, setrlimit};

use super::program::{Done, Place};

/// Runs the program with at most so many bytes of addresses.
fn limited(place: &Place, bytes: u64, arguments: &[&str]) -> Done {
    let mut command = place.command(arguments);
    let limit = Rlimit { current: Some(bytes), maximum: Some(bytes) };
    // SAFETY: between fork and exec: one system call, which allocates nothing.
    unsafe { command.pre_exec(move || Ok(setrlimit(Resource::As, limit)?)) };
    Done::from(command.output().unwrap())
}

/// The case that once ended in an abort: 40 million elements under `ulimit -v 4000000`.
#[test]
fn forty_million_elements_in_four_gigabytes_are_refused() {
    let place = Place::new();
    place.scene("block.toml", |text| text);
    for command in [&["run", "--engine", "cpu"][..], &["run"], &["check"]] {
        let mesh = ["block.toml", "--set", "body.mesh.elements=[2000,100,200]"];
        let done = limited(&place, 4_000_000 << 10, &[command, &mesh].concat()).expect(4);
        let errors: Vec<&str> = done.stderr.lines().filter(|l| l.starts_with("error:")).collect();
        assert_eq!(errors.len(), 1, "{}", done.stderr);
        for part in
            ["40000000 elements need", "GB can be had", "ulimit -v", "body.mesh.elements = [", "would fit"]
        {
            assert!(errors[0].contains(part), "{part:?} is missing in {errors:?}");
        }
        assert!(!done.stderr.contains("panicked"), "{}", done.stderr);
    }
    assert!(!place.path("runs").exists());
}

#[test]
fn what_is_said_to_fit_runs_within_the_limit() {
    let place = Place::new();
    // A time so short that it is over after some steps.
    place
        .scene("block.toml", |text| text.replace("\"0.6 ms\"", "\"2 us\"").replace("\"0.4 ms\"", "\"2 us\""));
    let limit = 320 << 20;
    let run = |elements: &str| {
        let mesh = format!("body.mesh.elements={elements}");
        let engine = ["--engine", "cpu", "--threads", "1", "--set", "output.sample=1 us", "--out", "out"];
        limited(&place, limit, &[&["run", "block.toml", "--set", &mesh], &engine[..]].concat())
    };
    let refused = run("[300, 100, 100]").expect(4);
    let counts = refused.stderr.split("body.mesh.elements = ").nth(1).unwrap();
    let counts = &counts[..=counts.find(']').unwrap()];
    let done = run(counts);
    assert_eq!(done.code, Some(0), "{counts} of {}\n{done:#?}", refused.stderr);
}

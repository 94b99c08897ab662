//! Runs that end before their time: interrupted, or diverged. What was computed stays.

use hexroll::output::read;

use super::program::{Place, shipped};

/// The critical step exceeded by half: the highest mode grows about threefold a step.
#[test]
fn a_diverging_run_exits_5_and_keeps_its_history() {
    let place = Place::new();
    let scene = shipped("bouncing_block.toml");
    let done = place
        .hexroll(&["run", &scene, "--engine", "cpu", "--set", "time_step.safety=1.5", "--out", "out"])
        .expect(5);
    assert_eq!(done.stderr.lines().filter(|l| l.starts_with("error:")).count(), 1, "{}", done.stderr);
    let error = done.stderr.lines().find(|l| l.starts_with("error:")).unwrap();
    assert!(error.contains("step ") && error.contains("element "), "{error}");

    let dir = place.path("out");
    let history = read::history(&dir).unwrap();
    assert!(!history.is_empty());
    assert!(history.iter().all(|s| s.kinetic_J.is_finite() && s.min_jacobian > 0.0), "{history:#?}");
    let summary = read::summary(&dir).unwrap().unwrap();
    assert_eq!(summary.time_s, history.last().unwrap().time_s, "the summary is of what was written");
    assert!(summary.steps > 0 && summary.critical_dt_s > 0.0);
    let named = summary.warnings.iter().any(|w| w.contains("did not finish") && w.contains("element"));
    assert!(named, "{:?}", summary.warnings);
    assert!(summary.warnings.iter().any(|w| w.contains("safety")), "{:?}", summary.warnings);
}

/// A block that hits the road at a quarter of the speed of its waves: in windows shorter than the contact the critical step is
/// looked at while it is squeezed, in one long window it is not, and the summary says what that does.
#[test]
fn energies_that_do_not_add_up_are_named() {
    let place = Place::new();
    let scene = shipped("bouncing_block.toml");
    let run = |sample: &str, out: &str| {
        let sets = ["body.velocity=[\"0 m/s\", \"0 m/s\", \"-20 m/s\"]", "stage.0.duration=\"2.5 ms\""];
        let sample = format!("output.sample=\"{sample}\"");
        let snapshots = "output.snapshots=stage-ends";
        let args = [
            "run", &scene, "--engine", "cpu", "--set", sets[0], "--set", sets[1], "--set", &sample, "--set",
            snapshots, "--out", out,
        ];
        place.hexroll(&args).expect(0);
        let summary = read::summary(&place.path(out)).unwrap().unwrap();
        let named = summary.warnings.iter().any(|w| w.contains("not to be believed"));
        (summary.stored_balance.share_of_largest_term, named)
    };
    let (followed, named) = run("0.1 ms", "followed");
    assert!(followed < 0.02 && !named, "{followed}");
    let (lost, named) = run("2.5 ms", "lost");
    assert!(lost > 0.1 && named, "{lost}");
}

#[test]
fn a_stage_that_does_not_settle_exits_5() {
    let place = Place::new();
    let scene = shipped("pressed_block.toml");
    let short = ["--set", "stage.0.duration=21 ms", "--set", "stage.0.settle.residual=1e-12", "--out", "out"];
    let done = place.hexroll(&[&["run", &scene, "--engine", "cpu"], &short[..]].concat()).expect(5);
    assert!(done.stderr.contains("\"press\" did not settle"), "{}", done.stderr);
    assert_eq!(read::history(&place.path("out")).unwrap().len(), 21);
    assert_eq!(
        read::snapshots(&place.path("out")).unwrap().len(),
        1,
        "the last state is there to be looked at"
    );
}

#[cfg(unix)]
mod interrupted {
    use std::path::Path;
    use std::process::{Child, Stdio};
    use std::time::{Duration, Instant};

    use rustix::process::{Pid, Signal, kill_process};

    use super::*;
    use crate::program::Done;

    /// Ends the program if the test fails.
    struct Running(Option<Child>);

    impl Drop for Running {
        fn drop(&mut self) {
            if let Some(child) = &mut self.0 {
                // It may have ended by itself.
                _ = child.kill();
                _ = child.wait();
            }
        }
    }

    impl Running {
        fn signal(&self, signal: Signal) {
            kill_process(Pid::from_child(self.0.as_ref().unwrap()), signal).unwrap();
        }

        fn wait(mut self, most: Duration) -> Done {
            let start = Instant::now();
            while self.0.as_mut().unwrap().try_wait().unwrap().is_none() {
                assert!(start.elapsed() < most, "it does not end");
                std::thread::sleep(Duration::from_millis(20));
            }
            Done::from(self.0.take().unwrap().wait_with_output().unwrap())
        }
    }

    /// Starts a run that would take hours and waits until some of its history is written.
    fn start(place: &Place) -> Running {
        let scene = shipped("spinning_block.toml");
        let long =
            ["--set", "stage.0.duration=1000 s", "--set", "output.snapshots=stage-ends", "--out", "out"];
        let mut command = place.command(&[&["run", &scene, "--engine", "cpu"], &long[..]].concat());
        let running = Running(Some(command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()));
        let start = Instant::now();
        while rows(&place.path("out")) < 3 {
            assert!(start.elapsed() < Duration::from_secs(120), "no history appears");
            std::thread::sleep(Duration::from_millis(20));
        }
        running
    }

    fn rows(dir: &Path) -> usize {
        std::fs::read_to_string(dir.join("history.csv")).map_or(0, |t| t.lines().count().saturating_sub(1))
    }

    #[test]
    fn ctrl_c_ends_the_window_writes_everything_and_exits_130() {
        let place = Place::new();
        let running = start(&place);
        running.signal(Signal::INT);
        let done = running.wait(Duration::from_secs(120)).expect(130);
        assert!(done.stderr.contains("error: interrupted at t = "), "{}", done.stderr);
        assert!(done.stdout.contains("steps"), "the table is printed: {}", done.stdout);

        let dir = place.path("out");
        let history = read::history(&dir).unwrap();
        let summary = read::summary(&dir).unwrap().unwrap();
        assert_eq!(summary.time_s, history.last().unwrap().time_s);
        assert!(summary.warnings.iter().any(|w| w.contains("interrupted")), "{:?}", summary.warnings);
        let snapshots = read::snapshots(&dir).unwrap();
        assert_eq!(snapshots.len(), 1, "the state at the end is there");
        assert_eq!(snapshots[0].time, summary.time_s);
        read::snapshot(&snapshots[0].path).unwrap();
    }

    /// Steps of picoseconds: one window would take hours. The duration is said before, the state inside the window is shown and
    /// kept.
    #[test]
    fn sigterm_inside_a_window_of_hours_keeps_what_there_is() {
        let place = Place::new();
        // At rest on the road: nothing happens for a second.
        let still = |text: String| {
            let moving = ["gravity = [", "velocity = ["];
            let lines = text.lines().filter(|line| !moving.iter().any(|m| line.starts_with(m)));
            lines
                .collect::<Vec<_>>()
                .join("\n")
                .replace("\"2 Pa s\"", "\"1e9 Pa s\"")
                .replace(" ms\"", " s\"")
        };
        let scene = place.scene("stiff.toml", still);
        let args = ["run", scene.to_str().unwrap(), "--engine", "cpu", "--out", "out"];
        let mut command = place.command(&args);
        let running = Running(Some(command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()));
        let begun = Instant::now();
        while !place.path("out/history.csv").exists() {
            assert!(begun.elapsed() < Duration::from_secs(120), "it does not start");
            std::thread::sleep(Duration::from_millis(20));
        }
        std::thread::sleep(Duration::from_secs(2));
        running.signal(Signal::TERM);
        let done = running.wait(Duration::from_secs(60)).expect(130);
        let announced = done.stderr.lines().find(|l| l.starts_with("about ")).unwrap_or_default();
        assert!(announced.contains(" h ") && announced.contains(" steps of "), "{}", done.stderr);
        assert!(done.stderr.contains("steps/s"), "progress is shown: {}", done.stderr);

        let dir = place.path("out");
        let history = read::history(&dir).unwrap();
        let summary = read::summary(&dir).unwrap().unwrap();
        assert_eq!(history.len(), 1);
        assert!(history[0].time_s > 0.0 && history[0].time_s < 0.1, "{history:?}");
        assert_eq!((summary.time_s, summary.finished), (history[0].time_s, false));
        assert!(summary.steps > 100, "{}", summary.steps);
        let snapshots = read::snapshots(&dir).unwrap();
        assert_eq!(snapshots.iter().map(|s| s.time).collect::<Vec<_>>(), [summary.time_s]);
    }

    #[test]
    fn a_killed_run_is_readable_but_has_no_summary() {
        let place = Place::new();
        let running = start(&place);
        running.signal(Signal::KILL);
        running.wait(Duration::from_secs(60));
        assert!(read::history(&place.path("out")).unwrap().len() >= 3);
        assert_eq!(read::summary(&place.path("out")).unwrap(), None);
        place.hexroll(&["compare", "out", "out"]).expect(0);
    }
}

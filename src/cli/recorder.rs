//! Listens to a run: writes it down, shows its progress, ends it on Ctrl-C.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::progress::Display;
use hexroll::output::RunWriter;
use hexroll::record::{History, NewtonRow, Reaction, Sample, Snapshot};
use hexroll::run::{Observer, Progress, Totals};
use hexroll::{Error, Result};

static STOP: AtomicBool = AtomicBool::new(false);

/// From now on the first Ctrl-C (or SIGTERM, SIGHUP) asks the run to end, and the second ends the process.
pub fn listen_for_interrupts() -> Result<()> {
    let again = || {
        if STOP.swap(true, Ordering::SeqCst) {
            std::process::exit(130);
        }
        eprintln!("interrupted: ending here and writing everything; again to end at once");
    };
    ctrlc::set_handler(again).map_err(|e| {
        let source = std::io::Error::other(e);
        Error::io("Ctrl-C", "listen for interrupts")(source)
    })
}

/// Whether one has come.
pub fn interrupted() -> bool {
    STOP.load(Ordering::SeqCst)
}

/// The observer of a run.
pub struct Recorder<'w, 'm> {
    writer: &'w mut RunWriter<'m>,
    display: Display,
    /// Every row so far.
    pub history: Vec<Sample>,
    pub snapshots: usize,
    /// Names of the files of histories at a high rate.
    pub files: Vec<String>,
    /// As of the last row: what is known of a run that fails.
    pub totals: Totals,
    /// Wall time spent on writing and showing.
    pub output: Duration,
}

impl<'w, 'm> Recorder<'w, 'm> {
    pub fn new(writer: &'w mut RunWriter<'m>, display: Display) -> Self {
        let (history, totals, output) = (Vec::new(), Totals::default(), Duration::ZERO);
        Recorder { writer, display, history, snapshots: 0, files: Vec::new(), totals, output }
    }

    /// Ends the display.
    pub fn finish(&mut self) {
        self.display.finish();
    }
}

impl Observer for Recorder<'_, '_> {
    fn sample(&mut self, sample: &Sample, progress: &Progress) -> Result<()> {
        let start = Instant::now();
        self.history.push(sample.clone());
        self.totals = progress.totals.clone();
        self.writer.sample(sample)?;
        self.display.update(progress);
        self.output += start.elapsed();
        Ok(())
    }

    fn advanced(&mut self, progress: &Progress) {
        let start = Instant::now();
        self.display.update(progress);
        self.output += start.elapsed();
    }

    fn snapshot(&mut self, snapshot: &Snapshot, stage: &str) -> Result<()> {
        let start = Instant::now();
        self.writer.snapshot(snapshot, stage)?;
        self.snapshots += 1;
        self.output += start.elapsed();
        Ok(())
    }

    fn histories(&mut self, histories: Vec<History>) -> Result<()> {
        let start = Instant::now();
        for history in &histories {
            self.files.extend(self.writer.history(history)?);
        }
        self.output += start.elapsed();
        Ok(())
    }

    fn increment(&mut self, iterations: &[NewtonRow]) -> Result<()> {
        self.writer.iterations(iterations)
    }

    fn reactions(&mut self, row: &Sample, sets: &[Reaction]) -> Result<()> {
        self.writer.reactions(row, sets)
    }

    fn interrupted(&self) -> bool {
        interrupted()
    }
}

//! How far a run has come: a bar on a terminal, plain lines elsewhere, both on stderr.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::format::{duration, si, updates};
use hexroll::run;

/// Parts the bar is divided into.
const PARTS: u64 = 1000;
/// A plain line is due after this share of the run, or this time.
const SHARE: f64 = 0.1;
const PAUSE: Duration = Duration::from_secs(10);
/// The same for one of many runs, of which no share makes a line due.
const LONG_PAUSE: Duration = Duration::from_secs(60);

/// Shows the progress of one run.
pub struct Display {
    /// In front of every line: which of many runs it is.
    name: String,
    /// Time after which a plain line is due.
    pause: Duration,
    elements: usize,
    start: Instant,
    shown: Shown,
}

enum Shown {
    Bar(ProgressBar),
    /// What the last line said, and what the next one would say.
    Lines {
        share: f64,
        at: Instant,
        next: Option<String>,
    },
}

impl Display {
    pub fn new(elements: usize) -> Display {
        let start = Instant::now();
        let shown = if std::io::stderr().is_terminal() {
            let style = ProgressStyle::with_template("{bar:12} {percent:>3} %  {wide_msg}");
            let bar = ProgressBar::new(PARTS);
            Shown::Bar(bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())))
        } else {
            Shown::Lines { share: 0.0, at: start, next: None }
        };
        Display { name: String::new(), pause: PAUSE, elements, start, shown }
    }

    /// For one of many runs: plain lines, and none within the first minute.
    pub fn quiet(elements: usize, name: &str) -> Display {
        let start = Instant::now();
        let shown = Shown::Lines { share: f64::INFINITY, at: start, next: None };
        Display { name: format!("{name}: "), pause: LONG_PAUSE, elements, start, shown }
    }

    /// A window has ended, or steps within one have been taken.
    pub fn update(&mut self, progress: &run::Progress) {
        let share = (progress.time / progress.end).min(1.0);
        let text = status(progress, share, self.elements, self.start.elapsed().as_secs_f64());
        match &mut self.shown {
            Shown::Bar(bar) => {
                bar.set_message(text);
                bar.set_position((share * PARTS as f64) as u64);
            }
            Shown::Lines { share: shown, at, next } => {
                let line = format!("{}{:>3.0} %  {text}", self.name, 100.0 * share);
                if share >= *shown + SHARE || at.elapsed() >= self.pause {
                    (*shown, *at, *next) = (shown.max(share), Instant::now(), None);
                    eprintln!("{line}");
                } else if self.name.is_empty() {
                    *next = Some(line);
                }
            }
        }
    }

    /// Leaves the terminal to the results; plain lines end with where the run ended.
    pub fn finish(&mut self) {
        match &mut self.shown {
            Shown::Bar(bar) => bar.finish_and_clear(),
            Shown::Lines { next, .. } => next.take().into_iter().for_each(|line| eprintln!("{line}")),
        }
    }
}

/// One line, the most wanted first: a narrow terminal cuts it off. Rates are means since the start.
fn status(progress: &run::Progress, share: f64, elements: usize, seconds: f64) -> String {
    let steps = progress.steps as f64 / seconds;
    format!(
        "{}  {} of {}  ETA {}  {steps:.1e} steps/s  {}",
        progress.stage,
        si(progress.time, "s"),
        si(progress.end, "s"),
        duration(seconds * (1.0 - share) / share),
        updates(steps * elements as f64),
    )
}

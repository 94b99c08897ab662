//! What is kept of a stage as it goes: the scatter of its forces, when a snapshot is due, what its balance began with.

use super::chatter::Chatter;
use super::scatter::Scatter;
use crate::engine::StepContact;
use crate::scene::Snapshots;

/// What decides what is recorded next.
#[derive(Debug, Clone)]
pub struct Recorder {
    pub chatter: Chatter,
    /// Scatter of the road's force in the window.
    pub scatter: Scatter,
    /// Time and spin angle up to which both know its steps [s, rad].
    heard: [f64; 2],
    /// When the next snapshot is due [s]; never of a scene without intervals.
    next_snapshot: f64,
    /// Time over which the forces of the window acted [s]: its length, but for the half step after velocities were set.
    pub force_time: f64,
    /// Latest possible end of the simulation [s].
    pub end: f64,
    /// Error of the stored-energy balance that implicit stages left, and one that is too small to speak of [J].
    pub unbalanced: f64,
    pub negligible: f64,
}

impl Recorder {
    pub fn new(chatter: Chatter, negligible: f64) -> Recorder {
        let next_snapshot = f64::INFINITY;
        Recorder {
            chatter,
            scatter: Scatter::default(),
            heard: [0.0; 2],
            next_snapshot,
            force_time: 0.0,
            end: 0.0,
            unbalanced: 0.0,
            negligible,
        }
    }

    /// For a stage that starts at `start` [s].
    pub fn begin(&mut self, start: f64, chatter: Chatter, snapshots: Snapshots) {
        self.chatter = chatter;
        self.scatter = Scatter::default();
        self.next_snapshot = match snapshots {
            Snapshots::Every(interval) => start + interval,
            _ => f64::INFINITY,
        };
    }

    /// A window starts at `time` with the rim's spin angle at `spin` [s, rad].
    pub fn begin_window(&mut self, time: f64, spin: f64) {
        (self.force_time, self.scatter, self.heard) = (0.0, Scatter::default(), [time, spin]);
    }

    /// Takes down the contact of the window's next steps, which end at `time` with the rim's spin angle at `spin`.
    pub fn hear(&mut self, time: f64, spin: f64, steps: &[StepContact]) {
        let [start, before] = std::mem::replace(&mut self.heard, [time, spin]);
        self.chatter.add(start, time, [before, spin], steps);
        self.scatter.add(steps);
    }

    /// Whether whole fields are wanted of a window that ends at `time`, by its place or because it is the `last`; windows
    /// are `sample` seconds long.
    pub fn wants_fields(&mut self, snapshots: Snapshots, time: f64, sample: f64, last: bool) -> bool {
        // Half a window of slack: snapshot times are whole windows.
        let due = time >= self.next_snapshot - 0.5 * sample;
        if snapshots == Snapshots::None || !(due || last) {
            return false;
        }
        if let (true, Snapshots::Every(interval)) = (due, snapshots) {
            self.next_snapshot += interval;
        }
        true
    }
}

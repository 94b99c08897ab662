//! Histories at a high rate: states of nodes after every step, resampled on an even grid (`signal/resample.rs`).
//!
//! The engine keeps the watched nodes' states of every step (`Engine::watch`). Once a part of a window has been taken they
//! are made into what the scene asks for (`track.rs`), each quantity at the time it belongs to: positions at the end of a step,
//! velocities in its middle, accelerations and contact forces at its start. A filter then takes all of them to the same grid,
//! whose times are whole numbers of its period from the start of the simulation.

mod places;
mod points;
mod track;

use crate::engine::{NodeState, Step, StepContact, Watched};
use crate::error::Result;
use crate::model::Model;
use crate::physics::rim::Coordinates;
use crate::record::History;
use crate::scene::{Method, Scene, Stage};
use track::Track;

/// Bytes of states that are held between two looks at them.
const ROOM: usize = 48 << 20;
/// Most steps between two looks, and fewest.
const STEPS: [usize; 2] = [4, 512];

/// Every history of a run.
#[derive(Debug, Default)]
pub struct Histories {
    tracks: Vec<Track>,
    /// Which of them are taken down in the present stage.
    on: Vec<bool>,
    /// Steps since the last look with the states of the watched nodes after them, and their contact.
    steps: Vec<Step>,
    states: Vec<NodeState>,
    watched: usize,
}

/// The rim at the two ends of a stretch of steps, and which of its components the plan does not know.
#[derive(Debug, Clone, Copy)]
pub struct Ends {
    pub start: f64,
    pub end: f64,
    pub at: [Coordinates; 2],
    pub rate: [Coordinates; 2],
    pub free: [bool; 6],
}

impl Histories {
    /// The histories that a scene asks for.
    ///
    /// # Errors
    /// [`Error::Scene`](crate::Error::Scene) for places that the model does not have.
    pub fn new(scene: &Scene, model: &Model) -> Result<Histories> {
        let count = scene.output.histories.len();
        let tracks = (0..count).map(|k| Track::new(scene, model, k)).collect::<Result<Vec<_>>>()?;
        Ok(Histories { on: vec![false; count], tracks, ..Histories::default() })
    }

    /// Begins a stage; the nodes to watch in it.
    pub fn begin(&mut self, stage: &Stage, scene: &Scene, model: &Model) -> Vec<Watched> {
        let mut watched = Vec::new();
        for ((track, on), history) in self.tracks.iter_mut().zip(&mut self.on).zip(&scene.output.histories) {
            let before = *on;
            *on = match &history.stages {
                Some(stages) => stages.contains(&stage.name) && !matches!(stage.method, Method::Implicit(_)),
                None => stage.method == Method::Explicit,
            };
            // What was before is over where nothing is taken down, or velocities are set anew.
            if before && (!*on || stage.initial_velocity.is_some()) {
                track.end();
            }
            track.first = watched.len();
            if *on {
                watched.extend(track.watched(&model.mesh));
            }
        }
        self.watched = watched.len();
        watched
    }

    /// Whether anything is taken down now.
    pub fn any(&self) -> bool {
        self.watched > 0
    }

    /// Steps after which what has been kept should be looked at.
    pub fn most(&self) -> usize {
        match self.watched {
            0 => usize::MAX,
            n => (ROOM / (n * size_of::<NodeState>())).clamp(STEPS[0], STEPS[1]),
        }
    }

    /// Keeps steps that have been taken, with the states after them.
    pub fn took(&mut self, steps: &[Step], states: Vec<NodeState>) {
        if self.any() {
            self.steps.extend_from_slice(steps);
            self.states.extend(states);
        }
    }

    /// Looks at the steps since the last look. Impulses have begun anew with them. `contact`: of each of them, if there is a road.
    ///
    /// # Errors
    /// [`Error::Scene`](crate::Error::Scene) where steps are longer than the period that a history asks for.
    pub fn look(&mut self, ends: &Ends, contact: &[StepContact]) -> Result<()> {
        let steps = std::mem::take(&mut self.steps);
        let states = std::mem::take(&mut self.states);
        if steps.is_empty() {
            return Ok(());
        }
        let moments = track::moments(&steps, ends);
        for (track, _) in self.tracks.iter_mut().zip(&self.on).filter(|(_, on)| **on) {
            track.forget_impulses();
            for (n, (step, moment)) in steps.iter().zip(&moments).enumerate() {
                let row = &states[n * self.watched..(n + 1) * self.watched];
                track.take(step, moment, row, contact.get(n))?;
            }
            track.give();
        }
        Ok(())
    }

    /// Everything that has been taken down, at the end of a run.
    pub fn finish(&mut self) -> Vec<History> {
        self.tracks.iter_mut().map(Track::finish).collect()
    }
}

//! Implicit stages in the run loop: increments instead of windows of steps, the same samples and snapshots, and the
//! state handed to the engine for the stage that comes.

use super::footprint::Footprint;
use super::state::{Run, State};
use crate::engine::{self, Window};
use crate::error::{Error, Result};
use crate::implicit::booking::Books;
use crate::implicit::contact::Surface;
use crate::implicit::increments::Increments;
use crate::implicit::problem::Problem;
use crate::implicit::{self, Failure, Iteration, Limits, Newton, Scheme, Simulation, Target};
use crate::model::Model;
use crate::record::NewtonRow;
use crate::scene::{Drive, Friction, Implicit, ImplicitScheme, Road, Stage};

/// An implicit stage on its way.
struct Progressing<'m> {
    simulation: Simulation<'m>,
    books: Books,
    lengths: Increments,
    /// Residual of the last increment [N].
    residual: f64,
}

/// What came of an increment.
enum Outcome {
    Taken,
    /// It is tried again with a shorter one.
    Cut,
    /// An interruption was seen between its iterations; the state is that before it.
    Interrupted,
}

impl<'a> Run<'a> {
    /// Runs an implicit stage. A static one gives a row an increment, whose forces are those at its end, and ends when
    /// every ramp is over, unless something keeps moving.
    pub fn implicit_stage(&mut self, stage: &Stage, settings: &Implicit) -> Result<()> {
        let start = self.state.totals.time;
        let end = self.implicit_end(stage, settings, start);
        let sample = match settings.scheme {
            // Every increment is a window.
            ImplicitScheme::Static { .. } => 0.0,
            ImplicitScheme::Dynamic { .. } => self.scene.output.sample,
        };
        let mut on = self.begin_implicit(stage, settings, start, end)?;
        let mut window_start = start;
        let mut windows = 1;
        while self.state.totals.time < end {
            let window_end = if sample > 0.0 { end.min(start + windows as f64 * sample) } else { end };
            let left = window_end - self.state.totals.time;
            // The last sliver of a window is round-off.
            let length = if left < 1e-9 * (end - start) { left } else { on.lengths.next(left) };
            let whole = length == left;
            let time = if whole { window_end } else { self.state.totals.time + length };
            let outcome = self.increment(stage, &mut on, time, length)?;
            if matches!(outcome, Outcome::Interrupted) || self.observer.interrupted() {
                self.end_early(stage, &mut on, window_start)?;
                break;
            }
            if matches!(outcome, Outcome::Cut) {
                continue;
            }
            if sample > 0.0 && !whole {
                self.tell(stage, time, 0);
                continue;
            }
            windows += 1;
            let window = self.close(stage, &mut on, time - window_start)?;
            window_start = time;
            self.snapshots(stage, &window, time == end)?;
        }
        // The explicit engine starts from velocities at this moment.
        let State { totals, control, .. } = &mut self.state;
        control.before = 0.0;
        control.look_again(totals.steps);
        Ok(())
    }

    /// Ends an interrupted stage at its last increment: the window that began at `window_start` is cut short there.
    fn end_early(&mut self, stage: &Stage, on: &mut Progressing<'_>, window_start: f64) -> Result<()> {
        let length = self.state.totals.time - window_start;
        let window = match length > 0.0 {
            true => self.close(stage, on, length)?,
            // Nothing since the last row, whose fields may not have been kept: the forces that stand there, for a second.
            false => self.standing(on, 1.0)?,
        };
        self.snapshots(stage, &window, true)?;
        self.state.totals.interrupted = true;
        Ok(())
    }

    /// A window of the last converged state, as if it stood for `length` [s], with which the engine gets the state.
    fn standing(&mut self, on: &mut Progressing<'_>, length: f64) -> Result<Window> {
        self.hand_over(on)?;
        self.state.recorder.force_time = length;
        Ok(on.books.standing(&on.simulation, length, on.residual))
    }

    /// When the stage ends: with the ramps of a static one, if nothing moves on.
    fn implicit_end(&self, stage: &Stage, settings: &Implicit, start: f64) -> f64 {
        let moves = |d: &Drive| matches!(d, Drive::Velocity { to, .. } if *to != 0.0);
        let road_moves = self.scene.friction.is_some() && self.scene.road.as_ref().is_some_and(Road::moves);
        let settled = self.state.rim.motion.settled_after().max(self.model.mesh.driven_end());
        match settings.scheme {
            ImplicitScheme::Static { .. }
                if !road_moves && settled.is_finite() && !stage.rim.drives().iter().any(moves) =>
            {
                if settled > start { settled.min(start + stage.duration) } else { start + stage.duration }
            }
            _ => start + stage.duration,
        }
    }

    fn begin_implicit(
        &mut self,
        stage: &Stage,
        settings: &Implicit,
        start: f64,
        end: f64,
    ) -> Result<Progressing<'a>> {
        let model: &'a Model = self.model;
        let problem = Problem::new(model, self.scene.gravity);
        let limits = Limits { tolerance: settings.tolerance, iterations: settings.iterations };
        let inner = implicit::inner(model, settings.solver)?;
        let newton = Newton::new(&problem, inner, limits);
        let (scheme, lengths) = match settings.scheme {
            ImplicitScheme::Static { increments } => {
                let length = (end - start) / increments as f64;
                // With friction the path matters, and so does how finely it is followed.
                let most = if self.scene.friction.is_some() { length } else { end - start };
                (Scheme::Static, Increments::new(length, most))
            }
            ImplicitScheme::Dynamic { step, damping } => {
                (Scheme::Dynamic { delta: damping }, Increments::new(step, step))
            }
        };
        let mut state = self.engine.state()?;
        if scheme == Scheme::Static {
            state.v.fill([0.0; 3]);
            self.state.rim.rate = [0.0; 6];
            self.state.totals.ledger.velocities_set(0.0);
            self.state.totals.ledger.rim_set(0.0);
        }
        let surface = surface(self.scene.road.as_ref(), self.scene.friction, model);
        let rim = [self.state.rim.at, self.state.rim.rate];
        let mut simulation = Simulation::new(problem, newton, scheme, surface, state, rim);
        let target = self.target(stage, start, 0.0);
        simulation.start(&target).map_err(|f| failed(stage, start, &f))?;
        Ok(Progressing { books: Books::new(&simulation), simulation, lengths, residual: 0.0 })
    }

    fn target(&self, stage: &Stage, time: f64, dt: f64) -> Target {
        Target {
            time,
            dt,
            rim: self.state.rim.motion.coordinates_at(time),
            load: self.state.rim.motion.pull_at(time),
            free: self.state.rim.motion.setup(0.0).free,
            damping: stage.mass_damping,
        }
    }

    /// Tries an increment.
    fn increment(
        &mut self,
        stage: &Stage,
        on: &mut Progressing<'_>,
        time: f64,
        length: f64,
    ) -> Result<Outcome> {
        let target = self.target(stage, time, length);
        match on.simulation.step_unless(&target, &|| self.observer.interrupted()) {
            Ok(log) => {
                let newton = log.len() - 1;
                on.lengths.converged(length, newton);
                on.books.book(&on.simulation, length, stage.mass_damping);
                on.residual = log.last().map_or(0.0, |l| l.residual) * on.simulation.newton.scale;
                self.state.totals.stepped(time, length, 1);
                let counts = &mut self.state.totals.implicit;
                counts.increments += 1;
                counts.newton += newton;
                counts.inner += log.iter().map(|l| l.inner).sum::<usize>();
                self.observer.increment(&rows(stage, [time, length], "converged", &log))?;
                self.observer.note(&line(stage, time, length, &log))?;
                Ok(Outcome::Taken)
            }
            Err(Failure::Interrupted) => Ok(Outcome::Interrupted),
            Err(failure) => {
                self.state.totals.implicit.cuts += 1;
                let cut = on.lengths.failed(length);
                let log = on.simulation.newton.log();
                self.observer.increment(&rows(stage, [time, length], "failed", log))?;
                self.observer.note(&format!("{}: increment to t = {time:.6e} s: {failure}", stage.name))?;
                if cut {
                    return Ok(Outcome::Cut);
                }
                // The last converged state is the last row; its fields are kept too.
                let window = self.standing(on, length)?;
                self.state.control.before = length;
                self.snapshots(stage, &window, true)?;
                Err(failed(stage, self.state.totals.time, &failure))
            }
        }
    }

    /// Closes a window: the engine gets the state, the history its row.
    fn close(&mut self, stage: &Stage, on: &mut Progressing<'_>, length: f64) -> Result<Window> {
        let window = on.books.take(&on.simulation, on.residual);
        self.hand_over(on)?;
        let dt = length / window.steps as f64;
        self.state.control.before = dt;
        self.state.recorder.force_time = length;
        let footprint = Footprint::of(self.model, self.scene.road.as_ref(), length, &window);
        let row = self.book(stage, dt, &window, &footprint)?;
        self.state.recorder.unbalanced = row.stored_balance_error_J;
        self.holds_its_shape(&row)?;
        Ok(window)
    }

    fn hand_over(&mut self, on: &Progressing<'_>) -> Result<()> {
        let s = &on.simulation;
        (self.state.rim.at, self.state.rim.rate) = (s.q, s.q_rate);
        self.engine.set_state(&engine::State { x: s.x.clone(), v: s.v.clone() }, &s.q, &s.q_rate)
    }
}

fn surface(road: Option<&Road>, friction: Option<Friction>, model: &Model) -> Option<Surface> {
    let reach = model.mesh.nodes.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs()));
    road.map(|road| Surface {
        road: road.clone(),
        friction,
        inverse_area: Vec::new(),
        dt: 0.0,
        // A few units in the last place of a position.
        touch: 16.0 * f64::EPSILON * reach,
    })
}

fn failed(stage: &Stage, time: f64, failure: &Failure) -> Error {
    Error::NotSettled {
        stage: stage.name.clone(),
        detail: format!(
            "{failure}; the last converged state, t = {time:.6e} s, is kept. Shorter increments or steps, or another \
             [stage.implicit] solver may help"
        ),
    }
}

/// An increment's rows of `implicit.csv`.
fn rows(stage: &Stage, [time, length]: [f64; 2], increment: &str, log: &[Iteration]) -> Vec<NewtonRow> {
    let row = |(iteration, i): (usize, &Iteration)| NewtonRow {
        stage: stage.name.clone(),
        time_s: time,
        dt_s: length,
        increment: increment.into(),
        iteration,
        residual: i.residual,
        contact_changes: i.changes,
        inner_iterations: i.inner,
        share: i.share,
    };
    log.iter().enumerate().map(row).collect()
}

/// An increment in the log: iterations with their residuals, contact changes and inner iterations.
fn line(stage: &Stage, time: f64, length: f64, log: &[Iteration]) -> String {
    let entry = |i: &Iteration| {
        let cut = if i.share < 1.0 && i.inner > 0 { format!(" x{:.3}", i.share) } else { String::new() };
        format!("{:.1e} ({} changes, {} inner{cut})", i.residual, i.changes, i.inner)
    };
    let entries: Vec<String> = log.iter().map(entry).collect();
    format!("{}: t = {time:.6e} s, dt = {length:.3e} s: {}", stage.name, entries.join(", "))
}

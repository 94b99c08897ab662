//! The clock: a wheel on one engine, or several at once, step after step.

use std::time::Instant;

use super::machine::resident_memory;
use super::report::Spread;
use super::wheel::Roll;
use hexroll::Result;
use hexroll::engine::{Engine, State};
use hexroll::model::Model;

/// Measurements of a row.
const BATCHES: usize = 7;

/// The measurement of one engine.
pub(super) struct Clock {
    pub us: Spread,
    pub steps: u64,
    pub batch: usize,
}

impl Clock {
    /// Starts the wheel, sinks it in, then times equal batches of steps for about `seconds`.
    pub fn run(engine: &mut dyn Engine, model: &Model, roll: &Roll, seconds: f64) -> Result<Clock> {
        roll.start(engine, model)?;
        let mut taken = 0;
        let mut advance = |count: usize| roll.timed(engine, &mut taken, count);
        // The first steps also build what an engine builds on first use.
        advance(2)?;
        let begun = Instant::now();
        let mut each = advance(8)?;
        // Until the footprint is there, or for as long as may be.
        for _ in 0..19 {
            if begun.elapsed().as_secs_f64() > seconds {
                break;
            }
            each = advance(10)?;
        }
        let longest = (roll.whole_run() as usize / BATCHES).max(3);
        let batch = ((seconds / BATCHES as f64 / each) as usize).clamp(3, longest);
        let us = (0..BATCHES).map(|_| Ok(1e6 * advance(batch)?)).collect::<Result<Vec<f64>>>()?;
        Ok(Clock { us: Spread::of(us), steps: taken, batch })
    }
}

/// Several independent engines at once, one a thread: the slowest one's times, the first one's state.
pub(super) fn together(
    copies: usize,
    make: &(dyn Fn() -> Result<Box<dyn Engine>> + Sync),
    model: &Model,
    roll: &Roll,
    seconds: f64,
) -> Result<(Clock, State, Option<u64>)> {
    let one = || -> Result<(Clock, State, Option<u64>)> {
        let mut engine = make()?;
        let clock = Clock::run(&mut *engine, model, roll, seconds)?;
        let memory = resident_memory();
        Ok((clock, engine.state()?, memory))
    };
    std::thread::scope(|scope| {
        let others: Vec<_> = (1..copies).map(|_| scope.spawn(one)).collect();
        let (mut clock, state, memory) = one()?;
        for other in others {
            let (theirs, _, _) = other.join().expect("a timing thread ends")?;
            if theirs.us.median > clock.us.median {
                clock.us = theirs.us;
            }
        }
        Ok((clock, state, memory))
    })
}

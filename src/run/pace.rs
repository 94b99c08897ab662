//! How many steps are taken between two looks at who listens.

use std::time::Duration;

/// Aimed wall time of a piece: an interruption is seen within it, and a GPU's pieces are several submissions.
const PIECE: Duration = Duration::from_millis(400);
/// Steps of the first piece, of which nothing is known, and how much longer the next may be than the last.
const FIRST: usize = 16;
const GROWTH: usize = 16;

/// Pieces of equal wall time. How steps are cut into pieces changes no bit of what they compute.
#[derive(Debug, Clone)]
pub struct Pace {
    most: usize,
}

impl Default for Pace {
    fn default() -> Pace {
        Pace { most: FIRST }
    }
}

impl Pace {
    /// Steps of the next piece, at most; at least one.
    pub fn most(&self) -> usize {
        self.most
    }

    /// Learns from a piece of `steps` steps that took this long.
    pub fn took(&mut self, steps: usize, wall: Duration) {
        let fitting = PIECE.as_secs_f64() * steps as f64 / wall.as_secs_f64().max(1e-9);
        self.most = (fitting as usize).clamp(1, GROWTH * steps.max(1));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_come_to_the_aimed_wall_time() {
        // From a wheel on a GPU to a mesh of which a single step takes seconds.
        for seconds in [1e-7, 2e-5, 0.03, 7.0] {
            let mut pace = Pace::default();
            for _ in 0..8 {
                let steps = pace.most();
                assert!(steps >= 1);
                pace.took(steps, Duration::from_secs_f64(seconds * steps as f64));
            }
            let wall = seconds * pace.most() as f64;
            // One step at least, and a step short of the aim by rounding down.
            assert!(wall > PIECE.as_secs_f64() - 2.0 * seconds, "{seconds} s a step: {wall} s");
            assert!(wall <= PIECE.as_secs_f64() * 1.001 || pace.most() == 1, "{seconds} s a step: {wall} s");
        }
    }
}

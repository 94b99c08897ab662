//! Lengths of increments: cut where Newton's method fails, grown where it is easy.

/// Newton iterations below which the next increment may be longer, and by how much.
const EASY: usize = 6;
const GROWTH: f64 = 1.5;
/// Cuts in a row after which a stage is given up: 1/1024 of the length asked for.
const CUTS: i32 = 10;

/// Length of the next increment [s].
#[derive(Debug, Clone, Copy)]
pub struct Increments {
    length: f64,
    asked: f64,
    most: f64,
}

impl Increments {
    /// Starts with `asked`, and never takes more than `most`.
    pub fn new(asked: f64, most: f64) -> Increments {
        Increments { length: asked.min(most), asked, most }
    }

    /// The next length, so that `left` is not missed by a sliver.
    pub fn next(&self, left: f64) -> f64 {
        if left <= self.length * (1.0 + 1e-9) {
            left
        } else if left < 1.5 * self.length {
            0.5 * left
        } else {
            self.length
        }
    }

    /// An increment of `length` has converged.
    pub fn converged(&mut self, length: f64, iterations: usize) {
        if iterations <= EASY && length >= 0.5 * self.length {
            self.length = (GROWTH * self.length).min(self.most);
        }
    }

    /// An increment of `length` has failed; `false`: it is already too short to cut.
    pub fn failed(&mut self, length: f64) -> bool {
        self.length = 0.5 * length;
        self.length >= self.asked * 2f64.powi(-CUTS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn increments_are_cut_and_grow_and_end_on_time() {
        let mut lengths = Increments::new(1.0, 1.2);
        assert_eq!((lengths.next(10.0), lengths.next(1.4), lengths.next(1.0)), (1.0, 0.7, 1.0));
        assert!(lengths.failed(1.0));
        assert_eq!(lengths.next(10.0), 0.5);
        lengths.converged(0.5, 9);
        assert_eq!(lengths.next(10.0), 0.5);
        (0..3).for_each(|_| lengths.converged(lengths.length, 3));
        assert_eq!(lengths.next(10.0), 1.2);
        let cuts = (0..20).take_while(|_| lengths.failed(lengths.length)).count();
        assert_eq!(cuts, 10);
    }
}

//! How the road's force scatters over the steps of one window, with no step remembered.

use crate::engine::StepContact;

/// Moments of the road's force over the steps of a window so far.
#[derive(Debug, Clone, Copy, Default)]
pub struct Scatter {
    /// Sum of the mean steps [s].
    weight: f64,
    /// Weighted mean of the force [N], and the weighted sum of its squared deviations from it [N2 s].
    mean: [f64; 3],
    squares: [f64; 3],
    /// Node-steps that touch, and those that change their state.
    touching: u64,
    changes: u64,
}

impl Scatter {
    /// Adds the steps that follow. Steps that come all at once are summed in two passes, so that nothing cancels;
    /// pieces are merged by their means (Chan, Golub & LeVeque 1979).
    pub fn add(&mut self, steps: &[StepContact]) {
        let weight: f64 = steps.iter().map(|s| s.dtm).sum();
        self.touching += steps.iter().map(|s| u64::from(s.touching)).sum::<u64>();
        self.changes += steps.iter().map(|s| u64::from(s.changes)).sum::<u64>();
        if weight <= 0.0 {
            return;
        }
        for d in 0..3 {
            let mean = steps.iter().map(|s| s.dtm * s.force[d]).sum::<f64>() / weight;
            let square = |s: &StepContact| s.dtm * (s.force[d] - mean).powi(2);
            let squares = steps.iter().map(square).sum::<f64>();
            let apart = mean - self.mean[d];
            let share = weight / (self.weight + weight);
            self.squares[d] += squares + self.weight * share * apart * apart;
            // The mean of the first piece as it is, to the bit.
            self.mean[d] = if self.weight == 0.0 { mean } else { self.mean[d] + share * apart };
        }
        self.weight += weight;
    }

    /// Standard deviation of the road's force over the steps [N].
    pub fn deviation(&self) -> [f64; 3] {
        if self.weight <= 0.0 {
            return [0.0; 3];
        }
        self.squares.map(|sum| (sum / self.weight).sqrt())
    }

    /// Nodes that change their contact state from one step to the next, over touching nodes.
    pub fn changing_share(&self) -> f64 {
        if self.touching > 0 { self.changes as f64 / self.touching as f64 } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(dtm: f64, z: f64) -> StepContact {
        StepContact { dtm, force: [0.0, 0.0, z], touching: 4, changes: 1 }
    }

    fn of(pieces: &[&[StepContact]]) -> Scatter {
        let mut scatter = Scatter::default();
        pieces.iter().for_each(|piece| scatter.add(piece));
        scatter
    }

    #[test]
    fn the_deviation_of_a_window_is_weighted_with_the_steps() {
        // Mean (1 * 0 + 3 * 4) / 4 = 3, variance (9 + 3 * 1) / 4 = 3.
        let steps = [step(1.0, 0.0), step(3.0, 4.0)];
        assert_eq!(of(&[&steps]).deviation(), [0.0, 0.0, 3.0_f64.sqrt()]);
        assert_eq!(of(&[&steps]).changing_share(), 0.25);
        assert_eq!((of(&[]).deviation(), of(&[]).changing_share()), ([0.0; 3], 0.0));
    }

    #[test]
    fn pieces_have_the_deviation_of_the_whole() {
        // A drift, so that the pieces' means differ, on a mean a thousand times the deviation.
        let force = |n: usize| 1e4 + 0.01 * n as f64 + ((n * n) % 7) as f64;
        let steps: Vec<StepContact> = (0..1000).map(|n| step(1e-6 * (1 + n % 3) as f64, force(n))).collect();
        let (whole, parts) = (of(&[&steps]), of(&[&steps[..1], &steps[1..400], &[], &steps[400..]]));
        // Squares of 1e4 N cancel to 10 N2: 1e-16 * 1e8 / 10 at worst.
        let (a, b) = (whole.deviation()[2], parts.deviation()[2]);
        assert!((a / b - 1.0).abs() < 1e-9, "{a} and {b} N");
        assert_eq!(whole.changing_share(), parts.changing_share());
    }
}

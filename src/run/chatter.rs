//! Chatter: how the road's force scatters from step to step, with the tone of the mesh taken out.
//!
//! Every step's force is fitted, by least squares weighted with the mean steps, by a + b t + sum_h (c_h cos h phi +
//! s_h sin h phi), phi = N times the spin angle of a ring mesh of N elements round the circumference. The normal
//! equations are additive over time, so they are kept by blocks of windows and no step is remembered; when there are
//! many blocks, neighbours are merged. At the end, the blocks of the stage's last 30 % are added and solved.

use std::f64::consts::TAU;

use crate::engine::StepContact;
use crate::record::{ContactNoise, Tone};

/// Multiples of the node-passing frequency that are taken out.
const HARMONICS: usize = 3;
/// a, b, and two a harmonic.
const UNKNOWNS: usize = 2 + 2 * HARMONICS;
/// Blocks above which neighbours are merged: 30 % of them is a fine enough choice of the last 30 % of a stage.
const MOST: usize = 512;

/// Scatter of the road's force in one stage, kept as it goes.
#[derive(Debug, Clone)]
pub struct Chatter {
    /// Elements round the circumference of a ring mesh.
    sides: Option<usize>,
    /// Start of the stage and the unit of time of the fit [s].
    start: f64,
    unit: f64,
    /// Windows a block takes, and how many the last one has.
    windows: usize,
    filled: usize,
    blocks: Vec<Block>,
}

/// Sums over the steps of some windows.
#[derive(Debug, Clone, Copy)]
struct Block {
    start: f64,
    end: f64,
    /// Spin angle at both ends [rad].
    spin: [f64; 2],
    steps: u64,
    free_steps: u64,
    touching: u64,
    changes: u64,
    /// Weighted sums of products of the basis functions, and of those with the force and of the force's squares.
    normal: [[f64; UNKNOWNS]; UNKNOWNS],
    right: [[f64; UNKNOWNS]; 3],
    squares: [f64; 3],
}

impl Chatter {
    /// For a stage that starts at `start` and lasts `duration` [s]; `sides`: of a ring mesh.
    pub fn new(sides: Option<usize>, start: f64, duration: f64) -> Chatter {
        Chatter { sides, start, unit: duration, windows: 1, filled: 0, blocks: Vec::new() }
    }

    /// Adds the steps of a window, or of a piece of one, that began at `start` with the rim's spin angle at `spin`
    /// [s, rad]. Within it the spin is taken as steady.
    pub fn add(&mut self, start: f64, end: f64, spin: [f64; 2], steps: &[StepContact]) {
        let sides = self.sides.unwrap_or(0) as f64;
        let mut block = Block::new(start, end, spin);
        let total: f64 = steps.iter().map(|s| s.dtm).sum();
        let mut passed = 0.0;
        for step in steps {
            // A force at t(n) acts over half of the steps beside it.
            let share = (passed + 0.5 * step.dtm) / total;
            passed += step.dtm;
            let time = (start + share * (end - start) - self.start) / self.unit;
            block.step(time, sides * (spin[0] + share * (spin[1] - spin[0])), step);
        }
        self.keep(block);
    }

    fn keep(&mut self, block: Block) {
        match self.blocks.last_mut() {
            Some(last) if self.filled < self.windows => last.merge(&block),
            _ => {
                self.blocks.push(block);
                self.filled = 0;
            }
        }
        self.filled += 1;
        if self.blocks.len() > MOST && self.filled == self.windows {
            let merged = |pair: &[Block]| {
                let mut first = pair[0];
                pair[1..].iter().for_each(|b| first.merge(b));
                first
            };
            let odd = self.blocks.len() % 2 == 1;
            self.blocks = self.blocks.chunks(2).map(merged).collect();
            self.filled = if odd { self.windows } else { 2 * self.windows };
            self.windows *= 2;
        }
    }

    /// Sum over the blocks of the last 30 % of what has run.
    fn tail(&self) -> Option<Block> {
        let (first, last) = (self.blocks.first()?, self.blocks.last()?);
        // With slack for the round-off of a block that ends where the tail begins.
        let tail = last.end - (0.3 - 1e-9) * (last.end - first.start);
        let mut blocks = self.blocks.iter().filter(|b| b.end > tail);
        let mut sum = *blocks.next()?;
        blocks.for_each(|b| sum.merge(b));
        Some(sum)
    }

    /// Mean spin over the last 30 % of what has run [rad/s].
    pub fn spin_rate(&self) -> Option<f64> {
        self.tail().map(|sum| (sum.spin[1] - sum.spin[0]) / (sum.end - sum.start))
    }

    /// The scatter over the last 30 % of what has run; none without steps there.
    pub fn noise(&self) -> Option<ContactNoise> {
        self.tail().filter(|sum| sum.steps > 0).map(|sum| sum.noise(self.sides))
    }
}

impl Block {
    fn new(start: f64, end: f64, spin: [f64; 2]) -> Block {
        Block {
            start,
            end,
            spin,
            steps: 0,
            free_steps: 0,
            touching: 0,
            changes: 0,
            normal: [[0.0; UNKNOWNS]; UNKNOWNS],
            right: [[0.0; UNKNOWNS]; 3],
            squares: [0.0; 3],
        }
    }

    fn step(&mut self, time: f64, phase: f64, step: &StepContact) {
        let basis = basis(time, phase);
        for i in 0..UNKNOWNS {
            let weighted = step.dtm * basis[i];
            for j in i..UNKNOWNS {
                self.normal[i][j] += weighted * basis[j];
            }
            for d in 0..3 {
                self.right[d][i] += weighted * step.force[d];
            }
        }
        for d in 0..3 {
            self.squares[d] += step.dtm * step.force[d] * step.force[d];
        }
        self.steps += 1;
        self.free_steps += u64::from(step.touching == 0);
        self.touching += u64::from(step.touching);
        self.changes += u64::from(step.changes);
    }

    /// Adds the block that comes next.
    fn merge(&mut self, next: &Block) {
        (self.end, self.spin[1]) = (next.end, next.spin[1]);
        self.steps += next.steps;
        self.free_steps += next.free_steps;
        self.touching += next.touching;
        self.changes += next.changes;
        let add = |to: &mut [f64], from: &[f64]| to.iter_mut().zip(from).for_each(|(a, b)| *a += b);
        add(self.normal.as_flattened_mut(), next.normal.as_flattened());
        add(self.right.as_flattened_mut(), next.right.as_flattened());
        add(&mut self.squares, &next.squares);
    }

    fn noise(&self, sides: Option<usize>) -> ContactNoise {
        let length = self.end - self.start;
        let turned = (self.spin[1] - self.spin[0]).abs() * sides.unwrap_or(0) as f64 / TAU;
        let unknowns = match self.steps {
            // Too few steps for more than their mean.
            n if n <= UNKNOWNS as u64 => 1,
            // Fewer than two periods are not told from a drift.
            _ if turned < 2.0 => 2,
            _ => UNKNOWNS,
        };
        let mut normal = self.normal;
        for i in 0..UNKNOWNS {
            for j in 0..i {
                normal[i][j] = normal[j][i];
            }
        }
        let weight = normal[0][0];
        let root = |variance: f64| variance.max(0.0).sqrt();
        let mean = [0, 1, 2].map(|d| self.right[d][0] / weight);
        let fit = [0, 1, 2].map(|d| solve(&normal, &self.right[d], unknowns));
        let of_squares = |d: usize| self.squares[d] / weight;
        let explained = |d: usize| (0..unknowns).map(|i| fit[d][i] * self.right[d][i]).sum::<f64>() / weight;
        let heard = |d: usize| fit[d][2..].iter().map(|c| 0.5 * c * c).sum::<f64>();
        ContactNoise {
            start: self.start,
            end: self.end,
            steps: self.steps,
            free_steps: self.free_steps,
            mean,
            std: [0, 1, 2].map(|d| root(of_squares(d) - mean[d] * mean[d])),
            tone: (unknowns > 2)
                .then(|| Tone { frequency: turned / length, std: [0, 1, 2].map(|d| root(heard(d))) }),
            remaining: [0, 1, 2].map(|d| root(of_squares(d) - explained(d))),
            changing_share: if self.touching > 0 { self.changes as f64 / self.touching as f64 } else { 0.0 },
            rounding: None,
        }
    }
}

fn basis(time: f64, phase: f64) -> [f64; UNKNOWNS] {
    let mut basis = [0.0; UNKNOWNS];
    (basis[0], basis[1]) = (1.0, time);
    let (sin, cos) = phase.sin_cos();
    let (mut c, mut s) = (1.0, 0.0);
    for h in 0..HARMONICS {
        (c, s) = (c * cos - s * sin, s * cos + c * sin);
        (basis[2 + 2 * h], basis[3 + 2 * h]) = (c, s);
    }
    basis
}

/// Gaussian elimination of the first `unknowns` equations; the matrix is symmetric and positive, so no pivot is sought.
fn solve(matrix: &[[f64; UNKNOWNS]; UNKNOWNS], right: &[f64; UNKNOWNS], unknowns: usize) -> [f64; UNKNOWNS] {
    let (mut a, mut x) = (*matrix, *right);
    for k in 0..unknowns {
        for i in k + 1..unknowns {
            let factor = a[i][k] / a[k][k];
            for j in k..unknowns {
                a[i][j] -= factor * a[k][j];
            }
            x[i] -= factor * x[k];
        }
    }
    for k in (0..unknowns).rev() {
        let known: f64 = (k + 1..unknowns).map(|j| a[k][j] * x[j]).sum();
        x[k] = (x[k] - known) / a[k][k];
    }
    x[unknowns..].fill(0.0);
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 1.3e-5;
    /// 44 elements at 70 rad/s: a tone of 490.2 Hz.
    const OMEGA: f64 = 70.0;

    /// Windows of 77 steps whose force along z at time t is `force`(t, step).
    fn filled(windows: usize, sides: Option<usize>, force: impl Fn(f64, usize) -> f64) -> Chatter {
        let length = 77.0 * DT;
        let mut chatter = Chatter::new(sides, 0.2, length * windows as f64);
        for w in 0..windows {
            let start = 0.2 + w as f64 * length;
            let step = |n: usize| StepContact {
                dtm: DT,
                force: [0.0, -2.0, force(start + (n as f64 + 0.5) * DT, 77 * w + n)],
                touching: 20,
                changes: u32::from(n.is_multiple_of(10)),
            };
            let steps: Vec<StepContact> = (0..77).map(step).collect();
            chatter.add(start, start + length, [OMEGA * start, OMEGA * (start + length)], &steps);
        }
        chatter
    }

    /// +1 or -1 without a pattern.
    fn sign(n: usize) -> f64 {
        if (n as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 63 == 0 { 1.0 } else { -1.0 }
    }

    fn near(what: &str, value: f64, expected: f64, tolerance: f64) {
        assert!((value - expected).abs() <= tolerance, "{what}: {value}, expected {expected}");
    }

    #[test]
    fn a_tone_is_told_from_noise_and_drift() {
        let tone = |t: f64| 30.0 * (44.0 * OMEGA * t + 0.3).sin() + 4.0 * (88.0 * OMEGA * t).cos();
        let force = |t: f64, n: usize| 300.0 + 50.0 * (t - 0.2) + tone(t) + 3.0 * sign(n);
        let noise = filled(100, Some(44), force).noise().unwrap();
        let heard = noise.tone.unwrap();
        near("frequency", heard.frequency, 44.0 * OMEGA / TAU, 1e-9);
        // 2,300 steps of noise of 3 N: each of the fit's coefficients is known to 3 sqrt(2/2300) = 0.09 N.
        near("tone", heard.std[2], (0.5 * (900.0 + 16.0_f64)).sqrt(), 0.2);
        near("rest", noise.remaining[2], 3.0, 0.05);
        near("side", noise.mean[1], -2.0, 1e-12);
        // The tail is windows 71 to 100, whose middle is at 85.5 of 100 windows; 22 periods less 0.72: 1 N.
        near("mean", noise.mean[2], 300.0 + 50.0 * 0.855 * 0.1, 1.0);
        assert_eq!(noise.steps, 30 * 77);
        near("changes", noise.changing_share, 8.0 / (77.0 * 20.0), 1e-12);
    }

    #[test]
    fn without_a_ring_the_tone_stays_in_the_rest() {
        let force = |t: f64, _| 300.0 + 30.0 * (44.0 * OMEGA * t).sin();
        let noise = filled(100, None, force).noise().unwrap();
        assert_eq!(noise.tone, None);
        near("rest", noise.remaining[2], 30.0 / 2.0_f64.sqrt(), 0.5);
        // A tone of another frequency is none of the mesh's: of 40 elements it would be 445.6 Hz. 45 Hz beside it, over
        // 30 ms, a sinusoid leaks sin(4.2)/4.2 = 0.21 of its amplitude.
        let other = filled(100, Some(40), force).noise().unwrap();
        assert!(other.remaining[2] > 20.0 && other.tone.unwrap().std[2] < 0.22 * 21.2, "{other:?}");
    }

    #[test]
    fn long_stages_keep_few_blocks_and_the_same_answer() {
        let force = |t: f64, n: usize| 300.0 + 20.0 * (44.0 * OMEGA * t).sin() + sign(n);
        let chatter = filled(5000, Some(44), force);
        assert!(chatter.blocks.len() <= MOST, "{} blocks", chatter.blocks.len());
        let noise = chatter.noise().unwrap();
        near("rest", noise.remaining[2], 1.0, 0.01);
        // 5000 windows are kept by sixteens: the tail is 30 % to 16/5000.
        near("tail", noise.end - noise.start, 0.3 * 5000.0 * 77.0 * DT, 16.0 * 77.0 * DT);
    }

    #[test]
    fn a_window_of_a_few_steps_has_a_mean_and_no_more() {
        let mut chatter = Chatter::new(Some(44), 0.0, 1.0);
        assert_eq!(chatter.noise(), None);
        let step = StepContact { dtm: DT, force: [0.0, 0.0, 5.0], touching: 1, changes: 1 };
        chatter.add(0.0, DT, [0.0, 1.0], &[step]);
        let noise = chatter.noise().unwrap();
        near("mean", noise.mean[2], 5.0, 1e-12);
        // The variance of one step is the round-off of 25: its root is up to 1e-7.
        near("rest", noise.remaining[2].max(noise.std[2]), 0.0, 1e-7);
    }
}

//! Heights on a regular grid, and the surface through them.

use super::Texture;
use super::nearest::Smooth;

/// What lies beyond the last samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Border {
    /// The first samples again, one spacing after the last.
    Periodic,
    /// The height of the last sample.
    Keep,
    /// Nothing: what comes there has no road below it.
    Nothing,
}

/// Heights on a regular grid, bicubic between the samples (Catmull and Rom 1974): through every sample, with slopes that are central
/// differences, so that the surface has no kinks. NaN: missing.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    /// Along u, and along v.
    size: [usize; 2],
    /// Distance of neighbours along u and v [m].
    spacing: [f64; 2],
    /// Rows of u, one after the other along v [m].
    heights: Vec<f64>,
    border: Border,
    top: f64,
    relief: f64,
    texture: Texture,
}

impl Samples {
    /// # Panics
    /// If there are not `size[0]` times `size[1]` heights.
    pub fn new(size: [usize; 2], spacing: [f64; 2], heights: Vec<f64>, border: Border) -> Samples {
        assert_eq!(heights.len(), size[0] * size[1]);
        let nothing = Texture { shortest: 0.0, steepest: 0.0, sharpest: f64::INFINITY };
        let mut samples = Samples { size, spacing, heights, border, top: 0.0, relief: 0.0, texture: nothing };
        samples.top = samples.highest();
        samples.relief = samples.top - samples.heights.iter().copied().fold(f64::INFINITY, f64::min);
        samples.texture = samples.measured();
        samples
    }

    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    pub fn spacing(&self) -> [f64; 2] {
        self.spacing
    }

    /// Nothing of the surface is higher [m].
    pub fn top(&self) -> f64 {
        self.top
    }

    /// How far the lowest sample is below the top [m].
    pub fn relief(&self) -> f64 {
        self.relief
    }

    pub fn texture(&self) -> Texture {
        self.texture
    }

    pub fn border(&self) -> Border {
        self.border
    }

    pub fn comes_again(&self) -> bool {
        self.border == Border::Periodic
    }

    pub fn heights(&self) -> &[f64] {
        &self.heights
    }

    /// The heights with a deep hole where one is missing: for shaders, which do not know NaN.
    pub fn without_holes(&self) -> Vec<f64> {
        let lowest = self.heights.iter().copied().fold(f64::INFINITY, f64::min);
        let depth = lowest - (self.top - lowest) - self.spacing[0];
        self.heights.iter().map(|h| if h.is_nan() { depth } else { *h }).collect()
    }

    /// Root of the mean square of the heights about their mean [m], and of the slope.
    pub fn roughness(&self) -> [f64; 2] {
        let count = self.heights.len() as f64;
        let mean = self.heights.iter().sum::<f64>() / count;
        let square = self.heights.iter().map(|h| (h - mean).powi(2)).sum::<f64>() / count;
        let mut slopes = 0.0;
        // The mean over a cell's middle and corners is that of the cell within a per cent.
        for (k, share) in [(0.0, 0.5), (0.5, 0.5)] {
            for j in 0..self.size[1] {
                for i in 0..self.size[0] {
                    let [u, v] = [(i as f64 + k) * self.spacing[0], (j as f64 + k) * self.spacing[1]];
                    let [_, p, q] = self.height(u, v);
                    slopes += share * (p * p + q * q) / count;
                }
            }
        }
        [square.sqrt(), slopes.sqrt()]
    }

    /// The sample number i, j, wherever that is.
    #[inline(always)]
    fn at(&self, i: i64, j: i64) -> f64 {
        let [columns, rows] = self.size.map(|n| n as i64);
        let (i, j) = match self.border {
            Border::Periodic => (i.rem_euclid(columns), j.rem_euclid(rows)),
            Border::Keep | Border::Nothing => (i.clamp(0, columns - 1), j.clamp(0, rows - 1)),
        };
        self.heights[(j * columns + i) as usize]
    }

    /// The sixteen samples round cell i, j.
    fn around(&self, i: i64, j: i64) -> [[f64; 4]; 4] {
        std::array::from_fn(|b| std::array::from_fn(|a| self.at(i + a as i64 - 1, j + b as i64 - 1)))
    }

    /// By cells: the weights of four samples add up to 1 and to no more than 5/4 in size, along both directions to 25/16. So a cell's
    /// surface leaves the range of its samples by 9/32 of the range at most.
    fn highest(&self) -> f64 {
        const BEYOND: f64 = 9.0 / 32.0;
        let mut top = f64::NEG_INFINITY;
        self.every_cell(|samples| {
            let [low, high] = range(samples);
            top = top.max(high + BEYOND * (high - low));
        });
        top
    }

    fn every_cell(&self, mut visit: impl FnMut(&[[f64; 4]; 4])) {
        for j in -1..self.size[1] as i64 {
            for i in -1..self.size[0] as i64 {
                visit(&self.around(i, j));
            }
        }
    }

    /// Steepest and sharpest at the samples, by central differences.
    fn measured(&self) -> Texture {
        let [du, dv] = self.spacing;
        let (mut steepest, mut bend) = (0.0f64, 0.0f64);
        for j in 0..self.size[1] as i64 {
            for i in 0..self.size[0] as i64 {
                let [west, here, east] = [-1, 0, 1].map(|k| self.at(i + k, j));
                let [south, north] = [-1, 1].map(|k| self.at(i, j + k));
                steepest = steepest.max(((east - west) / (2.0 * du)).hypot((north - south) / (2.0 * dv)));
                bend = bend.max(((east - 2.0 * here + west) / (du * du)).abs());
                bend = bend.max(((north - 2.0 * here + south) / (dv * dv)).abs());
            }
        }
        // Two spacings are the shortest wave that samples can hold.
        Texture { shortest: 2.0 * du.min(dv), steepest, sharpest: 1.0 / bend }
    }

    pub fn description(&self) -> String {
        let ([columns, rows], [du, dv]) = (self.size, self.spacing);
        let border = match self.border {
            Border::Periodic => "periodic",
            Border::Keep => "level beyond its last samples",
            Border::Nothing => "with nothing beyond",
        };
        format!("{columns} x {rows} samples, {du} m and {dv} m apart, {border}")
    }
}

fn range(samples: &[[f64; 4]; 4]) -> [f64; 2] {
    [f64::min, f64::max].map(|pick| samples.iter().flatten().copied().reduce(pick).unwrap_or(0.0))
}

/// Value and slope at t = 0..1 between the middle two of four samples; level samples give their value to the last digit.
#[inline(always)]
fn cubic(p: [f64; 4], t: f64) -> [f64; 2] {
    let [before, here, after] = [p[1] - p[0], p[2] - p[1], p[3] - p[2]];
    let (start, end) = (0.5 * (before + here), 0.5 * (here + after));
    let (b, c) = (3.0 * here - 2.0 * start - end, start + end - 2.0 * here);
    [p[1] + t * (start + t * (b + t * c)), start + t * (2.0 * b + 3.0 * t * c)]
}

impl Smooth for Samples {
    fn height(&self, u: f64, v: f64) -> [f64; 3] {
        let [a, b] = [u / self.spacing[0], v / self.spacing[1]];
        let within = |x: f64, n: usize| (0.0..=(n - 1) as f64).contains(&x);
        if self.border == Border::Nothing && !(within(a, self.size[0]) && within(b, self.size[1])) {
            return [f64::NAN; 3];
        }
        let (i, j) = (a.floor(), b.floor());
        let rows = self.around(i as i64, j as i64).map(|row| cubic(row, a - i));
        let [height, across] = cubic(rows.map(|r| r[0]), b - j);
        let [along, _] = cubic(rows.map(|r| r[1]), b - j);
        [height, along / self.spacing[0], across / self.spacing[1]]
    }
}

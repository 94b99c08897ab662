//! Random numbers, small linear algebra and comparisons.

use hexroll::model::mesh::Mesh;

/// Random numbers that are the same everywhere (xorshift).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Random {
        Random(0x9e37_79b9_7f4a_7c15 ^ (seed + 1).wrapping_mul(0xbf58_476d_1ce4_e5b9))
    }

    /// The sequence that goes on from a state other than 0.
    pub fn from_state(state: u64) -> Random {
        Random(state)
    }

    /// Uniform in -1..1.
    pub fn signed(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// Components uniform in -1..1.
    pub fn vector(&mut self) -> [f64; 3] {
        std::array::from_fn(|_| self.signed())
    }

    /// Components uniform in -size..size.
    pub fn within(&mut self, size: f64) -> [f64; 3] {
        self.vector().map(|c| size * c)
    }

    /// Identity plus up to `size` in every entry, columns.
    pub fn near_identity(&mut self, size: f64) -> [[f64; 3]; 3] {
        std::array::from_fn(|c| {
            std::array::from_fn(|r| size * self.signed() + if r == c { 1.0 } else { 0.0 })
        })
    }
}

/// A x for a matrix of columns.
pub fn times(a: &[[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|c| a[c][i] * x[c]).sum())
}

/// Largest absolute entry.
pub fn largest<'a>(vectors: impl IntoIterator<Item = &'a [f64; 3]>) -> f64 {
    vectors.into_iter().flatten().fold(0.0, |m, v| m.max(v.abs()))
}

/// |a - b| / |b| over all components, in the L2 norm.
///
/// # Panics
/// If there are not as many of both.
pub fn relative(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    assert_eq!(a.len(), b.len());
    let square = |v: f64| v * v;
    let difference: f64 = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| square(a - b)).sum();
    (difference / b.iter().flatten().map(|b| square(*b)).sum::<f64>()).sqrt()
}

/// log2(coarse / fine): the order of an error that a halved step leaves.
pub fn order(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).log2()
}

/// Moves every node by up to `share` of an edge `edge`, so that no element is a parallelepiped.
pub fn distort(mesh: &mut Mesh, edge: f64, share: f64) {
    let mut random = Random::new(7);
    for x in &mut mesh.nodes {
        let by = random.vector();
        (0..3).for_each(|d| x[d] += share * edge * by[d]);
    }
}

/// Asserts |value - expected| <= tolerance |expected|.
///
/// # Panics
/// If it is not, or for NaN.
#[track_caller]
pub fn close(what: &str, value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value - expected).abs() <= tolerance * expected.abs(),
        "{what}: {value:e}, expected {expected:e} within {tolerance:e} (off by {:e})",
        value / expected - 1.0
    );
}

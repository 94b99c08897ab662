//! Largest eigenvalue of a symmetric operator by Lanczos iteration, with a residual bound.
//!
//! A Rayleigh quotient is a lower bound; an eigenvalue lies within the residual of it, so the sum is what a stable
//! step may be computed from.

use crate::error::Result;

/// The largest eigenvalue found.
#[derive(Debug, Clone)]
pub struct Top {
    /// Ritz value and Ritz value plus residual norm.
    pub value: f64,
    pub upper: f64,
    /// Ritz vector, of unit length in the inner product.
    pub vector: Vec<f64>,
    pub iterations: usize,
}

/// Vectors of the basis that are kept, of `length` numbers each: all of a small body, whose vectors take no memory to speak
/// of, else a few. What is not kept is computed again once, for the Ritz vector.
pub fn kept(length: usize) -> usize {
    const SMALL: usize = 4 << 20; // bytes
    const LEAST: usize = 16;
    (SMALL / (size_of::<f64>() * length.max(1))).max(LEAST)
}

/// Largest eigenvalue of `apply`, symmetric in the inner product weighted by `weight`, from `start`, until the
/// residual is below `tolerance` of the value or `most` iterations are done.
pub fn largest(
    apply: impl FnMut(&[f64]) -> Result<Vec<f64>>,
    weight: &[f64],
    start: &[f64],
    tolerance: f64,
    most: usize,
) -> Result<Top> {
    largest_keeping(kept(start.len()), apply, weight, start, tolerance, most)
}

/// The same with the first `kept` vectors of the basis (two or more) and the last two in memory. The bits do not depend on it, as
/// long as `apply` gives the same ones again.
fn largest_keeping(
    kept: usize,
    mut apply: impl FnMut(&[f64]) -> Result<Vec<f64>>,
    weight: &[f64],
    start: &[f64],
    tolerance: f64,
    most: usize,
) -> Result<Top> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).zip(weight).map(|((a, b), w)| a * b * w).sum::<f64>();
    let unit = |v: &[f64]| {
        let length = dot(v, v).sqrt();
        v.iter().map(|v| v / length).collect::<Vec<f64>>()
    };
    let mut basis = vec![unit(start)];
    let (mut alphas, mut betas): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    loop {
        let q = basis.last().expect("the basis starts with one vector");
        let mut r = apply(q)?;
        let alpha = dot(&r, q);
        for (r, q) in r.iter_mut().zip(q) {
            *r -= alpha * q;
        }
        if let (Some(beta), Some(before)) = (betas.last(), basis.iter().rev().nth(1)) {
            for (r, b) in r.iter_mut().zip(before) {
                *r -= beta * b;
            }
        }
        alphas.push(alpha);
        let beta = dot(&r, &r).sqrt();
        let (value, coefficients) = top_of_tridiagonal(&alphas, &betas);
        let residual = beta * coefficients.last().expect("as many as alphas").abs();
        if residual <= tolerance * value || alphas.len() >= most || beta <= 1e-14 * value.abs() {
            drop(r);
            let vector = combined(basis, kept, &coefficients, &alphas, &betas, apply)?;
            let iterations = alphas.len();
            return Ok(Top { value, upper: value + residual, vector: unit(&vector), iterations });
        }
        betas.push(beta);
        r.iter_mut().for_each(|r| *r /= beta);
        if basis.len() >= kept + 2 {
            basis.remove(kept);
        }
        basis.push(r);
    }
}

/// The sum of `coefficients` times the vectors of the basis, of which the first `kept` are there, and the last two; those between
/// are made again, by the recurrence that made them.
fn combined(
    mut basis: Vec<Vec<f64>>,
    kept: usize,
    coefficients: &[f64],
    alphas: &[f64],
    betas: &[f64],
    mut apply: impl FnMut(&[f64]) -> Result<Vec<f64>>,
) -> Result<Vec<f64>> {
    let mut vector = vec![0.0; basis[0].len()];
    let mut add = |c: f64, q: &[f64]| vector.iter_mut().zip(q).for_each(|(v, q)| *v += c * q);
    if coefficients.len() > basis.len() {
        basis.truncate(kept);
    }
    for (c, q) in coefficients.iter().zip(&basis) {
        add(*c, q);
    }
    for k in basis.len()..coefficients.len() {
        let [before, q] = basis.last_chunk::<2>().expect("two vectors are kept");
        let mut next = apply(q)?;
        for ((r, q), b) in next.iter_mut().zip(q).zip(before) {
            *r -= alphas[k - 1] * q;
            *r -= betas[k - 2] * b;
            *r /= betas[k - 1];
        }
        add(coefficients[k], &next);
        // Those that have been added are not needed but for the recurrence.
        basis.drain(..basis.len() - 1);
        basis.push(next);
    }
    Ok(vector)
}

/// Largest eigenvalue of a symmetric tridiagonal matrix, by bisection on its Sturm count, and its unit eigenvector,
/// by inverse iteration.
fn top_of_tridiagonal(diagonal: &[f64], off: &[f64]) -> (f64, Vec<f64>) {
    let n = diagonal.len();
    let off = |i: usize| if i < n - 1 { off[i].abs() } else { 0.0 };
    let radius = |i: usize| if i > 0 { off(i - 1) } else { 0.0 } + off(i);
    let bound = |sign: f64| (0..n).map(|i| diagonal[i] * sign + radius(i)).fold(f64::NEG_INFINITY, f64::max);
    let (mut low, mut high) = (-bound(-1.0), bound(1.0));
    let scale = high.abs().max(low.abs()).max(f64::MIN_POSITIVE);
    // All eigenvalues below x: every pivot of T - x I is negative.
    let all_below = |x: f64| {
        let mut pivot = -1.0;
        (0..n).all(|i| {
            let coupling = if i > 0 { off(i - 1) * off(i - 1) / pivot } else { 0.0 };
            pivot = diagonal[i] - x - coupling;
            pivot < 0.0
        })
    };
    while high - low > 4.0 * f64::EPSILON * scale {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if all_below(middle) { high = middle } else { low = middle }
    }
    // A shift just above the eigenvalue keeps every pivot negative: no exchanges needed.
    let shift = high + 1e-13 * scale;
    let mut vector = vec![1.0; n];
    for _ in 0..3 {
        let mut pivots = vec![0.0; n];
        for i in 0..n {
            let ratio = if i > 0 { off(i - 1) / pivots[i - 1] } else { 0.0 };
            pivots[i] = diagonal[i] - shift - if i > 0 { ratio * off(i - 1) } else { 0.0 };
            if i > 0 {
                vector[i] -= ratio * vector[i - 1];
            }
        }
        for i in (0..n).rev() {
            let above = if i + 1 < n { off(i) * vector[i + 1] } else { 0.0 };
            vector[i] = (vector[i] - above) / pivots[i];
        }
        let length = vector.iter().map(|v| v * v).sum::<f64>().sqrt();
        vector.iter_mut().for_each(|v| *v /= length);
    }
    (high, vector)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Second differences on n points: eigenvalues 2 - 2 cos(k pi / (n + 1)).
    #[test]
    fn the_top_of_a_chain_is_its_closed_form() {
        let n = 60;
        let chain = |v: &[f64]| -> Result<Vec<f64>> {
            let at = |i: isize| if i < 0 || i >= n as isize { 0.0 } else { v[i as usize] };
            Ok((0..n as isize).map(|i| 2.0 * at(i) - at(i - 1) - at(i + 1)).collect())
        };
        let start: Vec<f64> = (0..n).map(|i| ((i * 7 + 3) % 11) as f64 - 5.2).collect();
        let top = largest(chain, &vec![1.0; n], &start, 1e-10, 60).unwrap();
        let exact = 2.0 - 2.0 * (n as f64 * std::f64::consts::PI / (n as f64 + 1.0)).cos();
        assert!((top.value - exact).abs() < 1e-9, "{} {exact}", top.value);
        assert!(top.upper >= exact - 1e-12);
        // What is not kept comes again to the bit.
        for kept in [2, 5, 57, 58, 59] {
            let again = largest_keeping(kept, chain, &vec![1.0; n], &start, 1e-10, 60).unwrap();
            assert_eq!((again.value, again.vector), (top.value, top.vector.clone()), "{kept} kept");
            assert_eq!(again.iterations, top.iterations);
        }
        assert!(top.iterations > 50);
    }
}

//! Fourier sums of any length, with the same bits on every machine: the mathematical functions are the crate's own, and nothing is
//! vectorised by hand. A library that chooses its instructions by the machine would not promise that.

use std::f64::consts::TAU;

/// A complex number.
pub type Complex = [f64; 2];

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// e^(i angle).
pub fn turn(angle: f64) -> Complex {
    let (sin, cos) = libm::sincos(angle);
    [cos, sin]
}

/// x_j = sum over k of c_k e^(2 pi i j k / n): Cooley and Tukey (1965), by the factors of n.
pub fn sum(c: &[Complex]) -> Vec<Complex> {
    let n = c.len();
    let roots: Vec<Complex> = (0..n).map(|k| turn(TAU * k as f64 / n as f64)).collect();
    split(c, 0, 1, n, &roots)
}

/// The sum over every `stride`-th of the coefficients from `start` on, `n` of them.
fn split(c: &[Complex], start: usize, stride: usize, n: usize, roots: &[Complex]) -> Vec<Complex> {
    if n == 1 {
        return vec![c[start]];
    }
    let factor = (2..=n).find(|f| n.is_multiple_of(*f)).expect("n is one of them");
    let parts: Vec<Vec<Complex>> =
        (0..factor).map(|k| split(c, start + k * stride, stride * factor, n / factor, roots)).collect();
    let one = |j: usize| {
        let mut x = [0.0; 2];
        for (k, part) in parts.iter().enumerate() {
            let root = roots[(j * k % n) * stride];
            let term = times(part[j % (n / factor)], root);
            x = [x[0] + term[0], x[1] + term[1]];
        }
        x
    };
    (0..n).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sum_is_its_definition() {
        for n in [1usize, 2, 12, 35, 64, 97] {
            let c: Vec<Complex> = (0..n).map(|k| turn(1.7 * (k * k) as f64)).collect();
            let x = sum(&c);
            for j in 0..n {
                let mut direct = [0.0; 2];
                for (k, c) in c.iter().enumerate() {
                    let term = times(*c, turn(TAU * ((j * k) % n) as f64 / n as f64));
                    direct = [direct[0] + term[0], direct[1] + term[1]];
                }
                let off = (x[j][0] - direct[0]).hypot(x[j][1] - direct[1]);
                assert!(off < 1e-13 * n as f64, "{n} {j}: {off}");
            }
        }
    }
}

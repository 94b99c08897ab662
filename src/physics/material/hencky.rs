//! Powers of the principal stretches as functions of invariants, without principal directions and without a special case where
//! stretches coincide.
//!
//! X is the isochoric Hencky strain, the logarithm of the right stretch tensor less its mean. Its trace is zero, so that
//!
//! ```text
//! X^3 = P X + Q I,   P = tr X^2 / 2,  Q = det X,
//! exp(s X) = (1 + d) I + e1 X + e2 X^2,   tr exp(s X) - 3 = 3 d + 2 P e2
//! ```
//!
//! with d, e1, e2 entire functions of P and Q: the series of the exponential in these three numbers, halved and squared, knows
//! no eigenvalues. Sums of powers l_1^s + l_2^s + l_3^s = tr exp(s X) have the slopes s e1 and s e2 along P and Q, and the
//! invariants of C are such sums, with s = 2 and s = -2 (det exp X = 1): so slopes along P and Q become those along I1 and I2 by
//! two equations, of a determinant that is never zero.
//!
//! P and Q of given invariants begin with the principal stretches, which lose half of the digits, or two thirds, where they
//! coincide; a step of Newton's method in P and Q, where nothing is singular, gives back what was lost. For numbers that carry
//! derivatives this step is where the derivative comes from.

use crate::scalar::Scalar;

/// J^-1/3, and J^-2/3 I1 - 3 and J^-4/3 I2 - 3.
#[inline(always)]
pub(super) fn isochoric<S: Scalar>(i1: S, i2: S, j: S) -> (S, [S; 2]) {
    let (r, three) = (j.recip_cbrt(), S::from_f64(3.0));
    let r2 = r * r;
    (r, [r2.mul_sub(i1, three), (r2 * r2).mul_sub(i2, three)])
}

/// exp(s X) - I = d I + x X + square X^2.
#[derive(Debug, Clone, Copy)]
struct Power<S> {
    d: S,
    x: S,
    square: S,
}

/// A symmetric matrix X without trace, by what its powers depend on.
#[derive(Debug, Clone, Copy)]
struct Deviator<S> {
    /// P = tr X^2 / 2
    p: S,
    /// Q = det X
    q: S,
}

/// Most terms of a sum of powers.
const MOST: usize = 3;

/// A sum of weight / s times (tr exp(s X) - 3).
#[derive(Debug, Clone, Copy)]
pub(super) struct Sum {
    /// s and weight of each term, behind the two powers that invariants are.
    powers: [(f64, f64); MOST + 2],
    count: usize,
}

impl Sum {
    /// Of these terms (s, weight); those without a weight are left out.
    #[inline(always)]
    pub fn new(terms: [(f64, f64); MOST]) -> Self {
        let mut sum = Sum { powers: [(2.0, 0.0), (-2.0, 0.0), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0)], count: 2 };
        for (s, weight) in terms {
            if weight != 0.0 {
                sum.powers[sum.count] = (s, weight);
                sum.count += 1;
            }
        }
        sum
    }

    /// The sum where tr exp(2 X) - 3 and tr exp(-2 X) - 3 are these, and its slopes along them.
    ///
    /// Two rounds: a step of Newton's method from the guess of X, then the terms. They share one loop over powers, whose code is
    /// long: copies of it in every kernel would take long to compile.
    #[inline(always)]
    pub fn at<S: Scalar>(&self, e: [S; 2]) -> (S, [S; 2]) {
        let mut x = guess(e[0].fixed(), e[1].fixed());
        x = Deviator { p: x.p.fixed(), q: x.q.fixed() };
        let (zero, mut sum, mut by) = (S::zero(), S::zero(), [S::zero(); 2]);
        let mut invariants = [Power { d: zero, x: zero, square: zero }; 2];
        for count in [2, self.count] {
            for k in 0..count {
                let (s, weight) = self.powers[k];
                let power = x.power(s);
                match k {
                    0 => invariants[0] = power,
                    1 => invariants[1] = power,
                    _ => {
                        sum += S::from_f64(weight / s) * x.trace(&power);
                        by[0] += S::from_f64(weight) * power.x;
                        by[1] += S::from_f64(weight) * power.square;
                    }
                }
            }
            if count == 2 {
                x = x.nearer(&invariants, e);
            }
        }
        (sum, by_invariants(&invariants, by))
    }
}

/// Slopes along tr exp(2 X) and tr exp(-2 X), whose powers these are, of what has the slopes `by` along P and Q:
/// 2 up w1 - 2 down w2 = by.
#[inline(always)]
fn by_invariants<S: Scalar>([up, down]: &[Power<S>; 2], by: [S; 2]) -> [S; 2] {
    let scale = S::from_f64(0.5) / determinant(up, down);
    [scale * down.x.mul_sub(by[1], down.square * by[0]), scale * up.x.mul_sub(by[1], up.square * by[0])]
}

impl<S: Scalar> Deviator<S> {
    /// A step of Newton's method towards the X of tr exp(2 X) - 3 and tr exp(-2 X) - 3, from their powers at this one.
    #[inline(always)]
    fn nearer(&self, [up, down]: &[Power<S>; 2], e: [S; 2]) -> Self {
        let (off1, off2) = (self.trace(up) - e[0], self.trace(down) - e[1]);
        let scale = S::from_f64(0.5) / determinant(up, down);
        Deviator {
            p: self.p + scale * down.square.mul_add(off1, up.square * off2),
            q: self.q - scale * down.x.mul_add(off1, up.x * off2),
        }
    }

    /// exp(s X) - I: the series up to X^13 of X over a power of two that makes |s| a quarter or less (what is left out is below
    /// 1e-15 of the whole up to stretches of 7), then squared as often as it was halved.
    #[inline(always)]
    fn power(&self, s: f64) -> Power<S> {
        let (mut z, mut halvings) = (s, 0);
        while z.abs() > 0.25 {
            z *= 0.5;
            halvings += 1;
        }
        let number = S::from_f64;
        // Those of z X.
        let (p, q) = (self.p * number(z * z), self.q * number(z * z * z));
        let (mut d, mut x, mut square) = (S::one(), number(1.0 / 12.0), number(1.0 / 156.0));
        for n in [11.0, 10.0, 9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0] {
            let part = number(1.0 / n);
            (d, x, square) = (square * q * part, square.mul_add(p, d) * part, x * part);
            if n > 1.0 {
                d += S::one();
            }
        }
        for _ in 0..halvings {
            let two = S::from_f64(2.0);
            let twice = two * (S::one() + d);
            let (cross, high) = (two * x * square, square * square);
            (d, x, square) = (
                d.mul_add(d + two, cross * q),
                twice.mul_add(x, cross.mul_add(p, high * q)),
                twice.mul_add(square, high.mul_add(p, x * x)),
            );
        }
        Power { d, x: x * number(z), square: square * number(z * z) }
    }

    /// tr exp(s X) - 3.
    #[inline(always)]
    fn trace(&self, power: &Power<S>) -> S {
        let twice = self.p * power.square;
        power.d.mul_add(S::from_f64(3.0), twice + twice)
    }
}

/// -8 at rest.
#[inline(always)]
fn determinant<S: Scalar>(up: &Power<S>, down: &Power<S>) -> S {
    up.square.mul_sub(down.x, up.x * down.square)
}

#[inline(always)]
fn max<S: Scalar>(a: S, b: S) -> S {
    -(-a).min(-b)
}

/// P and Q of X up to what roots lose.
///
/// Where the largest stretch lies apart from the other two, by their logarithms, I1 is the larger invariant; else X is turned to
/// -X, which exchanges the invariants and the sign of Q. The largest c = l^2 is then the largest root of
/// c^3 - I1 c^2 + I2 c - 1, by t = cos(arccos(w)/3) with 0 <= w <= 1: a simple root of 4 t^3 - 3 t = w. The other two follow from
/// their product 1/c and their sum.
#[inline(always)]
fn guess<S: Scalar>(e1: S, e2: S) -> Deviator<S> {
    let number = S::from_f64;
    let (one, two, half) = (S::one(), number(2.0), number(0.5));
    let (a, b) = (max(e1, e2), e1.min(e2));
    let apart = a - b;
    // 1 or -1; 0 where X has no sign, so that Q is 0.
    let sign = (e1 - e2) / max(apart, number(1e-30));
    // I1^2 - 3 I2 and twice the cube of I1 - ..., of I1 = 3 + a and I2 = 3 + b: without the threes that cancel.
    let square = max(number(6.0) * a + (a * a - number(3.0) * b), number(1e-20));
    let root = square.sqrt();
    let cubic = number(27.0) * apart + a * (number(18.0) * a + number(2.0) * a * a - number(9.0) * b);
    let w = max(S::zero(), one.min(cubic / (two * square * root)));
    let mut t = w.mul_add(w.mul_add(number(-0.0327), number(1.0 / 6.0)), number(0.866));
    for _ in 0..3 {
        let (tt, four, three) = (t * t, number(4.0), number(3.0));
        t = t - (t * four.mul_sub(tt, three) - w) / number(12.0).mul_sub(tt, three);
    }
    let c = one + number(1.0 / 3.0) * (a + two * root * t);
    let p = one / c;
    // Half of the others' sum over the root of their product: the hyperbolic cosine of the difference of their logarithms.
    let cosh = half * (number(3.0) + b - p) * p.sqrt();
    let sinh = max(cosh.mul_sub(cosh, one), S::zero()).sqrt();
    let (x, y) = (half * rough_logarithm(c), half * rough_logarithm(cosh + sinh));
    let (xx, yy) = (x * x, y * y);
    Deviator { p: number(0.75).mul_add(xx, yy), q: sign * x * number(0.25).mul_sub(xx, yy) }
}

/// ln c for c > 0: -27 times the logarithm of c^(-1/27), by five terms of its series. Up to c = 100 within 1e-12.
#[inline(always)]
fn rough_logarithm<S: Scalar>(c: S) -> S {
    let (number, one) = (S::from_f64, S::one());
    let r = c.recip_cbrt().recip_cbrt().recip_cbrt();
    let z = (r - one) / (r + one);
    let zz = z * z;
    let high = zz.mul_add(number(1.0 / 9.0), number(1.0 / 7.0)).mul_add(zz, number(1.0 / 5.0));
    number(-54.0) * z * high.mul_add(zz, number(1.0 / 3.0)).mul_add(zz, one)
}

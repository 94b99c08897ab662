//! What the formulations share: gradients at the 2x2x2 Gauss points by sum factorisation, invariants and stress at a
//! point, and the reference geometry of a shape class.
//!
//! dx/dxi depends on (eta, zeta) only: at the four Gauss lines it is a bilinear interpolation of the four edge
//! differences along xi. The same (symmetric) interpolation takes force columns back to the edges.
//!
//! Corner numbering of an element (xi, eta, zeta = -1 or +1):
//!
//! ```text
//!        7--------6        corner a: xi   = + for 1 2 5 6
//!       /|       /|                  eta  = + for 2 3 6 7
//!      4--------5 |                  zeta = + for 4 5 6 7
//!      | 3------|-2
//!      |/       |/         zeta eta
//!      0--------1             |/_ xi
//! ```

use super::Lumping;
use crate::lanes::Lanes;
use crate::material::{Derivatives, Hyperelastic};
use crate::scalar::Scalar;
pub use crate::tensor::gram;
use crate::tensor::{
    Mat3, Metric, Sym3, Vec3, add, axpy, cofactor, combined, cross, det, dot, neg, scale, sub,
};
use std::ops::Range;

/// Corners of the six faces, counter-clockwise seen from outside.
pub const FACES: [[usize; 4]; 6] =
    [[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1], [4, 5, 6, 7]];

/// Corners of the faces xi = -1 and xi = +1, so that entry k of one meets entry k of the other in a neighbour.
pub const BACK: [usize; 4] = [0, 3, 4, 7];
pub const FRONT: [usize; 4] = [1, 2, 5, 6];

/// Signs of (xi, eta, zeta) at the eight corners.
pub const SIGNS: [[f64; 3]; 8] = [
    [-1., -1., -1.],
    [1., -1., -1.],
    [1., 1., -1.],
    [-1., 1., -1.],
    [-1., -1., 1.],
    [1., -1., 1.],
    [1., 1., 1.],
    [-1., 1., 1.],
];

/// One vector a corner.
pub type Corners<S> = [Vec3<S>; 8];

/// Edges (from, to) along each direction d; the edge index is the sign bits of the other two directions,
/// lower direction first.
pub const EDGES: [[(usize, usize); 4]; 3] =
    [[(0, 1), (3, 2), (4, 5), (7, 6)], [(0, 3), (1, 2), (4, 7), (5, 6)], [(0, 4), (1, 5), (3, 7), (2, 6)]];

/// See [`Class::extruded`]; of elements that are not extruded, parts of what they have.
fn extruded(X: &Corners<f64>, gradient: &Corners<f64>) -> [f64; 9] {
    // A field's share of a pattern: products of the signs of xi, eta, zeta.
    let share = |of: &Corners<f64>, along: [bool; 3]| {
        let sign = |a: usize| (0..3).filter(|&d| along[d]).map(|d| SIGNS[a][d]).product::<f64>();
        (0..8).fold([0.0; 3], |sum, a| axpy(of[a], 0.125 * sign(a), sum))
    };
    let unit = |v: Vec3<f64>| scale(v, 1.0 / dot(v, v).sqrt());
    let (xi, eta, zeta) = ([true, false, false], [false, true, false], [false, false, true]);
    let e2 = unit(share(X, eta));
    let side = share(X, xi);
    let e1 = unit(axpy(e2, -dot(side, e2), side));
    let e3 = cross(e1, e2);
    let (b_xi, b_zeta) = (share(gradient, xi), share(gradient, zeta));
    let axial = |along| dot(share(gradient, along), e2);
    let bent = scale(share(X, [true, false, true]), 8.0);
    [
        dot(b_xi, e1),
        dot(b_xi, e3),
        dot(b_zeta, e1),
        dot(b_zeta, e3),
        axial(eta),
        axial([true, true, false]),
        axial([false, true, true]),
        dot(bent, e1),
        dot(bent, e3),
    ]
}

/// Hourglass patterns Gamma_h: eta zeta, xi zeta, xi eta, xi eta zeta at the corners.
pub const HOURGLASS: [[f64; 8]; 4] = [
    [1., 1., -1., -1., -1., -1., 1., 1.],
    [1., -1., -1., 1., -1., 1., 1., -1.],
    [1., -1., 1., -1., 1., -1., 1., -1.],
    [-1., 1., -1., 1., 1., -1., 1., -1.],
];

/// Gauss abscissa 1/sqrt(3).
pub const GAUSS: f64 = 0.577_350_269_189_625_8;

/// What the far edge counts at a Gauss line over what the near one does: (1 - 1/sqrt 3)/(1 + 1/sqrt 3) = 2 - sqrt 3.
pub const FAR: f64 = 0.267_949_192_431_122_8;

/// Element coordinates run from -1/3.2 to 1/3.2 or so, not from -1 to 1: the columns of A at the Gauss points are then
/// interpolated with the weights 1 and [`FAR`], one operation a number. From these coordinates to those from -1 to 1:
/// lengths, and the metric M.
const TO_UNIT: f64 = 2.0 * (1.0 + FAR) * (1.0 + FAR);
/// A point's weight is the volume it stands for in these coordinates.
pub const WEIGHT: f64 = 1.0 / (TO_UNIT * TO_UNIT * TO_UNIT);

/// Edge (or line) indices of the three columns at point q, whose bits are the signs of (xi, eta, zeta).
#[inline(always)]
pub const fn lines(q: usize) -> [usize; 3] {
    let (a, b, c) = (q & 1, (q >> 1) & 1, (q >> 2) & 1);
    [b + 2 * c, a + 2 * c, a + 2 * b]
}

/// Columns of A on the Gauss lines: `columns[d][line]`.
pub type LineColumns<S> = [[Vec3<S>; 4]; 3];

/// What a field along an edge is at the two Gauss lines, but for a factor of 1 + FAR.
#[inline(always)]
fn mix<S: Scalar>(a: Vec3<S>, b: Vec3<S>) -> [Vec3<S>; 2] {
    let far = S::from_f64(FAR);
    [axpy(b, far, a), axpy(a, far, b)]
}

/// (1 + FAR)^2 times the values on four Gauss lines from values on four edges; symmetric, so its own transpose.
#[inline(always)]
fn interpolate<S: Scalar>(e: &[Vec3<S>; 4]) -> [Vec3<S>; 4] {
    let ([a0, a1], [b0, b1]) = (mix(e[0], e[1]), mix(e[2], e[3]));
    let ([l0, l2], [l1, l3]) = (mix(a0, b0), mix(a1, b1));
    [l0, l1, l2, l3]
}

#[inline(always)]
fn edge<S: Scalar, const D: usize, const M: usize>(x: &Corners<S>) -> Vec3<S> {
    const { assert!(D < 3 && M < 4) };
    let (a, b) = EDGES[D][M];
    sub(x[b], x[a])
}

#[inline(always)]
fn direction<S: Scalar, const D: usize>(x: &Corners<S>) -> [Vec3<S>; 4] {
    interpolate(&[edge::<S, D, 0>(x), edge::<S, D, 1>(x), edge::<S, D, 2>(x), edge::<S, D, 3>(x)])
}

/// A = dx/dxi on the Gauss lines.
#[inline(always)]
pub fn gradients<S: Scalar>(x: &Corners<S>) -> LineColumns<S> {
    [direction::<S, 0>(x), direction::<S, 1>(x), direction::<S, 2>(x)]
}

/// A at point q.
#[inline(always)]
pub fn at<S: Scalar>(columns: &LineColumns<S>, q: usize) -> Mat3<S> {
    let [i, j, k] = lines(q);
    [columns[0][i], columns[1][j], columns[2][k]]
}

/// Volume of an element, exact for trilinear maps: three triple products of differences of corners (Grandy 1997).
#[inline(always)]
pub fn volume<S: Scalar>(x: &Corners<S>) -> S {
    let (d10, d20, d30) = (sub(x[6], x[1]), sub(x[6], x[3]), sub(x[6], x[4]));
    let (d01, d02, d03) = (sub(x[7], x[0]), sub(x[5], x[0]), sub(x[2], x[0]));
    let twelvefold = dot(add(d10, d01), cross(d20, d03))
        + dot(d01, cross(add(d20, d02), d30))
        + dot(d10, cross(d02, add(d30, d03)));
    twelvefold * S::from_f64(1.0 / 12.0)
}

/// Corner forces sum_q sum_d G_d dN_a/dxi_d from the sums on the lines.
#[inline(always)]
pub fn scatter<S: Scalar>(lines_force: &LineColumns<S>) -> Corners<S> {
    let [x, y, z] =
        [interpolate(&lines_force[0]), interpolate(&lines_force[1]), interpolate(&lines_force[2])];
    // Every corner ends one edge of each direction (`EDGES`).
    [
        neg(add(x[0], add(y[0], z[0]))),
        sub(x[0], add(y[1], z[1])),
        add(x[1], sub(y[1], z[3])),
        sub(sub(y[0], x[1]), z[2]),
        sub(sub(z[0], x[2]), y[2]),
        add(x[2], sub(z[1], y[3])),
        add(x[3], add(y[3], z[3])),
        sub(add(y[2], z[2]), x[3]),
    ]
}

/// What isotropic laws depend on at a point.
#[derive(Clone, Copy)]
pub struct Invariants<S> {
    pub i1: S,
    pub i2: S,
    /// M G M, where the law depends on I2.
    square: Sym3<S>,
}

/// I1 and, where the law wants it, I2 of C = J0^-T G J0^-1 with G = A^T A: I1 = G : M, tr C^2 = G : M G M. Without I2, of G's entries
/// off the diagonal only those are read where M has some.
#[inline(always)]
pub fn invariants<S: Scalar, L: Hyperelastic, M: Metric<S>>(gram: &Sym3<S>, metric: &M) -> Invariants<S> {
    let i1 = metric.contracted(gram);
    if !L::HAS_I2 {
        return Invariants { i1, i2: S::zero(), square: Sym3::zero() };
    }
    let square = metric.around(gram);
    Invariants { i1, i2: (i1 * i1 - square.contracted(gram)) * S::from_f64(0.5), square }
}

/// dV times the second Piola stress in element coordinates but for what goes with cof A: 2 W1 M + 2 W2 (I1 M - M G M). The
/// force of a point on corner a is sum_d G_d dN_a/dxi_d with G = A S + (weight (WJ + p) I + weight sigma_v) cof A, where
/// dV = weight det J0. With the mean gradient in place of a point's, dV and weight are 1.
#[inline(always)]
pub fn second_piola<S: Scalar, L: Hyperelastic, M: Metric<S>>(
    k: &Invariants<S>,
    d: &Derivatives<S>,
    metric: &M,
    dv: S,
) -> Sym3<S> {
    let two = dv + dv;
    if !L::HAS_I2 {
        return metric.scaled(two * d.w1);
    }
    let c2 = two * d.w2;
    let (m, q) = (metric.scaled(c2.mul_add(k.i1, two * d.w1)), &k.square);
    Sym3 {
        xx: q.xx.neg_mul_add(c2, m.xx),
        yy: q.yy.neg_mul_add(c2, m.yy),
        zz: q.zz.neg_mul_add(c2, m.zz),
        xy: q.xy.neg_mul_add(c2, m.xy),
        xz: q.xz.neg_mul_add(c2, m.xz),
        yz: q.yz.neg_mul_add(c2, m.yz),
    }
}

/// F S with the S of [`second_piola`] for the identity as metric: the first Piola stress but for what goes with cof F.
#[inline(always)]
pub fn times_second_piola<S: Scalar, L: Hyperelastic>(f: &Mat3<S>, s: &Sym3<S>) -> Mat3<S> {
    if !L::HAS_I2 {
        return [scale(f[0], s.xx), scale(f[1], s.yy), scale(f[2], s.zz)];
    }
    let s = s.columns();
    [
        combined(f, s[0][0], s[0][1], s[0][2]),
        combined(f, s[1][0], s[1][1], s[1][2]),
        combined(f, s[2][0], s[2][1], s[2][2]),
    ]
}

/// `pressure` I + `stress`.
#[inline(always)]
pub fn with_pressure<S: Scalar>(mut stress: Mat3<S>, pressure: S) -> Mat3<S> {
    stress[0][0] += pressure;
    stress[1][1] += pressure;
    stress[2][2] += pressure;
    stress
}

/// Reference geometry shared by all elements that differ by a rigid motion only.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Class<S> {
    /// M = J0^-1 J0^-T at the points [1/m2].
    pub metric: [Sym3<S>; 8],
    /// Volumes of the points, weight det J0 [m3], and 1 / det J0.
    pub det_j0: [S; 8],
    pub inverse_det_j0: [S; 8],
    /// V = sum of the points' volumes [m3], and its reciprocal.
    pub volume: S,
    pub inverse_volume: S,
    /// Volume-averaged gradients b_a of the class's first element [1/m].
    pub gradient: Corners<S>,
    /// Gamma_h . X of the class's first element [m].
    pub gamma_x: [Vec3<S>; 4],
    /// Hourglass stiffness c G V sum_a |b_a|^2 / 8 [N/m], and the same with eta for G [N s/m].
    pub hourglass_stiffness: S,
    pub hourglass_viscosity: S,
    /// Of an extruded element (see [`Class::is_extruded`]), along its own axes e1, e2 (extrusion) and e3: the parts of
    /// b_a, which are b . e1 and b . e3 = c xi_a + d zeta_a and b . e2 = eta_a (c + d xi_a + e zeta_a), in the order
    /// (xi: 1, 3), (zeta: 1, 3), eta, xi eta, eta zeta [1/m]; and Gamma . X of the pattern xi zeta along e1 and e3 [m], the only one
    /// that is not zero.
    pub extruded: [S; 9],
}

impl<S> Class<S> {
    /// Numbers of a class.
    pub const NUMBERS: usize = 8 * (6 + 1 + 1) + 2 + 8 * 3 + 4 * 3 + 2 + 9;
    /// Of these, what elements with points need, and what those with a mean gradient need.
    pub const OF_POINTS: Range<usize> = 0..66;
    pub const OF_MEAN: Range<usize> = 64..Self::NUMBERS;

    /// All of them, in the order of the fields.
    #[inline(always)]
    pub fn numbers(&self) -> &[S] {
        // SAFETY: `repr(C)`, and every field is made of S.
        unsafe { std::slice::from_raw_parts((&raw const *self).cast(), Self::NUMBERS) }
    }
}

/// Where a formulation finds the reference geometry of its element, or of its lanes' elements, number by number: what
/// is not used is not read, and a number that all lanes share is read as one.
pub trait Shape<S: Scalar> {
    /// Number `i` of [`Class::numbers`].
    fn number(&self, i: usize) -> S;

    #[inline(always)]
    fn metric(&self, q: usize) -> Sym3<S> {
        let i = 6 * q;
        Sym3 {
            xx: self.number(i),
            yy: self.number(i + 1),
            zz: self.number(i + 2),
            xy: self.number(i + 3),
            xz: self.number(i + 4),
            yz: self.number(i + 5),
        }
    }
    #[inline(always)]
    fn det_j0(&self, q: usize) -> S {
        self.number(48 + q)
    }
    #[inline(always)]
    fn inverse_det_j0(&self, q: usize) -> S {
        self.number(56 + q)
    }
    #[inline(always)]
    fn volume(&self) -> S {
        self.number(64)
    }
    #[inline(always)]
    fn inverse_volume(&self) -> S {
        self.number(65)
    }
    #[inline(always)]
    fn gradient(&self, a: usize) -> Vec3<S> {
        let i = 66 + 3 * a;
        [self.number(i), self.number(i + 1), self.number(i + 2)]
    }
    #[inline(always)]
    fn gamma_x(&self, h: usize) -> Vec3<S> {
        let i = 90 + 3 * h;
        [self.number(i), self.number(i + 1), self.number(i + 2)]
    }
    #[inline(always)]
    fn hourglass_stiffness(&self) -> S {
        self.number(102)
    }
    #[inline(always)]
    fn hourglass_viscosity(&self) -> S {
        self.number(103)
    }
    #[inline(always)]
    fn extruded(&self, i: usize) -> S {
        self.number(104 + i)
    }
}

impl<S: Scalar> Shape<S> for Class<S> {
    #[inline(always)]
    fn number(&self, i: usize) -> S {
        self.numbers()[i]
    }
}

/// One class for all lanes.
#[derive(Debug, Clone, Copy)]
pub struct SameShape<'a, T>(pub &'a Class<T>);

impl<N: Lanes> Shape<N> for SameShape<'_, N::Real> {
    #[inline(always)]
    fn number(&self, i: usize) -> N {
        N::splat(self.0.numbers()[i])
    }
}

/// A class a lane: the numbers of all of them, vector by vector, from number `first` on.
#[derive(Debug, Clone, Copy)]
pub struct LaneShapes<'a, T> {
    numbers: &'a [T],
    first: usize,
}

impl<'a, T> LaneShapes<'a, T> {
    /// # Safety
    /// `numbers` has a vector for each number from `first` on that is asked for. A check of each would be a branch in code that
    /// has none.
    #[inline(always)]
    pub unsafe fn new(numbers: &'a [T], first: usize) -> Self {
        LaneShapes { numbers, first }
    }
}

impl<N: Lanes> Shape<N> for LaneShapes<'_, N::Real> {
    #[inline(always)]
    fn number(&self, i: usize) -> N {
        let at = (i - self.first) * N::WIDTH;
        debug_assert!(at + N::WIDTH <= self.numbers.len());
        // SAFETY: the promise of `LaneShapes::new`.
        unsafe { N::load(self.numbers.as_ptr(), at) }
    }
}

impl Class<f64> {
    /// Whether the element is a plane figure extruded along eta, as those of a ring, whose width that is, or of a block: M is
    /// zero, up to round-off, where eta meets xi or zeta.
    pub fn is_extruded(&self) -> bool {
        let none = |m: &Sym3<f64>| {
            let small = 1e-14 * (m.xx.max(m.zz) * m.yy).sqrt();
            m.xy.abs() <= small && m.yz.abs() <= small
        };
        self.metric.iter().all(none)
    }

    /// Geometry of an element with reference corners `X`; `hourglass_modulus` = c G and `hourglass_eta` = c eta.
    /// `None` if det J0 is not positive at a point or a corner (an inside-out element).
    pub fn new(X: &Corners<f64>, hourglass_modulus: f64, hourglass_eta: f64) -> Option<Self> {
        let columns = gradients(X);
        let j0: [Mat3<f64>; 8] = std::array::from_fn(|q| at(&columns, q));
        let det_j0 = j0.map(|j| WEIGHT * det(&j));
        let positive = |d: f64| d > 0.0;
        if !det_j0.iter().copied().all(positive) || !corner_jacobians(X).into_iter().all(positive) {
            return None;
        }
        let volume: f64 = det_j0.iter().sum();
        // int dN_a/dX dV = sum_q weight cof(J0) grad_xi N, the force of a unit pressure
        let mut unit = [[[0.0; 3]; 4]; 3];
        for (q, j) in j0.iter().enumerate() {
            let (cof, at) = (cofactor(j), lines(q));
            for d in 0..3 {
                unit[d][at[d]] = add(unit[d][at[d]], cof[d]);
            }
        }
        let gradient = scatter(&unit).map(|g| scale(g, WEIGHT / volume));
        let b2: f64 = gradient.iter().map(|&b| dot(b, b)).sum();
        let gamma_x = HOURGLASS.map(|h| (0..8).fold([0.0; 3], |sum, a| axpy(X[a], h[a], sum)));
        let metric = std::array::from_fn(|q| metric(&j0[q]));
        Some(Class {
            metric,
            det_j0,
            inverse_det_j0: det_j0.map(|d| WEIGHT / d),
            volume,
            inverse_volume: 1.0 / volume,
            gradient,
            gamma_x,
            hourglass_stiffness: hourglass_modulus * volume * b2 / 8.0,
            hourglass_viscosity: hourglass_eta * volume * b2 / 8.0,
            extruded: extruded(X, &gradient),
        })
    }

    /// What each corner has of the volume [m3], the lumped mass over the density: int N_a dV, or an eighth.
    pub fn corner_volumes(&self, lumping: Lumping) -> [f64; 8] {
        if lumping == Lumping::Equal {
            return [self.volume / 8.0; 8];
        }
        let mut volumes = [0.0; 8];
        for (q, d) in self.det_j0.iter().enumerate() {
            let point = [q & 1, (q >> 1) & 1, (q >> 2) & 1].map(|bit| if bit == 1 { GAUSS } else { -GAUSS });
            for (a, s) in SIGNS.iter().enumerate() {
                let n: f64 = (0..3).map(|d| 0.5 * (1.0 + s[d] * point[d])).product();
                volumes[a] += n * d;
            }
        }
        volumes
    }

    /// The same geometry in another scalar.
    pub fn cast<S: Scalar>(&self) -> Class<S> {
        let s = S::from_f64;
        let v = |v: Vec3<f64>| v.map(s);
        Class {
            metric: self.metric.map(|m| m.map(s)),
            det_j0: self.det_j0.map(s),
            inverse_det_j0: self.inverse_det_j0.map(s),
            volume: s(self.volume),
            inverse_volume: s(self.inverse_volume),
            gradient: self.gradient.map(v),
            gamma_x: self.gamma_x.map(v),
            hourglass_stiffness: s(self.hourglass_stiffness),
            hourglass_viscosity: s(self.hourglass_viscosity),
            extruded: self.extruded.map(s),
        }
    }
}

/// M = J0^-1 J0^-T from the columns of J0: rows of J0^-1 are cof(J0)_d / det.
fn metric(j0: &Mat3<f64>) -> Sym3<f64> {
    let (c, d) = (cofactor(j0), det(j0));
    let m = |i: usize, j: usize| dot(c[i], c[j]) / (d * d);
    Sym3 { xx: m(0, 0), yy: m(1, 1), zz: m(2, 2), xy: m(0, 1), xz: m(0, 2), yz: m(1, 2) }
}

/// det dX/dxi at the eight corners: a trilinear map can be positive at the points and fold at a corner.
pub fn corner_jacobians(X: &Corners<f64>) -> [f64; 8] {
    std::array::from_fn(|a| {
        let columns = EDGES.map(|edges| {
            let (from, to) =
                edges.into_iter().find(|&(f, t)| f == a || t == a).expect("every corner ends an edge");
            scale(sub(X[to], X[from]), 0.5)
        });
        det(&columns)
    })
}

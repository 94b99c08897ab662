//! `q1p0` as a textbook writes it: what every fast routine, on the CPU, on the GPU and in the implicit scheme, is compared with.
//!
//! Nothing is shared with those routines but the law's derivatives: shape functions, Jacobians, F, P and the sum over the points
//! are written out with the matrices of the book (Bonet & Wood 2008, ch. 9; Simo, Taylor & Pister 1985 for the pressure).

use super::Corners;
use super::hex8::{GAUSS, SIGNS};
use crate::material::{Hyperelastic, Term};
use glam::{DMat3, DVec3};

/// Derivatives of the eight shape functions N_a = (1 + xi xi_a)(1 + eta eta_a)(1 + zeta zeta_a)/8 along xi, eta, zeta.
fn shape_gradients(at: DVec3) -> [DVec3; 8] {
    SIGNS.map(|sign| {
        let s = DVec3::from(sign);
        let n = DVec3::ONE + s * at;
        s * DVec3::new(n.y * n.z, n.x * n.z, n.x * n.y) / 8.0
    })
}

/// sum_a x_a (x) g_a.
fn gradient(x: &[DVec3; 8], g: &[DVec3; 8]) -> DMat3 {
    let outer = |x: DVec3, g: DVec3| DMat3::from_cols(x * g.x, x * g.y, x * g.z);
    (0..8).fold(DMat3::ZERO, |sum, a| sum + outer(x[a], g[a]))
}

/// First Piola stress without the volumetric part: dW/dF = 2 W1 F + 2 W2 (I1 F - F C) + WJ cof F.
fn first_piola<L: Hyperelastic>(law: &L, F: DMat3) -> DMat3 {
    let C = F.transpose() * F;
    let trace = |A: DMat3| A.x_axis.x + A.y_axis.y + A.z_axis.z;
    let i1 = trace(C);
    let i2 = 0.5 * (i1 * i1 - trace(C * C));
    let d = law.derivatives(i1, i2, F.determinant());
    F * (2.0 * d.w1) + (F * i1 - F * C) * (2.0 * d.w2) + cofactor(F) * d.wj
}

/// cof F = J F^-T = dJ/dF.
fn cofactor(F: DMat3) -> DMat3 {
    F.inverse().transpose() * F.determinant()
}

/// Sd = DEV[2 dWb/dC] with the invariants of J^-2/3 C; DEV[.] = (.) - 1/3 (C : .) C^-1 (Simo & Hughes, eq. 10.3).
fn isochoric_stress<L: Hyperelastic>(law: &L, F: DMat3) -> DMat3 {
    let (J, C) = (F.determinant(), F.transpose() * F);
    let trace = C.x_axis.x + C.y_axis.y + C.z_axis.z;
    let square = C * C;
    let i2 = 0.5 * (trace * trace - (square.x_axis.x + square.y_axis.y + square.z_axis.z));
    let d = law.derivatives(trace, i2, J);
    // dW/dI of the invariants I1 J^-2/3 and I2 J^-4/3.
    let (w1, w2) = (d.w1 * J.powf(2.0 / 3.0), d.w2 * J.powf(4.0 / 3.0));
    let Cb = C * J.powf(-2.0 / 3.0);
    let ib = trace * J.powf(-2.0 / 3.0);
    deviator(C, DMat3::IDENTITY * (2.0 * w1) + (DMat3::IDENTITY * ib - Cb) * (2.0 * w2))
}

/// DEV[A].
fn deviator(C: DMat3, A: DMat3) -> DMat3 {
    let contracted = C.x_axis.dot(A.x_axis) + C.y_axis.dot(A.y_axis) + C.z_axis.dot(A.z_axis);
    A - C.inverse() * (contracted / 3.0)
}

/// Internal force of the corners [N] of a Prony series alone, at the last of the positions `history`, each with the time since the
/// one before it [s]; at the first of them everything has relaxed.
///
/// h(n+1) = e^(-dt/tau) h(n) + e^(-dt/2 tau) (Sd(n+1) - Sd(n)), S = J^-2/3 DEV[sum r h] (Simo & Hughes, box 10.2).
pub fn overstress<L: Hyperelastic>(
    law: &L,
    terms: &[Term],
    X: &Corners<f64>,
    history: &[(f64, Corners<f64>)],
) -> Corners<f64> {
    let X = X.map(DVec3::from);
    let mut f = [DVec3::ZERO; 8];
    for sign in SIGNS {
        let g = shape_gradients(DVec3::from(sign) * GAUSS);
        let J0 = gradient(&X, &g);
        let B = g.map(|g| J0.inverse().transpose() * g);
        let mut before = None;
        let mut h = vec![DMat3::ZERO; terms.len()];
        let mut F = DMat3::IDENTITY;
        for (dt, x) in history {
            F = gradient(&x.map(DVec3::from), &B);
            let Sd = isochoric_stress(law, F);
            for (h, term) in h.iter_mut().zip(terms) {
                let change = Sd - before.unwrap_or(Sd);
                *h = *h * (-dt / term.time).exp() + change * (-0.5 * dt / term.time).exp();
            }
            before = Some(Sd);
        }
        let sum = h.iter().zip(terms).fold(DMat3::ZERO, |sum, (h, term)| sum + *h * term.ratio);
        let C = F.transpose() * F;
        let P = F * deviator(C, sum) * F.determinant().powf(-2.0 / 3.0);
        for a in 0..8 {
            f[a] += P * B[a] * J0.determinant();
        }
    }
    f.map(|f| f.to_array())
}

/// Internal force of the corners [N] at reference positions `X` and positions `x` [m].
///
/// f_a = int (P + p cof F) Grad N_a dV by 2x2x2 points, with one pressure p = U'(v/V) for the element.
pub fn q1p0<L: Hyperelastic>(law: &L, X: &Corners<f64>, x: &Corners<f64>) -> Corners<f64> {
    let (X, x) = (X.map(DVec3::from), x.map(DVec3::from));
    let points = SIGNS.map(|sign| shape_gradients(DVec3::from(sign) * GAUSS));
    let volume = |x: &[DVec3; 8]| points.iter().map(|g| gradient(x, g).determinant()).sum::<f64>();
    let p = law.dU(volume(&x) / volume(&X));
    let mut f = [DVec3::ZERO; 8];
    for g in &points {
        let J0 = gradient(&X, g);
        // B of the book: the gradients of the shape functions along X.
        let B = g.map(|g| J0.inverse().transpose() * g);
        let F = gradient(&x, &B);
        let P = first_piola(law, F) + cofactor(F) * p;
        for a in 0..8 {
            f[a] += P * B[a] * J0.determinant();
        }
    }
    f.map(|f| f.to_array())
}

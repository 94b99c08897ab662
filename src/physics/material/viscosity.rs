use crate::physics::scalar::Scalar;
use crate::physics::tensor::{Mat3, Vec3, combined, dot, scale};

/// A viscous stress added to any law, or nothing.
pub trait Viscosity<S: Scalar>: Copy + Send + Sync + 'static {
    /// Whether there is any: the velocities are not even read otherwise.
    const ON: bool;
    fn new(eta: f64) -> Self;
    /// eta [Pa s].
    fn eta(&self) -> S;
    /// Columns weight sigma_v cof(A)_d of the force matrix and the power weight sigma_v : L det A, from A's rate, its
    /// cofactor and determinant.
    fn stress(&self, a_dot: &Mat3<S>, cof: &Mat3<S>, det: S, weight: S) -> (Mat3<S>, S);
}

/// No viscosity.
#[derive(Debug, Clone, Copy)]
pub struct Inviscid;

impl<S: Scalar> Viscosity<S> for Inviscid {
    const ON: bool = false;
    fn new(_eta: f64) -> Self {
        Inviscid
    }
    fn eta(&self) -> S {
        S::zero()
    }
    #[inline(always)]
    fn stress(&self, _a_dot: &Mat3<S>, _cof: &Mat3<S>, _det: S, _weight: S) -> (Mat3<S>, S) {
        ([[S::zero(); 3]; 3], S::zero())
    }
}

/// Kelvin-Voigt shear viscosity: sigma_v = eta (L + L^T - 2/3 tr(L) I), L = dF/dt F^-1.
///
/// In element coordinates L = (dA/dt) A^-1: the reference metric cancels. Objective, never generates power.
#[derive(Debug, Clone, Copy)]
pub struct KelvinVoigt<S> {
    eta: S,
}

impl<S: Scalar> Viscosity<S> for KelvinVoigt<S> {
    const ON: bool = true;

    fn new(eta: f64) -> Self {
        KelvinVoigt { eta: S::from_f64(eta) }
    }

    fn eta(&self) -> S {
        self.eta
    }

    #[inline(always)]
    fn stress(&self, a_dot: &Mat3<S>, cof: &Mat3<S>, det: S, weight: S) -> (Mat3<S>, S) {
        let (r, eta) = (S::one() / det, self.eta * weight);
        let l = [row(a_dot, cof, r, 0), row(a_dot, cof, r, 1), row(a_dot, cof, r, 2)];
        let trace = l[0][0] + l[1][1] + l[2][2];
        let mean = (trace + trace) * S::from_f64(1.0 / 3.0);
        let (xy, xz, yz) = (l[0][1] + l[1][0], l[0][2] + l[2][0], l[1][2] + l[2][1]);
        let xx = l[0][0] + l[0][0] - mean;
        let yy = l[1][1] + l[1][1] - mean;
        let zz = l[2][2] + l[2][2] - mean;
        let sigma = [scale([xx, xy, xz], eta), scale([xy, yy, yz], eta), scale([xz, yz, zz], eta)];
        let power = dot(sigma[0], l[0]) + dot(sigma[1], l[1]) + dot(sigma[2], l[2]);
        let g = [
            combined(&sigma, cof[0][0], cof[0][1], cof[0][2]),
            combined(&sigma, cof[1][0], cof[1][1], cof[1][2]),
            combined(&sigma, cof[2][0], cof[2][1], cof[2][2]),
        ];
        (g, power * det)
    }
}

/// Row i of L = sum_d a_dot_d (x) cof_d / det.
#[inline(always)]
fn row<S: Scalar>(a_dot: &Mat3<S>, cof: &Mat3<S>, r: S, i: usize) -> Vec3<S> {
    scale(combined(cof, a_dot[0][i], a_dot[1][i], a_dot[2][i]), r)
}

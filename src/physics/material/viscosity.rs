use crate::physics::scalar::Scalar;
use crate::physics::tensor::{Mat3, add, axpy, dot, scale};

/// A viscous stress added to any law, or nothing.
pub trait Viscosity<S: Scalar>: Copy + Send + Sync + 'static {
    /// Whether there is any: the velocities are not even read otherwise.
    const ON: bool;
    fn new(eta: f64) -> Self;
    /// eta [Pa s].
    fn eta(&self) -> S;
    /// Columns sigma_v cof(A)_d of the force matrix and the power sigma_v : L det A, from A, its rate and cofactor.
    fn stress(&self, a_dot: &Mat3<S>, cof: &Mat3<S>, det: S) -> (Mat3<S>, S);
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
    fn stress(&self, _a_dot: &Mat3<S>, _cof: &Mat3<S>, _det: S) -> (Mat3<S>, S) {
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
    fn stress(&self, a_dot: &Mat3<S>, cof: &Mat3<S>, det: S) -> (Mat3<S>, S) {
        let r = S::one() / det;
        // L = sum_d a_dot_d (x) cof_d / det; rows of L dotted into a vector c: sum_d a_dot_d (cof_d . c) / det
        let row = |i: usize| {
            add(add(scale(cof[0], a_dot[0][i]), scale(cof[1], a_dot[1][i])), scale(cof[2], a_dot[2][i]))
        };
        let l = [scale(row(0), r), scale(row(1), r), scale(row(2), r)];
        let trace = l[0][0] + l[1][1] + l[2][2];
        let mean = (trace + trace) * S::from_f64(1.0 / 3.0);
        // Rows of the symmetric stress.
        let twice = |a: S| a + a;
        let (xy, xz, yz) = (l[0][1] + l[1][0], l[0][2] + l[2][0], l[1][2] + l[2][1]);
        let (xx, yy, zz) = (twice(l[0][0]) - mean, twice(l[1][1]) - mean, twice(l[2][2]) - mean);
        let sigma = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].map(|s| scale(s, self.eta));
        let power = dot(sigma[0], l[0]) + dot(sigma[1], l[1]) + dot(sigma[2], l[2]);
        let times = |c: [S; 3]| axpy(sigma[0], c[0], axpy(sigma[1], c[1], scale(sigma[2], c[2])));
        ([times(cof[0]), times(cof[1]), times(cof[2])], power * det)
    }
}

use crate::scalar::Scalar;
use crate::tensor::{Mat3, Vec3, combined, dot};

/// A viscous stress added to any law, or nothing.
pub trait Viscosity: Copy + Send + Sync + 'static {
    /// Whether there is any: the velocities are not even read otherwise.
    const ON: bool;
    /// weight sigma_v and the power weight sigma_v : L det A, from A's rate, its cofactor and determinant; what sigma_v adds
    /// to the force matrix are the columns weight sigma_v cof(A)_d.
    fn stress<S: Scalar>(&self, a_dot: &Mat3<S>, cof: &Mat3<S>, det: S, weight: S) -> (Mat3<S>, S);
}

/// No viscosity.
#[derive(Debug, Clone, Copy)]
pub struct Inviscid;

impl Viscosity for Inviscid {
    const ON: bool = false;
    #[inline(always)]
    fn stress<S: Scalar>(&self, _a_dot: &Mat3<S>, _cof: &Mat3<S>, _det: S, _weight: S) -> (Mat3<S>, S) {
        ([[S::zero(); 3]; 3], S::zero())
    }
}

/// Kelvin-Voigt shear viscosity: sigma_v = eta (L + L^T - 2/3 tr(L) I), L = dF/dt F^-1.
///
/// In element coordinates L = (dA/dt) A^-1: the reference metric cancels. Objective, never generates power.
#[derive(Debug, Clone, Copy)]
pub struct KelvinVoigt {
    /// Shear viscosity [Pa s].
    pub eta: f64,
}

impl Viscosity for KelvinVoigt {
    const ON: bool = true;

    #[inline(always)]
    fn stress<S: Scalar>(&self, a_dot: &Mat3<S>, cof: &Mat3<S>, det: S, weight: S) -> (Mat3<S>, S) {
        // L det A, whose factor goes to eta.
        let l = [row(a_dot, cof, 0), row(a_dot, cof, 1), row(a_dot, cof, 2)];
        let eta = S::from_f64(self.eta) * weight / det;
        let trace = l[0][0] + l[1][1] + l[2][2];
        let mean = (trace + trace) * S::from_f64(1.0 / 3.0);
        let [xy, xz, yz] = [l[0][1] + l[1][0], l[0][2] + l[2][0], l[1][2] + l[2][1]];
        let [sxy, sxz, syz] = [eta * xy, eta * xz, eta * yz];
        let sxx = eta * (l[0][0] + l[0][0] - mean);
        let syy = eta * (l[1][1] + l[1][1] - mean);
        let szz = eta * (l[2][2] + l[2][2] - mean);
        let normal = dot([sxx, syy, szz], [l[0][0], l[1][1], l[2][2]]);
        let power = normal + dot([sxy, sxz, syz], [xy, xz, yz]);
        ([[sxx, sxy, sxz], [sxy, syy, syz], [sxz, syz, szz]], power)
    }
}

/// Row i of L det A = sum_d a_dot_d (x) cof_d.
#[inline(always)]
fn row<S: Scalar>(a_dot: &Mat3<S>, cof: &Mat3<S>, i: usize) -> Vec3<S> {
    combined(cof, a_dot[0][i], a_dot[1][i], a_dot[2][i])
}

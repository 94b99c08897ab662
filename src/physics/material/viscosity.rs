use crate::scalar::Scalar;
use crate::tensor::{Mat3, Vec3, axpy, combined, dot};

/// A viscous stress added to any law, or nothing.
pub trait Viscosity: Copy + Send + Sync + 'static {
    /// Whether there is any: the velocities are not even read otherwise.
    const ON: bool;
    /// Whether points remember: a Prony series, whose terms come with the [`Memory`](super::Memory).
    const REMEMBERS: bool = false;
    /// The same for velocities that are means over the time `dt` [s] before the positions; 0: velocities at their time.
    fn over(self, dt: f64) -> Self;
    /// weight sigma_v and the power weight sigma_v : L det A, from [`velocity_gradient`] and det A; what sigma_v adds to the force
    /// matrix are the columns weight sigma_v cof(A)_d.
    fn stress<S: Scalar>(&self, l: &Mat3<S>, det: S, weight: S) -> (Mat3<S>, S);
    /// Rate of a vector q that turns with the body, from [`velocity_gradient`], det A and the rate of q's components: how fast
    /// A^T q changes, taken back by A^-T.
    fn turning<S: Scalar>(&self, l: &Mat3<S>, det: S, q: Vec3<S>, rate: Vec3<S>) -> Vec3<S>;
}

/// No viscosity.
#[derive(Debug, Clone, Copy)]
pub struct Inviscid;

impl Viscosity for Inviscid {
    const ON: bool = false;

    #[inline(always)]
    fn over(self, _dt: f64) -> Self {
        self
    }

    #[inline(always)]
    fn stress<S: Scalar>(&self, _l: &Mat3<S>, _det: S, _weight: S) -> (Mat3<S>, S) {
        ([[S::zero(); 3]; 3], S::zero())
    }

    #[inline(always)]
    fn turning<S: Scalar>(&self, _l: &Mat3<S>, _det: S, _q: Vec3<S>, rate: Vec3<S>) -> Vec3<S> {
        rate
    }
}

/// Kelvin-Voigt shear viscosity: sigma_v = 2 eta dev D, D the rate of deformation.
///
/// With L = dF/dt F^-1, in element coordinates (dA/dt) A^-1 because the reference metric cancels, D is the symmetric part of L where
/// velocities belong to the time of the positions. Where they are means over the time dt before it, C has changed by
/// C(t) - C(t - dt) = dt (F^T dF/dt + dF/dt^T F - dt dF/dt^T dF/dt), exactly, so that
///
/// ```text
/// 2 D = F^-T (dC / dt) F^-1 = L + L^T - dt L^T L
/// ```
///
/// is zero in a rigid rotation by any angle. The symmetric part of L is not: it is w^2 dt / 2 across the axis. Without rotation the
/// power sigma_v : L is positive; with it, up to a share of w dt.
#[derive(Debug, Clone, Copy)]
pub struct KelvinVoigt {
    /// Shear viscosity [Pa s].
    pub eta: f64,
    /// Time over which the velocities are means [s].
    dt: f64,
}

impl KelvinVoigt {
    /// With a shear viscosity [Pa s], for velocities at the time of the positions.
    pub fn new(eta: f64) -> Self {
        KelvinVoigt { eta, dt: 0.0 }
    }
}

impl Viscosity for KelvinVoigt {
    const ON: bool = true;

    #[inline(always)]
    fn over(self, dt: f64) -> Self {
        KelvinVoigt { dt, ..self }
    }

    #[inline(always)]
    fn stress<S: Scalar>(&self, l: &Mat3<S>, det: S, weight: S) -> (Mat3<S>, S) {
        // The factor det A of L goes to eta.
        let inverse = S::one() / det;
        let eta = S::from_f64(self.eta) * weight * inverse;
        let past = S::from_f64(-self.dt) * inverse;
        let column = |j: usize| [l[0][j], l[1][j], l[2][j]];
        let [cx, cy, cz] = [column(0), column(1), column(2)];
        let [xy, xz, yz] = [l[0][1] + l[1][0], l[0][2] + l[2][0], l[1][2] + l[2][1]];
        let sxy = eta * past.mul_add(dot(cx, cy), xy);
        let sxz = eta * past.mul_add(dot(cx, cz), xz);
        let syz = eta * past.mul_add(dot(cy, cz), yz);
        let xx = past.mul_add(dot(cx, cx), l[0][0] + l[0][0]);
        let yy = past.mul_add(dot(cy, cy), l[1][1] + l[1][1]);
        let zz = past.mul_add(dot(cz, cz), l[2][2] + l[2][2]);
        let mean = (xx + yy + zz) * S::from_f64(1.0 / 3.0);
        let [sxx, syy, szz] = [eta * (xx - mean), eta * (yy - mean), eta * (zz - mean)];
        let normal = dot([sxx, syy, szz], [l[0][0], l[1][1], l[2][2]]);
        let power = normal + dot([sxy, sxz, syz], [xy, xz, yz]);
        ([[sxx, sxy, sxz], [sxy, syy, syz], [sxz, syz, szz]], power)
    }

    /// dq/dt + L^T (q - dt dq/dt), zero where q turns rigidly with the body by any angle.
    #[inline(always)]
    fn turning<S: Scalar>(&self, l: &Mat3<S>, det: S, q: Vec3<S>, rate: Vec3<S>) -> Vec3<S> {
        let before = axpy(rate, S::from_f64(-self.dt), q);
        axpy(combined(l, before[0], before[1], before[2]), S::one() / det, rate)
    }
}

/// A Prony series beside a Kelvin-Voigt viscosity, which may be zero.
#[derive(Debug, Clone, Copy)]
pub struct Viscoelastic(pub KelvinVoigt);

impl Viscosity for Viscoelastic {
    const ON: bool = true;
    const REMEMBERS: bool = true;

    #[inline(always)]
    fn over(self, dt: f64) -> Self {
        Viscoelastic(self.0.over(dt))
    }

    #[inline(always)]
    fn stress<S: Scalar>(&self, l: &Mat3<S>, det: S, weight: S) -> (Mat3<S>, S) {
        self.0.stress(l, det, weight)
    }

    #[inline(always)]
    fn turning<S: Scalar>(&self, l: &Mat3<S>, det: S, q: Vec3<S>, rate: Vec3<S>) -> Vec3<S> {
        self.0.turning(l, det, q, rate)
    }
}

/// Rows of L det A, from A's rate and its cofactor.
#[inline(always)]
pub fn velocity_gradient<S: Scalar>(a_dot: &Mat3<S>, cof: &Mat3<S>) -> Mat3<S> {
    [row(a_dot, cof, 0), row(a_dot, cof, 1), row(a_dot, cof, 2)]
}

/// Row i of L det A = sum_d a_dot_d (x) cof_d.
#[inline(always)]
fn row<S: Scalar>(a_dot: &Mat3<S>, cof: &Mat3<S>, i: usize) -> Vec3<S> {
    combined(cof, a_dot[0][i], a_dot[1][i], a_dot[2][i])
}

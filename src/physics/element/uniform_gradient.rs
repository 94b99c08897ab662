use super::hex8::{self, Corners, HOURGLASS, Shape};
use super::{Energy, Force, Formulation};
use crate::physics::material::{Law, Viscosity};
use crate::physics::scalar::Scalar;
use crate::physics::tensor::{Mat3, Sym3, Vec3, add, axpy, cofactor, combined, det, dot, scale, sub};

/// Volume-averaged gradients (Flanagan & Belytschko 1981) and hourglass stiffness on gamma-vectors formed on the
/// reference shape, orthogonal to every affine field: a rigid rotation makes no hourglass force.
///
/// With b and X of the class's first element, F' = sum x_a (x) b_a differs from F by the element's own rotation on
/// the right only, which isotropic laws do not see. Hourglass:
/// q_h = sum_a Gamma_h,a x_a - F' (Gamma_h . X), E = k/2 sum |q_h|^2, f_a = V P' b_a + k sum_h q_h Gamma_h,a with
/// P' less (k/V) sum_h q_h (x) (Gamma_h . X).
#[derive(Debug, Clone, Copy)]
pub struct UniformGradient;

impl Formulation for UniformGradient {
    #[inline(always)]
    fn force<S: Scalar, L: Law<S>, V: Viscosity<S>, G: Shape<S>>(
        law: &L,
        viscosity: &V,
        class: &G,
        x: &Corners<S>,
        v: &Corners<S>,
    ) -> Force<S> {
        let f = mean_gradient(class, x);
        let cof = cofactor(&f);
        let j = dot(f[0], cof[0]);
        let k = hex8::kinematics::<S, L, true>(&f, &identity());
        let d = law.first_piola(k.i1, k.i2, j);
        let mut hourglass = hourglass_modes(class, x, &f);
        for q in &mut hourglass {
            *q = scale(*q, class.hourglass_stiffness());
        }
        let mut power = S::zero();
        let one = S::one();
        let p = if !V::ON {
            hex8::force_matrix::<S, L>(&k, &d, law.dU(j), &cof, one, one, None)
        } else {
            let rate = mean_gradient(class, v);
            let (viscous, density) = viscosity.stress(&rate, &cof, j, one);
            power += density * class.volume();
            let rates = hourglass_modes(class, v, &rate);
            for h in 0..4 {
                hourglass[h] = axpy(rates[h], class.hourglass_viscosity(), hourglass[h]);
                power += class.hourglass_viscosity() * dot(rates[h], rates[h]);
            }
            hex8::force_matrix::<S, L>(&k, &d, law.dU(j), &cof, one, one, Some(&viscous))
        };
        Force { f: corner_forces(class, &p, &hourglass), min_j: j, viscous_power: power }
    }

    #[inline(always)]
    fn energy<S: Scalar, L: Law<S>, G: Shape<S>>(law: &L, class: &G, x: &Corners<S>) -> Energy<S> {
        let f = mean_gradient(class, x);
        let j = det(&f);
        let k = hex8::kinematics::<S, L, true>(&f, &identity());
        let mut q2 = S::zero();
        let modes = hourglass_modes(class, x, &f);
        for q in &modes {
            q2 += dot(*q, *q);
        }
        Energy {
            strain: class.volume() * (law.psi(k.i1, k.i2, j) + law.U(j)),
            hourglass: class.hourglass_stiffness() * S::from_f64(0.5) * q2,
            min_j: j,
        }
    }
}

#[inline(always)]
fn identity<S: Scalar>() -> Sym3<S> {
    let (o, i) = (S::zero(), S::one());
    Sym3 { xx: i, yy: i, zz: i, xy: o, xz: o, yz: o }
}

/// Columns of sum_a x_a (x) b_a.
#[inline(always)]
fn mean_gradient<S: Scalar, G: Shape<S>>(class: &G, x: &Corners<S>) -> Mat3<S> {
    let mut f = [[S::zero(); 3]; 3];
    // Differences first: sum_a b_a = 0, so a shift of all corners must not cost digits.
    for a in 1..8 {
        let u = sub(x[a], x[0]);
        for c in 0..3 {
            f[c] = axpy(u, class.gradient(a)[c], f[c]);
        }
    }
    f
}

/// q_h for the four patterns.
#[inline(always)]
fn hourglass_modes<S: Scalar, G: Shape<S>>(class: &G, x: &Corners<S>, f: &Mat3<S>) -> [Vec3<S>; 4] {
    let mut modes = [[S::zero(); 3]; 4];
    for h in 0..4 {
        for a in 1..8 {
            let u = sub(x[a], x[0]);
            modes[h] = if HOURGLASS[h][a] > 0.0 { add(modes[h], u) } else { sub(modes[h], u) };
        }
        let g = class.gamma_x(h);
        modes[h] = sub(modes[h], combined(f, g[0], g[1], g[2]));
    }
    modes
}

/// f_a = V (P - sum_h r_h (x) (Gamma_h . X) / V) b_a + sum_h r_h Gamma_h,a with r_h the hourglass forces.
#[inline(always)]
fn corner_forces<S: Scalar, G: Shape<S>>(class: &G, p: &Mat3<S>, hourglass: &[Vec3<S>; 4]) -> Corners<S> {
    let mut p = [scale(p[0], class.volume()), scale(p[1], class.volume()), scale(p[2], class.volume())];
    for h in 0..4 {
        for c in 0..3 {
            p[c] = axpy(hourglass[h], -class.gamma_x(h)[c], p[c]);
        }
    }
    let mut f = [[S::zero(); 3]; 8];
    for a in 0..8 {
        let b = class.gradient(a);
        f[a] = combined(&p, b[0], b[1], b[2]);
        for h in 0..4 {
            f[a] = if HOURGLASS[h][a] > 0.0 { add(f[a], hourglass[h]) } else { sub(f[a], hourglass[h]) };
        }
    }
    f
}

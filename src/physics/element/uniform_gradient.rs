use super::hex8::{self, Corners, HOURGLASS, Shape};
use super::{Class, Energy, Force, Formulation};
use crate::material::{Deformed, Hyperelastic, Memory, Viscosity, change, overstress, velocity_gradient};
use crate::scalar::Scalar;
use crate::tensor::{Identity, Mat3, Sym3, Vec3, add, axpy, cofactor, combined, det, dot, neg, scale, sub};
use std::ops::Range;

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
    const NUMBERS: Range<usize> = Class::<f64>::OF_MEAN;
    const POINTS: usize = 1;

    #[inline(always)]
    fn force<S: Scalar, L: Hyperelastic, V: Viscosity, G: Shape<S>, R: Memory<S>>(
        law: &L,
        viscosity: &V,
        class: &G,
        x: &Corners<S>,
        v: &Corners<S>,
        memory: &mut R,
    ) -> Force<S> {
        let rates = if V::ON { Some(fields(class, v)) } else { None };
        let (force, p, hourglass) = force(law, viscosity, class, fields(class, x), rates, memory);
        Force { f: corner_forces(class, &p, &hourglass), ..force }
    }

    #[inline(always)]
    fn energy<S: Scalar, L: Hyperelastic, G: Shape<S>>(law: &L, class: &G, x: &Corners<S>) -> Energy<S> {
        let f = mean_gradient(class, x);
        let j = det(&f);
        let k = hex8::invariants::<S, L, _>(&hex8::gram(&f), &Identity);
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

/// The same for elements that are plane figures extruded along eta, as a ring's across its width: in the patterns of the
/// corners' signs most parts of b and all but one of Gamma . X are zero ([`hex8::Class::extruded`]).
#[derive(Debug, Clone, Copy)]
pub struct ExtrudedUniformGradient;

impl Formulation for ExtrudedUniformGradient {
    const NUMBERS: Range<usize> = Class::<f64>::OF_MEAN;
    const POINTS: usize = 1;

    #[inline(always)]
    fn force<S: Scalar, L: Hyperelastic, V: Viscosity, G: Shape<S>, R: Memory<S>>(
        law: &L,
        viscosity: &V,
        class: &G,
        x: &Corners<S>,
        v: &Corners<S>,
        memory: &mut R,
    ) -> Force<S> {
        let rates = if V::ON { Some(extruded_fields(class, v)) } else { None };
        let (force, p, hourglass) = force(law, viscosity, class, extruded_fields(class, x), rates, memory);
        Force { f: extruded_forces(class, &p, &hourglass), ..force }
    }

    #[inline(always)]
    fn energy<S: Scalar, L: Hyperelastic, G: Shape<S>>(law: &L, class: &G, x: &Corners<S>) -> Energy<S> {
        UniformGradient::energy(law, class, x)
    }
}

/// Mean gradient and hourglass modes of a field.
type Fields<S> = (Mat3<S>, [Vec3<S>; 4]);

#[inline(always)]
fn fields<S: Scalar, G: Shape<S>>(class: &G, x: &Corners<S>) -> Fields<S> {
    let f = mean_gradient(class, x);
    (f, hourglass_modes(class, x, &f))
}

/// From the fields of the positions, and of the velocities where there is viscosity: everything but the corner forces, the
/// mean first Piola stress, and the hourglass forces.
#[inline(always)]
fn force<S: Scalar, L: Hyperelastic, V: Viscosity, G: Shape<S>, R: Memory<S>>(
    law: &L,
    viscosity: &V,
    class: &G,
    (f, mut hourglass): Fields<S>,
    rates: Option<Fields<S>>,
    memory: &mut R,
) -> (Force<S>, Mat3<S>, [Vec3<S>; 4]) {
    let cof = cofactor(&f);
    let j = dot(f[0], cof[0]);
    let gram = hex8::gram(&f);
    let k = hex8::invariants::<S, L, _>(&gram, &Identity);
    let d = law.derivatives(k.i1, k.i2, j);
    let one = S::one();
    let s = hex8::second_piola::<S, L, _>(&k, &d, &Identity, one);
    let mut p = hex8::times_second_piola::<S, L>(&f, &s);
    let mut pressure = d.wj + law.dU(j);
    let (mut power, mut work, mut loss) = (S::zero(), S::zero(), S::zero());
    if let Some((rate, rates)) = rates {
        if V::REMEMBERS {
            let change = change(&f, &rate, memory.before());
            let at = Deformed { gram, cof, det: j, j, isochoric: s, wj: d.wj, change };
            let over = overstress(memory, 0, &at);
            p = plus_product(&p, &f, &over.stress);
            pressure += over.pressure / j;
            work = over.work * class.volume();
            loss = over.loss * class.volume();
        }
        let l = velocity_gradient(&rate, &cof);
        let (viscous, density) = viscosity.stress(&l, j, one);
        power += density * class.volume();
        let mut stress = hex8::with_pressure(viscous, pressure);
        let eta = class.hourglass_viscosity();
        let density = eta / (class.volume() * j);
        for h in 0..4 {
            let (mode, turning) = (hourglass[h], viscosity.turning(&l, j, hourglass[h], rates[h]));
            hourglass[h] = axpy(turning, eta, scale(mode, class.hourglass_stiffness()));
            // Without this part of the stress, q x dq/dt would be a moment on the whole element.
            for c in 0..3 {
                stress[c] = axpy(mode, density * turning[c], stress[c]);
            }
            let carried = combined(&l, mode[0], mode[1], mode[2]);
            power += eta * (dot(turning, rates[h]) + dot(turning, carried) / j);
        }
        for c in 0..3 {
            p[c] = add(p[c], combined(&stress, cof[c][0], cof[c][1], cof[c][2]));
        }
    } else {
        for q in &mut hourglass {
            *q = scale(*q, class.hourglass_stiffness());
        }
        for c in 0..3 {
            p[c] = axpy(cof[c], pressure, p[c]);
        }
    }
    let none = [[S::zero(); 3]; 8];
    let force = Force { f: none, min_j: j, viscous_power: power, memory_work: work, memory_loss: loss };
    (force, p, hourglass)
}

/// P + F S
#[inline(always)]
fn plus_product<S: Scalar>(p: &Mat3<S>, f: &Mat3<S>, s: &Sym3<S>) -> Mat3<S> {
    let s = s.columns();
    [
        add(p[0], combined(f, s[0][0], s[0][1], s[0][2])),
        add(p[1], combined(f, s[1][0], s[1][1], s[1][2])),
        add(p[2], combined(f, s[2][0], s[2][1], s[2][2])),
    ]
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

/// [`mean_gradient`] along the element's axes and [`hourglass_modes`] from sums over edges, which are differences first.
#[inline(always)]
fn extruded_fields<S: Scalar, G: Shape<S>>(class: &G, x: &Corners<S>) -> Fields<S> {
    let two = S::from_f64(2.0);
    // Edges along xi by the signs of (eta, zeta): --, +-, -+, ++; and one edge along eta at each zeta, one along zeta.
    let edges = [sub(x[1], x[0]), sub(x[2], x[3]), sub(x[5], x[4]), sub(x[6], x[7])];
    let (low, high) = (sub(x[3], x[0]), sub(x[7], x[4]));
    let up = sub(x[4], x[0]);
    let (sum_low, sum_high) = (add(edges[0], edges[1]), add(edges[2], edges[3]));
    let (turn_low, turn_high) = (sub(edges[1], edges[0]), sub(edges[3], edges[2]));
    let (xi, xi_zeta) = (add(sum_low, sum_high), sub(sum_high, sum_low));
    let (xi_eta, xi_eta_zeta) = (add(turn_low, turn_high), sub(turn_high, turn_low));
    // The other edge along eta follows from the two along xi beside it.
    let (eta_low, eta_high) = (axpy(low, two, turn_low), axpy(high, two, turn_high));
    let (eta, eta_zeta) = (add(eta_low, eta_high), sub(eta_high, eta_low));
    let zeta_low = axpy(up, two, sub(edges[2], edges[0]));
    let zeta = axpy(zeta_low, two, eta_zeta);
    let f = [
        axpy(xi, class.extruded(0), scale(zeta, class.extruded(2))),
        axpy(eta, class.extruded(4), axpy(xi_eta, class.extruded(5), scale(eta_zeta, class.extruded(6)))),
        axpy(xi, class.extruded(1), scale(zeta, class.extruded(3))),
    ];
    let bent = axpy(f[0], -class.extruded(7), axpy(f[2], -class.extruded(8), xi_zeta));
    (f, [eta_zeta, bent, xi_eta, xi_eta_zeta])
}

/// [`corner_forces`] likewise.
#[inline(always)]
fn extruded_forces<S: Scalar, G: Shape<S>>(class: &G, p: &Mat3<S>, hourglass: &[Vec3<S>; 4]) -> Corners<S> {
    let [eta_zeta, bent, xi_eta, xi_eta_zeta] = *hourglass;
    let volume = class.volume();
    let p = [
        axpy(bent, -class.extruded(7), scale(p[0], volume)),
        scale(p[1], volume),
        axpy(bent, -class.extruded(8), scale(p[2], volume)),
    ];
    // Forces by pattern; `even` and `odd` in eta, at the corners (xi, zeta) = --, +-, ++, -+.
    let xi = axpy(p[0], class.extruded(0), scale(p[2], class.extruded(1)));
    let zeta = axpy(p[0], class.extruded(2), scale(p[2], class.extruded(3)));
    let eta = scale(p[1], class.extruded(4));
    let xi_eta = axpy(p[1], class.extruded(5), xi_eta);
    let eta_zeta = axpy(p[1], class.extruded(6), eta_zeta);
    let (along, across) = (add(xi, zeta), sub(xi, zeta));
    let even = [sub(bent, along), sub(across, bent), add(along, bent), neg(add(across, bent))];
    let (a, b) = (sub(eta, eta_zeta), add(eta, eta_zeta));
    let (s, t) = (sub(xi_eta, xi_eta_zeta), add(xi_eta, xi_eta_zeta));
    let odd = [sub(a, s), add(a, s), add(b, t), sub(b, t)];
    // Corners 0 1 2 3 are (xi, eta) = -- +- ++ -+ at zeta -, 4 to 7 the same at zeta +.
    [
        sub(even[0], odd[0]),
        sub(even[1], odd[1]),
        add(even[1], odd[1]),
        add(even[0], odd[0]),
        sub(even[3], odd[3]),
        sub(even[2], odd[2]),
        add(even[2], odd[2]),
        add(even[3], odd[3]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::{Class, ExtrudedFull, ExtrudedQ1p0, Full, Q1p0};
    use crate::material::{Forgetful, Inviscid, KelvinVoigt, MooneyRivlin};

    /// All routines on plane figures extruded along eta, in any direction of space, deformed and moving at random.
    #[test]
    fn an_extruded_element_has_the_forces_of_any_element() {
        let law = MooneyRivlin { g0: 4e7, g1: 1e6, g2: 3e5 };
        let (still, moving) = (Inviscid, KelvinVoigt::new(20.0));
        let mut state = 7u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        for turn in 0..20 {
            // Corners of the figure, and axes by Rodrigues' formula.
            let figure = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
                .map(|[a, b]: [f64; 2]| [2e-3 * (a + 0.2 * next()), 3e-3 * (b + 0.2 * next())]);
            let axis = glam::DVec3::new(next(), next(), next()).normalize();
            let rotation = glam::DQuat::from_axis_angle(axis, f64::from(turn));
            let at = |[a, b]: [f64; 2], along: f64| (rotation * glam::DVec3::new(a, along, b)).to_array();
            let (near, far) = (figure.map(|p| at(p, 0.0)), figure.map(|p| at(p, 1.5e-3)));
            let X = [near[0], near[1], far[1], far[0], near[3], near[2], far[2], far[3]];
            let class = Class::new(&X, 1e5, 2.0).expect("no figure is that far from a rectangle");
            assert!(class.is_extruded());
            let x = X.map(|X| X.map(|c| c + 3e-4 * next()));
            let v = X.map(|_| [next(), next(), next()]);
            let pairs = [
                (
                    UniformGradient::force(&law, &still, &class, &x, &v, &mut Forgetful),
                    ExtrudedUniformGradient::force(&law, &still, &class, &x, &v, &mut Forgetful),
                ),
                (
                    UniformGradient::force(&law, &moving, &class, &x, &v, &mut Forgetful),
                    ExtrudedUniformGradient::force(&law, &moving, &class, &x, &v, &mut Forgetful),
                ),
                (
                    Full::force(&law, &moving, &class, &x, &v, &mut Forgetful),
                    ExtrudedFull::force(&law, &moving, &class, &x, &v, &mut Forgetful),
                ),
                (
                    Q1p0::force(&law, &still, &class, &x, &v, &mut Forgetful),
                    ExtrudedQ1p0::force(&law, &still, &class, &x, &v, &mut Forgetful),
                ),
                (
                    Q1p0::force(&law, &moving, &class, &x, &v, &mut Forgetful),
                    ExtrudedQ1p0::force(&law, &moving, &class, &x, &v, &mut Forgetful),
                ),
            ];
            for (any, extruded) in pairs {
                let most = any.f.as_flattened().iter().fold(0.0f64, |m, f| m.max(f.abs()));
                for (a, b) in any.f.as_flattened().iter().zip(extruded.f.as_flattened()) {
                    // Round-off, amplified by what cancels: the bulk modulus is some ten times the shear modulus.
                    assert!((a - b).abs() < 1e-11 * most, "{any:?} {extruded:?}");
                }
                assert!((any.min_j - extruded.min_j).abs() < 1e-12);
                assert!(
                    (any.viscous_power - extruded.viscous_power).abs() <= 1e-11 * any.viscous_power.abs()
                );
            }
        }
    }
}

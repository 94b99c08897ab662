use super::hex8::{self, Corners, Shape};
use super::{Class, Energy, Force, Formulation};
use crate::material::{Deformed, Hyperelastic, Memory, Viscosity, change, overstress, velocity_gradient};
use crate::scalar::Scalar;
use crate::tensor::{InPlane, Mat3, Metric, Sym3, Vec3, axpy, cofactor, combined, det, dot, scale};
use std::ops::Range;

/// 2x2x2 points for the isochoric part, one element pressure p = U'(v/V) (Simo, Taylor & Pister's mean
/// dilatation): no volumetric locking. dv/dx_a comes from cof A.
pub type Q1p0 = Q1p0Of<false>;

/// The same for elements that are all extruded along eta ([`super::Class::is_extruded`]), as those of a ring or a block: a
/// sixth fewer operations.
pub type ExtrudedQ1p0 = Q1p0Of<true>;

/// Either of them.
#[derive(Debug, Clone, Copy)]
pub struct Q1p0Of<const EXTRUDED: bool>;

impl<const EXTRUDED: bool> Formulation for Q1p0Of<EXTRUDED> {
    const NUMBERS: Range<usize> = Class::<f64>::OF_POINTS;
    const POINTS: usize = 8;

    #[inline(always)]
    fn force<S: Scalar, L: Hyperelastic, V: Viscosity, G: Shape<S>, R: Memory<S>>(
        law: &L,
        viscosity: &V,
        class: &G,
        x: &Corners<S>,
        v: &Corners<S>,
        memory: &mut R,
    ) -> Force<S> {
        let pressure = law.dU(hex8::volume(x) * class.inverse_volume());
        points::<S, L, V, G, R, false, EXTRUDED>(
            law,
            viscosity,
            class,
            &hex8::gradients(x),
            v,
            pressure,
            memory,
        )
    }

    #[inline(always)]
    fn energy<S: Scalar, L: Hyperelastic, G: Shape<S>>(law: &L, class: &G, x: &Corners<S>) -> Energy<S> {
        let columns = hex8::gradients(x);
        let volume = hex8::volume(x);
        let mut energy = pointwise_energy::<S, L, G, false>(law, class, &columns);
        energy.strain += class.volume() * law.U(volume * class.inverse_volume());
        energy
    }
}

/// What the points add to a Gauss line. Both points of a line have its column of A in common, so what multiplies that is
/// summed first, and its square is computed once.
#[derive(Clone, Copy)]
struct Line<S> {
    force: Vec3<S>,
    /// Second Piola stress along the line: at its first point, or, of lines along zeta, at all so far.
    along: S,
    /// Square of the column.
    square: S,
}

/// What the points report beside their forces: the smallest det F, and what viscosity and memory do.
struct Report<S> {
    min_j: S,
    power: S,
    work: S,
    loss: S,
}

/// All points. `POINTWISE`: the pressure is U'(J) of the point, not the element's `mean`; `EXTRUDED`: so are the elements.
#[inline(always)]
pub(super) fn points<
    S: Scalar,
    L: Hyperelastic,
    V: Viscosity,
    G: Shape<S>,
    R: Memory<S>,
    const POINTWISE: bool,
    const EXTRUDED: bool,
>(
    law: &L,
    viscosity: &V,
    class: &G,
    columns: &hex8::LineColumns<S>,
    v: &Corners<S>,
    mean: S,
    memory: &mut R,
) -> Force<S> {
    let zero = S::zero();
    let rates = if V::ON { hex8::gradients(v) } else { [[[zero; 3]; 4]; 3] };
    let none = Line { force: [zero; 3], along: zero, square: zero };
    let (mut xi, mut eta, mut zeta) = ([none; 4], [none; 4], [none; 4]);
    zeta[0].square = dot(columns[2][0], columns[2][0]);
    zeta[1].square = dot(columns[2][1], columns[2][1]);
    zeta[2].square = dot(columns[2][2], columns[2][2]);
    zeta[3].square = dot(columns[2][3], columns[2][3]);
    let mut report = Report { min_j: S::from_f64(1e30), power: zero, work: zero, loss: zero };
    // A point by the signs of xi, eta and zeta (0: minus).
    macro_rules! point {
        ($right:expr, $up:expr, $far:expr) => {
            let (i, j, k) = ($up + 2 * $far, $right + 2 * $far, $right + 2 * $up);
            let q = $right + 2 * $up + 4 * $far;
            let given = (law, viscosity, class, q);
            let a = [columns[0][i], columns[1][j], columns[2][k]];
            let rate = [rates[0][i], rates[1][j], rates[2][k]];
            let lines = (&mut xi[i], &mut eta[j], &mut zeta[k]);
            let first = ($right == 0, $up == 0, $far == 0);
            if EXTRUDED {
                let metric = InPlane(class.metric(q));
                point::<S, L, V, G, _, R, POINTWISE>(
                    given,
                    &metric,
                    (a, rate, mean),
                    lines,
                    first,
                    memory,
                    &mut report,
                );
            } else {
                let metric = class.metric(q);
                point::<S, L, V, G, _, R, POINTWISE>(
                    given,
                    &metric,
                    (a, rate, mean),
                    lines,
                    first,
                    memory,
                    &mut report,
                );
            }
        };
    }
    // With its signs known a point's lines are registers, or places on the stack, and no addresses to be computed.
    // Unrolled code takes long to compile: `full` on elements of any shape goes without, and points that remember, whose time goes
    // to memory.
    if S::UNROLLED && L::UNROLLED && (EXTRUDED || !POINTWISE) && !V::REMEMBERS {
        point!(0, 0, 0);
        point!(1, 0, 0);
        point!(0, 1, 0);
        point!(1, 1, 0);
        point!(0, 0, 1);
        point!(1, 0, 1);
        point!(0, 1, 1);
        point!(1, 1, 1);
    } else {
        for far in 0..2 {
            for up in 0..2 {
                for right in 0..2 {
                    point!(right, up, far);
                }
            }
        }
    }
    macro_rules! zeta {
        ($k:literal) => {
            axpy(columns[2][$k], zeta[$k].along, zeta[$k].force)
        };
    }
    let forces = [
        [xi[0].force, xi[1].force, xi[2].force, xi[3].force],
        [eta[0].force, eta[1].force, eta[2].force, eta[3].force],
        [zeta!(0), zeta!(1), zeta!(2), zeta!(3)],
    ];
    let Report { min_j, power, work, loss } = report;
    Force { f: hex8::scatter(&forces), min_j, viscous_power: power, memory_work: work, memory_loss: loss }
}

/// Point q, after those before it: adds to its `lines` along xi, eta and zeta, of which it may be the `first` point, and to the
/// report. `a` and `rate`: columns of A and of its rate.
///
/// Without loops: every point of every kernel has its own copy of this, and of a loop a compiler makes much before it unrolls it.
#[inline(always)]
fn point<
    S: Scalar,
    L: Hyperelastic,
    V: Viscosity,
    G: Shape<S>,
    M: Metric<S>,
    R: Memory<S>,
    const POINTWISE: bool,
>(
    (law, viscosity, class, q): (&L, &V, &G, usize),
    metric: &M,
    (a, rate, mean): (Mat3<S>, Mat3<S>, S),
    (xi, eta, zeta): (&mut Line<S>, &mut Line<S>, &mut Line<S>),
    first: (bool, bool, bool),
    memory: &mut R,
    report: &mut Report<S>,
) {
    let is_full = const { L::HAS_I2 || V::REMEMBERS };
    let (zero, weight) = (S::zero(), S::from_f64(hex8::WEIGHT));
    if first.0 {
        xi.square = dot(a[0], a[0]);
    }
    if first.1 {
        eta.square = dot(a[1], a[1]);
    }
    let gram = Sym3 {
        xx: xi.square,
        yy: eta.square,
        zz: zeta.square,
        xy: if M::XY || is_full { dot(a[0], a[1]) } else { zero },
        xz: if M::XZ || is_full { dot(a[0], a[2]) } else { zero },
        yz: if M::YZ || is_full { dot(a[1], a[2]) } else { zero },
    };
    let cof = cofactor(&a);
    let det_a = dot(a[0], cof[0]);
    let j = det_a * class.inverse_det_j0(q);
    let k = hex8::invariants::<S, L, M>(&gram, metric);
    let d = law.derivatives(k.i1, k.i2, j);
    let mut pressure = (d.wj + if POINTWISE { law.dU(j) } else { mean }) * weight;
    let mut remembered = Sym3::zero();
    if V::REMEMBERS {
        let isochoric = hex8::second_piola::<S, L, M>(&k, &d, metric, S::one());
        let change = change(&a, &rate, memory.before());
        let over = overstress(memory, q, &Deformed { gram, cof, det: det_a, j, isochoric, wj: d.wj, change });
        let dv = class.det_j0(q);
        remembered = over.stress.scaled(dv);
        pressure += over.pressure * weight / j;
        report.work += over.work * dv;
        report.loss += over.loss * dv;
    }
    let mut stress = [[zero; 3]; 3];
    if V::ON {
        let (viscous, point_power) = viscosity.stress(&velocity_gradient(&rate, &cof), det_a, weight);
        report.power += point_power;
        stress = hex8::with_pressure(viscous, pressure);
    }
    // A line's sum is read and written once: with places that a compiler cannot tell apart, each addition would be.
    macro_rules! pushed {
        ($line:ident, $first:expr, $c:expr) => {
            match (V::ON, $first) {
                (false, true) => scale($c, pressure),
                (false, false) => axpy($c, pressure, $line.force),
                (true, true) => combined(&stress, $c[0], $c[1], $c[2]),
                (true, false) => {
                    axpy(stress[0], $c[0], axpy(stress[1], $c[1], axpy(stress[2], $c[2], $line.force)))
                }
            }
        };
    }
    let (mut x, mut y) = (pushed!(xi, first.0, cof[0]), pushed!(eta, first.1, cof[1]));
    let mut z = pushed!(zeta, first.2, cof[2]);
    let mut s = hex8::second_piola::<S, L, M>(&k, &d, metric, class.det_j0(q));
    if V::REMEMBERS {
        s = s.plus(S::one(), &remembered);
    }
    if M::XY || is_full {
        x = axpy(a[1], s.xy, x);
        y = axpy(a[0], s.xy, y);
    }
    if M::XZ || is_full {
        x = axpy(a[2], s.xz, x);
        z = axpy(a[0], s.xz, z);
    }
    if M::YZ || is_full {
        y = axpy(a[2], s.yz, y);
        z = axpy(a[1], s.yz, z);
    }
    if first.0 {
        xi.along = s.xx;
    } else {
        x = axpy(a[0], xi.along + s.xx, x);
    }
    if first.1 {
        eta.along = s.yy;
    } else {
        y = axpy(a[1], eta.along + s.yy, y);
    }
    zeta.along = if first.2 { s.zz } else { zeta.along + s.zz };
    (xi.force, eta.force, zeta.force) = (x, y, z);
    report.min_j = report.min_j.min(j);
}

#[inline(always)]
pub(super) fn pointwise_energy<S: Scalar, L: Hyperelastic, G: Shape<S>, const POINTWISE: bool>(
    law: &L,
    class: &G,
    columns: &hex8::LineColumns<S>,
) -> Energy<S> {
    let (mut strain, mut min_j) = (S::zero(), S::from_f64(1e30));
    for q in 0..8 {
        let a = hex8::at(columns, q);
        let j = det(&a) * class.inverse_det_j0(q);
        let k = hex8::invariants::<S, L, _>(&hex8::gram(&a), &class.metric(q));
        let volumetric = if POINTWISE { law.U(j) } else { S::zero() };
        strain += class.det_j0(q) * (law.psi(k.i1, k.i2, j) + volumetric);
        min_j = min_j.min(j);
    }
    Energy { strain, hourglass: S::zero(), min_j }
}

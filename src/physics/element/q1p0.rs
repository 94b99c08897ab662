use super::hex8::{self, Corners, Shape};
use super::{Class, Energy, Force, Formulation};
use crate::material::{Hyperelastic, Viscosity};
use crate::scalar::Scalar;
use crate::tensor::{InPlane, Metric, Sym3, axpy, cofactor, combined, det, dot, scale};
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

    #[inline(always)]
    fn force<S: Scalar, L: Hyperelastic, V: Viscosity, G: Shape<S>>(
        law: &L,
        viscosity: &V,
        class: &G,
        x: &Corners<S>,
        v: &Corners<S>,
    ) -> Force<S> {
        let pressure = law.dU(hex8::volume(x) * class.inverse_volume());
        points::<S, L, V, G, false, EXTRUDED>(law, viscosity, class, &hex8::gradients(x), v, pressure)
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

/// What the points add to the Gauss lines. Both points of a line have its column of A in common, so what multiplies that is
/// summed first, and its square is computed once.
struct LineSums<S> {
    forces: hex8::LineColumns<S>,
    /// Second Piola stress along the line: at its first point, or, of lines along zeta, at all so far.
    along: [[S; 4]; 3],
    squares: [[S; 4]; 3],
}

/// All points. `POINTWISE`: the pressure is U'(J) of the point, not the element's `mean`; `EXTRUDED`: so are the elements.
#[inline(always)]
pub(super) fn points<
    S: Scalar,
    L: Hyperelastic,
    V: Viscosity,
    G: Shape<S>,
    const POINTWISE: bool,
    const EXTRUDED: bool,
>(
    law: &L,
    viscosity: &V,
    class: &G,
    columns: &hex8::LineColumns<S>,
    v: &Corners<S>,
    mean: S,
) -> Force<S> {
    let zero = S::zero();
    let rates = if V::ON { hex8::gradients(v) } else { [[[zero; 3]; 4]; 3] };
    let mut sums = LineSums { forces: [[[zero; 3]; 4]; 3], along: [[zero; 4]; 3], squares: [[zero; 4]; 3] };
    for line in 0..4 {
        sums.squares[2][line] = dot(columns[2][line], columns[2][line]);
    }
    let mut all = (sums, S::from_f64(1e30), zero);
    macro_rules! point {
        ($low:expr, $half:expr) => {
            let (given, fields) = ((law, viscosity, class), (columns, &rates, mean));
            if EXTRUDED {
                let metric = InPlane(class.metric($low + 4 * $half));
                point::<S, L, V, G, _, POINTWISE>(given, &metric, fields, $low, $half, &mut all);
            } else {
                let metric = class.metric($low + 4 * $half);
                point::<S, L, V, G, _, POINTWISE>(given, &metric, fields, $low, $half, &mut all);
            }
        };
    }
    // With its number known a point's lines are registers, or places on the stack, and no addresses to be computed.
    // Unrolled code takes long to compile: `full` on elements of any shape goes without.
    if S::UNROLLED && (EXTRUDED || !POINTWISE) {
        point!(0, 0);
        point!(1, 0);
        point!(2, 0);
        point!(3, 0);
        point!(0, 1);
        point!(1, 1);
        point!(2, 1);
        point!(3, 1);
    } else {
        for half in 0..2 {
            for low in 0..4 {
                point!(low, half);
            }
        }
    }
    let (mut sums, min_j, viscous_power) = all;
    for line in 0..4 {
        sums.forces[2][line] = axpy(columns[2][line], sums.along[2][line], sums.forces[2][line]);
    }
    Force { f: hex8::scatter(&sums.forces), min_j, viscous_power }
}

/// Point `low` (bits: the signs of xi and eta) of the half at the sign `half` of zeta, after those before it: adds to the lines, the
/// smallest det F and the viscous power.
#[inline(always)]
fn point<S: Scalar, L: Hyperelastic, V: Viscosity, G: Shape<S>, M: Metric<S>, const POINTWISE: bool>(
    (law, viscosity, class): (&L, &V, &G),
    metric: &M,
    (columns, rates, mean): (&hex8::LineColumns<S>, &hex8::LineColumns<S>, S),
    low: usize,
    half: usize,
    (sums, min_j, power): &mut (LineSums<S>, S, S),
) {
    let (zero, weight) = (S::zero(), S::from_f64(hex8::WEIGHT));
    let q = low + 4 * half;
    let (right, up) = (low & 1, low >> 1);
    let lines = [up + 2 * half, right + 2 * half, low];
    // Whether this is the first point of its line.
    let first = [right == 0, up == 0, half == 0];
    let a = [columns[0][lines[0]], columns[1][lines[1]], columns[2][lines[2]]];
    for d in 0..2 {
        if first[d] {
            sums.squares[d][lines[d]] = dot(a[d], a[d]);
        }
    }
    let gram = Sym3 {
        xx: sums.squares[0][lines[0]],
        yy: sums.squares[1][lines[1]],
        zz: sums.squares[2][lines[2]],
        xy: if M::XY || L::HAS_I2 { dot(a[0], a[1]) } else { zero },
        xz: if M::XZ || L::HAS_I2 { dot(a[0], a[2]) } else { zero },
        yz: if M::YZ || L::HAS_I2 { dot(a[1], a[2]) } else { zero },
    };
    let cof = cofactor(&a);
    let det_a = dot(a[0], cof[0]);
    let j = det_a * class.inverse_det_j0(q);
    let k = hex8::invariants::<S, L, M>(&gram, metric);
    let d = law.derivatives(k.i1, k.i2, j);
    let pressure = (d.wj + if POINTWISE { law.dU(j) } else { mean }) * weight;
    let mut stress = [[zero; 3]; 3];
    if V::ON {
        let rate = [rates[0][lines[0]], rates[1][lines[1]], rates[2][lines[2]]];
        let (viscous, point_power) = viscosity.stress(&rate, &cof, det_a, weight);
        *power += point_power;
        stress = hex8::with_pressure(viscous, pressure);
    }
    // A line's sum is read and written once: with places that a compiler cannot tell apart, each addition would be.
    let mut g = [[zero; 3]; 3];
    for d in 0..3 {
        let (before, c) = (sums.forces[d][lines[d]], cof[d]);
        g[d] = match (V::ON, first[d]) {
            (false, true) => scale(c, pressure),
            (false, false) => axpy(c, pressure, before),
            (true, true) => combined(&stress, c[0], c[1], c[2]),
            (true, false) => axpy(stress[0], c[0], axpy(stress[1], c[1], axpy(stress[2], c[2], before))),
        };
    }
    let s = hex8::second_piola::<S, L, M>(&k, &d, metric, class.det_j0(q));
    if M::XY || L::HAS_I2 {
        g[0] = axpy(a[1], s.xy, g[0]);
        g[1] = axpy(a[0], s.xy, g[1]);
    }
    if M::XZ || L::HAS_I2 {
        g[0] = axpy(a[2], s.xz, g[0]);
        g[2] = axpy(a[0], s.xz, g[2]);
    }
    if M::YZ || L::HAS_I2 {
        g[1] = axpy(a[2], s.yz, g[1]);
        g[2] = axpy(a[1], s.yz, g[2]);
    }
    let own = [s.xx, s.yy];
    for d in 0..2 {
        if first[d] {
            sums.along[d][lines[d]] = own[d];
        } else {
            g[d] = axpy(a[d], sums.along[d][lines[d]] + own[d], g[d]);
        }
    }
    sums.along[2][low] = if first[2] { s.zz } else { sums.along[2][low] + s.zz };
    for d in 0..3 {
        sums.forces[d][lines[d]] = g[d];
    }
    *min_j = min_j.min(j);
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

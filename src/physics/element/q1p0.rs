use super::hex8::{self, Corners, Shape};
use super::{Energy, Force, Formulation};
use crate::physics::material::{Law, Viscosity};
use crate::physics::scalar::Scalar;
use crate::physics::tensor::{InPlane, Metric, Sym3, Vec3, axpy, cofactor, det, dot, scale};

/// 2x2x2 points for the isochoric part, one element pressure p = U'(v/V) (Simo, Taylor & Pister's mean
/// dilatation): no volumetric locking. dv/dx_a comes from cof A.
#[derive(Debug, Clone, Copy)]
pub struct Q1p0;

impl Formulation for Q1p0 {
    #[inline(always)]
    fn force<S: Scalar, L: Law<S>, V: Viscosity<S>, G: Shape<S>>(
        law: &L,
        viscosity: &V,
        class: &G,
        x: &Corners<S>,
        v: &Corners<S>,
    ) -> Force<S> {
        mean_dilatation::<S, L, V, G, false>(law, viscosity, class, x, v)
    }

    #[inline(always)]
    fn energy<S: Scalar, L: Law<S>, G: Shape<S>>(law: &L, class: &G, x: &Corners<S>) -> Energy<S> {
        let columns = hex8::gradients(x);
        let volume = hex8::volume(x);
        let mut energy = pointwise_energy::<S, L, G, false>(law, class, &columns);
        energy.strain += class.volume() * law.U(volume * class.inverse_volume());
        energy
    }
}

/// The same for elements that are all extruded along eta ([`super::Class::is_extruded`]), as those of a ring or a block: a
/// tenth fewer operations.
#[derive(Debug, Clone, Copy)]
pub struct ExtrudedQ1p0;

impl Formulation for ExtrudedQ1p0 {
    #[inline(always)]
    fn force<S: Scalar, L: Law<S>, V: Viscosity<S>, G: Shape<S>>(
        law: &L,
        viscosity: &V,
        class: &G,
        x: &Corners<S>,
        v: &Corners<S>,
    ) -> Force<S> {
        mean_dilatation::<S, L, V, G, true>(law, viscosity, class, x, v)
    }

    #[inline(always)]
    fn energy<S: Scalar, L: Law<S>, G: Shape<S>>(law: &L, class: &G, x: &Corners<S>) -> Energy<S> {
        Q1p0::energy(law, class, x)
    }
}

#[inline(always)]
fn mean_dilatation<S: Scalar, L: Law<S>, V: Viscosity<S>, G: Shape<S>, const EXTRUDED: bool>(
    law: &L,
    viscosity: &V,
    class: &G,
    x: &Corners<S>,
    v: &Corners<S>,
) -> Force<S> {
    let pressure = law.dU(hex8::volume(x) * class.inverse_volume());
    let columns = hex8::gradients(x);
    points::<S, L, V, G, false, EXTRUDED>(law, viscosity, class, &columns, v, pressure)
}

/// What the points add to the Gauss lines. Both points of a line have its column of A in common, so what multiplies that is
/// summed first, and its square is computed once.
struct LineSums<S> {
    forces: hex8::LineColumns<S>,
    /// Second Piola stress along the line at its first point.
    along: [[S; 4]; 3],
    squares: [[S; 4]; 3],
}

impl<S: Scalar> LineSums<S> {
    /// Adds `of` times `by` to line `line` along `d`, or, if this is the first that it gets, sets it.
    #[inline(always)]
    fn add(&mut self, first: bool, d: usize, line: usize, of: Vec3<S>, by: S) {
        let sum = &mut self.forces[d][line];
        *sum = if first { scale(of, by) } else { axpy(of, by, *sum) };
    }
}

/// All points. `POINTWISE`: the pressure is U'(J) of the point, not the element's `mean`; `EXTRUDED`: so are the elements.
#[inline(always)]
pub(super) fn points<
    S: Scalar,
    L: Law<S>,
    V: Viscosity<S>,
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
    let sums = LineSums { forces: [[[zero; 3]; 4]; 3], along: [[zero; 4]; 3], squares: [[zero; 4]; 3] };
    let mut all = (sums, S::from_f64(1e30), zero);
    // With its number known a point's lines are registers, or places on the stack, and no addresses to be computed.
    macro_rules! point {
        ($q:expr) => {
            if EXTRUDED {
                let metric = InPlane(class.metric($q));
                point::<S, L, V, G, _, POINTWISE>(
                    (law, viscosity, class),
                    &metric,
                    columns,
                    &rates,
                    mean,
                    $q,
                    &mut all,
                );
            } else {
                let metric = class.metric($q);
                point::<S, L, V, G, _, POINTWISE>(
                    (law, viscosity, class),
                    &metric,
                    columns,
                    &rates,
                    mean,
                    $q,
                    &mut all,
                );
            }
        };
    }
    // Unrolled code takes long to compile: it is kept to the case that most runs are.
    if S::UNROLLED && EXTRUDED {
        point!(0);
        point!(1);
        point!(2);
        point!(3);
        point!(4);
        point!(5);
        point!(6);
        point!(7);
    } else {
        for q in 0..8 {
            point!(q);
        }
    }
    let (sums, min_j, viscous_power) = all;
    Force { f: hex8::scatter(&sums.forces), min_j, viscous_power }
}

/// Point q, after those before it: adds to the lines, the smallest det F and the viscous power.
#[inline(always)]
fn point<S: Scalar, L: Law<S>, V: Viscosity<S>, G: Shape<S>, M: Metric<S>, const POINTWISE: bool>(
    (law, viscosity, class): (&L, &V, &G),
    metric: &M,
    columns: &hex8::LineColumns<S>,
    rates: &hex8::LineColumns<S>,
    mean: S,
    q: usize,
    (sums, min_j, power): &mut (LineSums<S>, S, S),
) {
    let (zero, weight) = (S::zero(), S::from_f64(hex8::WEIGHT));
    let lines = hex8::lines(q);
    // Whether this is the first point of its line along xi, eta, zeta.
    let first = [q & 1 == 0, q >> 1 & 1 == 0, q >> 2 & 1 == 0];
    let a = hex8::at(columns, q);
    for d in 0..3 {
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
    let d = law.first_piola(k.i1, k.i2, j);
    let pressure = (d.wj + if POINTWISE { law.dU(j) } else { mean }) * weight;
    if V::ON {
        let (viscous, point_power) = viscosity.stress(&hex8::at(rates, q), &cof, det_a, weight);
        *power += point_power;
        let stress = hex8::with_pressure(viscous, pressure);
        for d in 0..3 {
            sums.add(first[d], d, lines[d], stress[0], cof[d][0]);
            sums.add(false, d, lines[d], stress[1], cof[d][1]);
            sums.add(false, d, lines[d], stress[2], cof[d][2]);
        }
    } else {
        for d in 0..3 {
            sums.add(first[d], d, lines[d], cof[d], pressure);
        }
    }
    let s = hex8::second_piola::<S, L, M>(&k, &d, metric, class.det_j0(q));
    if M::XY || L::HAS_I2 {
        sums.add(false, 0, lines[0], a[1], s.xy);
        sums.add(false, 1, lines[1], a[0], s.xy);
    }
    if M::XZ || L::HAS_I2 {
        sums.add(false, 0, lines[0], a[2], s.xz);
        sums.add(false, 2, lines[2], a[0], s.xz);
    }
    if M::YZ || L::HAS_I2 {
        sums.add(false, 1, lines[1], a[2], s.yz);
        sums.add(false, 2, lines[2], a[1], s.yz);
    }
    let own = [s.xx, s.yy, s.zz];
    for d in 0..3 {
        if first[d] {
            sums.along[d][lines[d]] = own[d];
        } else {
            let both = sums.along[d][lines[d]] + own[d];
            sums.add(false, d, lines[d], a[d], both);
        }
    }
    *min_j = min_j.min(j);
}

#[inline(always)]
pub(super) fn pointwise_energy<S: Scalar, L: Law<S>, G: Shape<S>, const POINTWISE: bool>(
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

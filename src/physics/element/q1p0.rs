use super::hex8::{self, Corners, Shape};
use super::{Energy, Force, Formulation};
use crate::physics::material::{Law, Viscosity};
use crate::physics::scalar::Scalar;
use crate::physics::tensor::{cofactor, det, dot};

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
    let (zero, weight) = (S::zero(), S::from_f64(hex8::WEIGHT));
    let rates = if V::ON { hex8::gradients(v) } else { [[[zero; 3]; 4]; 3] };
    let mut lines = [[[zero; 3]; 4]; 3];
    let (mut min_j, mut power) = (S::from_f64(1e30), zero);
    // With its number known a point's lines are registers, or places on the stack, and no addresses to be computed.
    macro_rules! point {
        ($q:expr) => {{
            let q = $q;
            let a = hex8::at(columns, q);
            let cof = cofactor(&a);
            let det_a = dot(a[0], cof[0]);
            let j = det_a * class.inverse_det_j0(q);
            let k = hex8::kinematics::<S, L, EXTRUDED>(&a, &class.metric(q));
            let d = law.first_piola(k.i1, k.i2, j);
            let pressure = if POINTWISE { law.dU(j) } else { mean };
            let dv = class.det_j0(q);
            let g = if V::ON {
                let (viscous, point_power) = viscosity.stress(&hex8::at(&rates, q), &cof, det_a, weight);
                power += point_power;
                hex8::force_matrix::<S, L>(&k, &d, pressure, &cof, dv, weight, Some(&viscous))
            } else {
                hex8::force_matrix::<S, L>(&k, &d, pressure, &cof, dv, weight, None)
            };
            min_j = min_j.min(j);
            hex8::accumulate(&mut lines, q, &g);
        }};
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
    Force { f: hex8::scatter(&lines), min_j, viscous_power: power }
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
        let k = hex8::kinematics::<S, L, false>(&a, &class.metric(q));
        let volumetric = if POINTWISE { law.U(j) } else { S::zero() };
        strain += class.det_j0(q) * (law.psi(k.i1, k.i2, j) + volumetric);
        min_j = min_j.min(j);
    }
    Energy { strain, hourglass: S::zero(), min_j }
}

//! Element forces with their consistent tangents, from the one written force routine.

use super::dual::Dual;
use crate::physics::element::{Class, Compose, Composition, Corners, Energy, Formulation, Shape};
use crate::physics::lanes::{InLanes, Instructions, Lanes};
use crate::physics::material::{Forgetful, Hyperelastic, Law, Viscosity};
use std::marker::PhantomData;

/// Force of an element at a configuration.
#[derive(Debug, Clone, Copy)]
pub struct ElementForce {
    /// f_int of the corners [N].
    pub f: Corners<f64>,
    /// Smallest det F over the points.
    pub min_j: f64,
    /// Viscous power [W].
    pub viscous_power: f64,
}

/// Tangent of an element: `rows[a][i][3 b + j]` = df_a,i / dx_b,j [N/m], the change of velocity with position included.
pub type Tangent = [[[f64; 24]; 3]; 8];

/// Forces and energies of single elements in plain numbers.
pub trait ElementForces: Send + Sync {
    fn force(&self, class: &Class<f64>, x: &Corners<f64>, v: &Corners<f64>) -> ElementForce;
    fn energy(&self, class: &Class<f64>, x: &Corners<f64>) -> Energy<f64>;
}

/// Tangents of single elements, for certain instructions.
pub trait TangentPass: Send + Sync {
    /// The tangent where v depends on x by dv_a = `rate[a]` dx_a [1/s].
    fn tangent(
        &self,
        class: &Class<f64>,
        x: &Corners<f64>,
        v: &Corners<f64>,
        rate: &[f64; 8],
    ) -> Box<Tangent>;
}

/// A formulation with its law, whose scalar is chosen where it is called.
struct Composed<F, L, V, I> {
    law: L,
    viscosity: V,
    instructions: I,
    kind: PhantomData<F>,
}

/// The geometry of a class, which does not vary.
struct Constant<'a>(&'a Class<f64>);

impl<N: Lanes<Real = f64>> Shape<Dual<N>> for Constant<'_> {
    #[inline(always)]
    fn number(&self, i: usize) -> Dual<N> {
        Dual::constant(self.0.numbers()[i])
    }
}

/// A tangent, as many columns at a time as there are lanes.
struct Columns<'a, F, L, V> {
    law: L,
    viscosity: V,
    class: &'a Class<f64>,
    x: &'a Corners<f64>,
    v: &'a Corners<f64>,
    rate: &'a [f64; 8],
    rows: &'a mut Tangent,
    kind: PhantomData<F>,
}

impl<F: Formulation, L: Hyperelastic, V: Viscosity> InLanes<f64> for Columns<'_, F, L, V> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes<Real = f64>>(self) {
        let Columns { law, viscosity, class, x, v, rate, rows, .. } = self;
        let zero = N::zero();
        let mut first: usize = 0;
        while first < 24 {
            let mut at = [[Dual::constant(0.0); 3]; 8];
            let mut moving = at;
            for a in 0usize..8 {
                for i in 0usize..3 {
                    let lane = (3 * a + i).wrapping_sub(first);
                    let here = if lane < N::WIDTH { 1 << lane } else { 0 };
                    at[a][i] = Dual { value: x[a][i], tangent: N::splat(1.0).choose(zero, here) };
                    moving[a][i] = Dual { value: v[a][i], tangent: N::splat(rate[a]).choose(zero, here) };
                }
            }
            let force = F::force(&law, &viscosity, &Constant(class), &at, &moving, &mut Forgetful);
            for a in 0..8 {
                for i in 0..3 {
                    // SAFETY: 24 is a multiple of every width.
                    unsafe { force.f[a][i].tangent.store(rows[a][i].as_mut_ptr(), first) };
                }
            }
            first += N::WIDTH;
        }
    }
}

impl<F: Formulation, L: Hyperelastic, V: Viscosity> ElementForces for Composed<F, L, V, ()> {
    fn force(&self, class: &Class<f64>, x: &Corners<f64>, v: &Corners<f64>) -> ElementForce {
        let force = F::force(&self.law, &self.viscosity, class, x, v, &mut Forgetful);
        ElementForce { f: force.f, min_j: force.min_j, viscous_power: force.viscous_power }
    }

    fn energy(&self, class: &Class<f64>, x: &Corners<f64>) -> Energy<f64> {
        F::energy(&self.law, class, x)
    }
}

impl<F: Formulation, L: Hyperelastic, V: Viscosity, I: Instructions> TangentPass for Composed<F, L, V, I> {
    fn tangent(
        &self,
        class: &Class<f64>,
        x: &Corners<f64>,
        v: &Corners<f64>,
        rate: &[f64; 8],
    ) -> Box<Tangent> {
        let mut rows = Box::new([[[0.0; 24]; 3]; 8]);
        let Composed { law, viscosity, .. } = *self;
        let kind = PhantomData::<F>;
        self.instructions.call(Columns { law, viscosity, class, x, v, rate, rows: &mut rows, kind });
        rows
    }
}

/// Forces of this composition, in plain numbers.
pub fn forces(composition: &Composition) -> Box<dyn ElementForces> {
    composition.visit(Forces)
}

struct Forces;

impl Compose for Forces {
    type Output = Box<dyn ElementForces>;

    fn with<F: Formulation, L: Hyperelastic, V: Viscosity>(self, law: L, viscosity: V) -> Self::Output {
        Box::new(Composed::<F, L, V, ()> { law, viscosity, instructions: (), kind: PhantomData })
    }
}

/// Tangents of this composition, for these instructions. One kernel for all laws: with one for each, tangents take a fifth less
/// time, an implicit run 4 % less, and the kernels a seventh longer to compile.
pub fn compose(instructions: impl Instructions, composition: &Composition) -> Box<dyn TangentPass> {
    composition.visit(Build { law: composition.law, instructions })
}

struct Build<I> {
    law: Law,
    instructions: I,
}

impl<I: Instructions> Compose for Build<I> {
    type Output = Box<dyn TangentPass>;

    fn with<F: Formulation, L: Hyperelastic, V: Viscosity>(self, _law: L, viscosity: V) -> Self::Output {
        boxed::<F, V, I>(self, viscosity)
    }
}

fn boxed<F: Formulation, V: Viscosity, I: Instructions>(
    build: Build<I>,
    viscosity: V,
) -> Box<dyn TangentPass> {
    let Build { law, instructions } = build;
    Box::new(Composed::<F, Law, V, I> { law, viscosity, instructions, kind: PhantomData })
}

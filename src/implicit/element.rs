//! Element forces with their consistent tangents, from the one written force routine.

use super::dual::Dual;
use crate::cpu::family::{
    LawFamily, MooneyRivlinEq4Law, MooneyRivlinLaw, NeoHookeanLaw, NoViscosity, ShearViscosity,
    ViscosityFamily,
};
use crate::physics::element::{Class, Corners, Energy, Formulation, Full, Q1p0, Shape, UniformGradient};
use crate::physics::lanes::{Lanes, Level, Portable64};
use crate::physics::material::{Law, Viscosity};
use crate::scene;
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

/// An element formulation with its law, for numbers and for numbers with derivatives.
pub trait Kernel: Send + Sync {
    fn force(&self, class: usize, x: &Corners<f64>, v: &Corners<f64>) -> ElementForce;
    /// The tangent where v depends on x by dv_a = `rate[a]` dx_a [1/s].
    fn tangent(&self, class: usize, x: &Corners<f64>, v: &Corners<f64>, rate: &[f64; 8]) -> Box<Tangent>;
    fn energy(&self, class: usize, x: &Corners<f64>) -> Energy<f64>;
}

/// A formulation with its law, whose scalar is chosen where it is called.
struct Composed<F, L, V> {
    law: scene::Law,
    eta: f64,
    classes: Vec<Class<f64>>,
    #[cfg_attr(test, expect(dead_code))] // see `Level::detect`
    level: Level,
    kind: PhantomData<(F, L, V)>,
}

/// The geometry of a class, which does not vary.
struct Constant<'a>(&'a Class<f64>);

impl<N: Lanes<Real = f64>> Shape<Dual<N>> for Constant<'_> {
    #[inline(always)]
    fn number(&self, i: usize) -> Dual<N> {
        Dual::constant(self.0.numbers()[i])
    }
}

/// A tangent, as many columns at a time as there are lanes; inlined into a function that has their instructions.
#[inline(always)]
fn tangent_in<N: Lanes<Real = f64>, F: Formulation, L: LawFamily, V: ViscosityFamily>(
    composed: &Composed<F, L, V>,
    class: &Class<f64>,
    x: &Corners<f64>,
    v: &Corners<f64>,
    rate: &[f64; 8],
    rows: &mut Tangent,
) {
    let law = <L::Law<Dual<N>> as Law<Dual<N>>>::new(&composed.law);
    let viscosity = <V::Viscosity<Dual<N>> as Viscosity<Dual<N>>>::new(composed.eta);
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
        let force = F::force(&law, &viscosity, &Constant(class), &at, &moving);
        for a in 0..8 {
            for i in 0..3 {
                // SAFETY: 24 is a multiple of every width.
                unsafe { force.f[a][i].tangent.store(rows[a][i].as_mut_ptr(), first) };
            }
        }
        first += N::WIDTH;
    }
}

impl<F: Formulation, L: LawFamily, V: ViscosityFamily> Kernel for Composed<F, L, V> {
    fn force(&self, class: usize, x: &Corners<f64>, v: &Corners<f64>) -> ElementForce {
        let law = <L::Law<f64> as Law<f64>>::new(&self.law);
        let viscosity = <V::Viscosity<f64> as Viscosity<f64>>::new(self.eta);
        let force = F::force(&law, &viscosity, &self.classes[class], x, v);
        ElementForce { f: force.f, min_j: force.min_j, viscous_power: force.viscous_power }
    }

    fn tangent(&self, class: usize, x: &Corners<f64>, v: &Corners<f64>, rate: &[f64; 8]) -> Box<Tangent> {
        let mut rows = Box::new([[[0.0; 24]; 3]; 8]);
        let class = &self.classes[class];
        // See `Level::detect`.
        #[cfg(all(target_arch = "x86_64", not(test)))]
        {
            use crate::physics::lanes::{F64x4, F64x8};
            #[target_feature(enable = "avx2,fma")]
            unsafe fn avx2<F: Formulation, L: LawFamily, V: ViscosityFamily>(
                this: &Composed<F, L, V>,
                class: &Class<f64>,
                [x, v]: [&Corners<f64>; 2],
                rate: &[f64; 8],
                rows: &mut Tangent,
            ) {
                tangent_in::<F64x4, F, L, V>(this, class, x, v, rate, rows);
            }
            #[target_feature(enable = "avx512f,fma")]
            unsafe fn avx512<F: Formulation, L: LawFamily, V: ViscosityFamily>(
                this: &Composed<F, L, V>,
                class: &Class<f64>,
                [x, v]: [&Corners<f64>; 2],
                rate: &[f64; 8],
                rows: &mut Tangent,
            ) {
                tangent_in::<F64x8, F, L, V>(this, class, x, v, rate, rows);
            }
            // SAFETY: the level says that the machine has the instructions.
            match self.level {
                Level::Avx512 => {
                    unsafe { avx512(self, class, [x, v], rate, &mut rows) };
                    return rows;
                }
                Level::Avx2 => {
                    unsafe { avx2(self, class, [x, v], rate, &mut rows) };
                    return rows;
                }
                Level::Portable => {}
            }
        }
        tangent_in::<Portable64, F, L, V>(self, class, x, v, rate, &mut rows);
        rows
    }

    fn energy(&self, class: usize, x: &Corners<f64>) -> Energy<f64> {
        F::energy(&<L::Law<f64> as Law<f64>>::new(&self.law), &self.classes[class], x)
    }
}

/// What a composition is made of.
struct Choice<'a> {
    law: scene::Law,
    viscosity: Option<f64>,
    classes: &'a [Class<f64>],
}

/// Composes the kernel of a model.
pub fn compose(
    element: scene::Element,
    law: scene::Law,
    viscosity: Option<f64>,
    classes: &[Class<f64>],
) -> Box<dyn Kernel> {
    let choice = Choice { law, viscosity, classes };
    match element {
        scene::Element::Q1p0 => choice.with_formulation::<Q1p0>(),
        scene::Element::Full => choice.with_formulation::<Full>(),
        scene::Element::UniformGradient { .. } => choice.with_formulation::<UniformGradient>(),
    }
}

impl Choice<'_> {
    fn with_formulation<F: Formulation>(&self) -> Box<dyn Kernel> {
        match self.law {
            scene::Law::NeoHookean { .. } => self.with_law::<F, NeoHookeanLaw>(),
            scene::Law::MooneyRivlin { .. } => self.with_law::<F, MooneyRivlinLaw>(),
            scene::Law::MooneyRivlinEq4 { .. } => self.with_law::<F, MooneyRivlinEq4Law>(),
        }
    }

    fn with_law<F: Formulation, L: LawFamily>(&self) -> Box<dyn Kernel> {
        match self.viscosity {
            None => self.boxed::<F, L, NoViscosity>(0.0),
            Some(eta) => self.boxed::<F, L, ShearViscosity>(eta),
        }
    }

    fn boxed<F: Formulation, L: LawFamily, V: ViscosityFamily>(&self, eta: f64) -> Box<dyn Kernel> {
        Box::new(Composed::<F, L, V> {
            law: self.law,
            eta,
            classes: self.classes.to_vec(),
            level: Level::detect(),
            kind: PhantomData,
        })
    }
}

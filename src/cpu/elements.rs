//! The element passes, several elements at a time: forces into per-corner slots, and stored energies.

use super::batches::ElementBatch;
use super::family::{LawFamily, ViscosityFamily};
use super::state::View;
use crate::engine::EnergyTotals;
use crate::model::Model;
use crate::physics::element::{Class, Corners, Formulation, Full, Q1p0, UniformGradient};
use crate::physics::lanes::{Array, Lanes, Level};
use crate::physics::material::{Law, Viscosity};
use crate::physics::scalar::{Real, Scalar};
use crate::scene;
use std::marker::PhantomData;
use std::ops::Range;

/// Constant data of the element passes.
pub struct Elements<T> {
    pub hexes: Vec<[u32; 8]>,
    pub classes: Vec<Class<T>>,
    pub batches: Vec<ElementBatch>,
}

/// What a range of batches reports.
#[derive(Debug, Clone, Copy, Default)]
pub struct Failed(pub Option<usize>);

/// An element pass over batches, composed for one formulation, law and viscosity.
pub trait Kernel<T>: Send + Sync {
    /// Corner forces of the batches into the slots of `view`; viscous power [W] times `weight` added to
    /// `power[batch]`. Returns the first element whose det F is not positive.
    ///
    /// # Safety
    /// No other thread touches the slots or powers of these batches, nor writes positions or velocities.
    unsafe fn forces(
        &self,
        elements: &Elements<T>,
        range: Range<usize>,
        view: &View<T>,
        power: *mut f64,
        weight: f64,
    ) -> Failed;

    /// Stored energies of all elements.
    ///
    /// # Safety
    /// No thread writes positions.
    unsafe fn energies(&self, elements: &Elements<T>, view: &View<T>) -> EnergyTotals;
}

struct Composed<F, L, V> {
    law: scene::Law,
    eta: f64,
    level: Level,
    kind: PhantomData<(F, L, V)>,
}

/// Corner values of a batch: contiguous runs where the mesh allows, else one by one.
#[inline(always)]
unsafe fn corners<N: Lanes>(batch: &ElementBatch, field: &[*mut N::Real; 3]) -> Corners<N> {
    let mut x = [[N::zero(); 3]; 8];
    for c in 0..8 {
        for d in 0..3 {
            x[c][d] = unsafe {
                if batch.contiguous {
                    N::load(field[d], batch.base[c] as usize)
                } else {
                    N::gather(field[d], &batch.nodes[c])
                }
            };
        }
    }
    x
}

/// Stores the valid lanes of the corner forces.
#[inline(always)]
unsafe fn store<N: Lanes>(batch: &ElementBatch, view: &View<N::Real>, f: &Corners<N>) {
    for c in 0..8 {
        for d in 0..3 {
            let at = view.slot(c, d) + batch.first;
            unsafe {
                if batch.count == N::WIDTH {
                    f[c][d].store(view.slots, at);
                } else {
                    for lane in 0..batch.count {
                        *view.slots.add(at + lane) = f[c][d].lane(lane);
                    }
                }
            }
        }
    }
}

/// The pass in lanes `N`; inlined into a function that has their instructions.
#[inline(always)]
unsafe fn forces_in<N: Lanes, F: Formulation, L: LawFamily, V: ViscosityFamily>(
    composed: &Composed<F, L, V>,
    elements: &Elements<N::Real>,
    range: Range<usize>,
    view: &View<N::Real>,
    power: *mut f64,
    weight: f64,
) -> Failed
where
    N::Real: Scalar,
{
    let law = <L::Law<N> as Law<N>>::new(&composed.law);
    let viscosity = <V::Viscosity<N> as Viscosity<N>>::new(composed.eta);
    let mut failed = Failed(None);
    let mut class_index = usize::MAX;
    let mut class: Option<Class<N>> = None;
    for b in range {
        let batch = &elements.batches[b];
        if batch.class != class_index {
            class_index = batch.class;
            class = Some(elements.classes[class_index].splat());
        }
        let Some(class) = &class else { continue };
        unsafe {
            let x = corners::<N>(batch, &view.x);
            let v = if <V::Viscosity<N> as Viscosity<N>>::ON {
                corners::<N>(batch, &view.v)
            } else {
                [[N::zero(); 3]; 8]
            };
            let force = F::force(&law, &viscosity, class, &x, &v);
            store(batch, view, &force.f);
            if <V::Viscosity<N> as Viscosity<N>>::ON {
                *power.add(b) += weight * sum_lanes(force.viscous_power, batch.count);
            }
            if force.min_j.any_not_positive() && failed.0.is_none() {
                failed.0 = first_failed(force.min_j, batch);
            }
        }
    }
    failed
}

#[inline(always)]
fn sum_lanes<N: Lanes>(values: N, count: usize) -> f64 {
    let mut sum = 0.0;
    for lane in 0..count {
        sum += values.lane(lane).to_f64();
    }
    sum
}

/// Lanes beyond the count repeat a valid element.
#[cold]
#[inline(never)]
fn first_failed<N: Lanes>(min_j: N, batch: &ElementBatch) -> Option<usize> {
    let bad = |lane: &usize| {
        min_j.lane(*lane).partial_cmp(&<N::Real as Scalar>::zero()) != Some(std::cmp::Ordering::Greater)
    };
    (0..batch.count).find(bad).map(|lane| batch.first + lane)
}

/// Once a sample, so element by element will do.
unsafe fn energies_of<T: Real, F: Formulation, L: LawFamily>(
    law: &scene::Law,
    elements: &Elements<T>,
    view: &View<T>,
) -> EnergyTotals {
    let law = <L::Law<T> as Law<T>>::new(law);
    let mut totals = EnergyTotals::default();
    for batch in &elements.batches {
        for hex in &elements.hexes[batch.first..batch.first + batch.count] {
            let x = hex.map(|n| [0, 1, 2].map(|d| unsafe { *view.x[d].add(n as usize) }));
            let energy = F::energy(&law, &elements.classes[batch.class], &x);
            totals.strain += energy.strain.to_f64();
            totals.hourglass += energy.hourglass.to_f64();
            totals.min_jacobian = totals.min_jacobian.min(energy.min_j.to_f64());
        }
    }
    totals
}

/// One implementation a precision: which lane type each level of instructions uses.
macro_rules! dispatched {
    ($real:ty, $portable:ty, $avx2:ident, $avx512:ident) => {
        impl<F: Formulation, L: LawFamily, V: ViscosityFamily> Kernel<$real> for Composed<F, L, V> {
            unsafe fn forces(
                &self,
                elements: &Elements<$real>,
                range: Range<usize>,
                view: &View<$real>,
                power: *mut f64,
                weight: f64,
            ) -> Failed {
                #[cfg(target_arch = "x86_64")]
                {
                    #[target_feature(enable = "avx2,fma")]
                    unsafe fn avx2<F: Formulation, L: LawFamily, V: ViscosityFamily>(
                        this: &Composed<F, L, V>,
                        elements: &Elements<$real>,
                        range: Range<usize>,
                        view: &View<$real>,
                        power: *mut f64,
                        weight: f64,
                    ) -> Failed {
                        use crate::physics::lanes::$avx2;
                        unsafe { forces_in::<$avx2, F, L, V>(this, elements, range, view, power, weight) }
                    }
                    #[target_feature(enable = "avx512f,fma")]
                    unsafe fn avx512<F: Formulation, L: LawFamily, V: ViscosityFamily>(
                        this: &Composed<F, L, V>,
                        elements: &Elements<$real>,
                        range: Range<usize>,
                        view: &View<$real>,
                        power: *mut f64,
                        weight: f64,
                    ) -> Failed {
                        use crate::physics::lanes::$avx512;
                        unsafe { forces_in::<$avx512, F, L, V>(this, elements, range, view, power, weight) }
                    }
                    match self.level {
                        Level::Avx512 => {
                            return unsafe { avx512(self, elements, range, view, power, weight) };
                        }
                        Level::Avx2 => return unsafe { avx2(self, elements, range, view, power, weight) },
                        Level::Portable => {}
                    }
                }
                unsafe { forces_in::<$portable, F, L, V>(self, elements, range, view, power, weight) }
            }

            unsafe fn energies(&self, elements: &Elements<$real>, view: &View<$real>) -> EnergyTotals {
                unsafe { energies_of::<$real, F, L>(&self.law, elements, view) }
            }
        }
    };
}
dispatched!(f64, Array<f64, 2>, F64x4, F64x8);
dispatched!(f32, Array<f32, 4>, F32x8, F32x16);

/// Lanes of a level, for elements and nodes alike.
pub fn width(level: Level, single: bool) -> usize {
    let doubles = match level {
        Level::Avx512 => 8,
        Level::Avx2 => 4,
        Level::Portable => 2,
    };
    if single { 2 * doubles } else { doubles }
}

/// Composes the kernel a model needs.
pub fn compose<T>(
    element: scene::Element,
    law: scene::Law,
    viscosity: Option<f64>,
    level: Level,
) -> Box<dyn Kernel<T>>
where
    T: 'static,
    Composable: Build<T>,
{
    Composable::build(element, law, viscosity, level)
}

/// Builds kernels of a precision.
pub trait Build<T> {
    fn build(
        element: scene::Element,
        law: scene::Law,
        viscosity: Option<f64>,
        level: Level,
    ) -> Box<dyn Kernel<T>>;
}

/// Carrier of [`Build`].
pub struct Composable;

macro_rules! build {
    ($real:ty) => {
        impl Build<$real> for Composable {
            fn build(
                element: scene::Element,
                law: scene::Law,
                viscosity: Option<f64>,
                level: Level,
            ) -> Box<dyn Kernel<$real>> {
                use super::family::*;
                fn boxed<F: Formulation, L: LawFamily, V: ViscosityFamily>(
                    law: scene::Law,
                    eta: f64,
                    level: Level,
                ) -> Box<dyn Kernel<$real>> {
                    Box::new(Composed::<F, L, V> { law, eta, level, kind: PhantomData })
                }
                fn with_law<F: Formulation, L: LawFamily>(
                    law: scene::Law,
                    viscosity: Option<f64>,
                    level: Level,
                ) -> Box<dyn Kernel<$real>> {
                    match viscosity {
                        None => boxed::<F, L, NoViscosity>(law, 0.0, level),
                        Some(eta) => boxed::<F, L, ShearViscosity>(law, eta, level),
                    }
                }
                fn with_formulation<F: Formulation>(
                    law: scene::Law,
                    viscosity: Option<f64>,
                    level: Level,
                ) -> Box<dyn Kernel<$real>> {
                    match law {
                        scene::Law::NeoHookean { .. } => with_law::<F, NeoHookeanLaw>(law, viscosity, level),
                        scene::Law::MooneyRivlin { .. } => {
                            with_law::<F, MooneyRivlinLaw>(law, viscosity, level)
                        }
                        scene::Law::MooneyRivlinEq4 { .. } => {
                            with_law::<F, MooneyRivlinEq4Law>(law, viscosity, level)
                        }
                    }
                }
                match element {
                    scene::Element::Q1p0 => with_formulation::<Q1p0>(law, viscosity, level),
                    scene::Element::Full => with_formulation::<Full>(law, viscosity, level),
                    scene::Element::UniformGradient { .. } => {
                        with_formulation::<UniformGradient>(law, viscosity, level)
                    }
                }
            }
        }
    };
}
build!(f64);
build!(f32);

/// Internal force of one element of a shape class in f64, at any corner positions and velocities.
pub fn element_forces(model: &Model, class: usize, x: &Corners<f64>, v: &Corners<f64>) -> Corners<f64> {
    single(model, &model.classes[class], x, v)
}

/// The same with plain numbers of any kind: the one place where a model's choices meet a scalar type.
fn single<S: Scalar>(model: &Model, class: &Class<S>, x: &Corners<S>, v: &Corners<S>) -> Corners<S> {
    use super::family::*;
    fn with<S: Scalar, F: Formulation, L: LawFamily>(
        model: &Model,
        class: &Class<S>,
        x: &Corners<S>,
        v: &Corners<S>,
    ) -> Corners<S> {
        let law = <L::Law<S> as Law<S>>::new(&model.law);
        match model.viscosity {
            None => {
                let none = <<NoViscosity as ViscosityFamily>::Viscosity<S> as Viscosity<S>>::new(0.0);
                F::force(&law, &none, class, x, v).f
            }
            Some(eta) => {
                let shear = <<ShearViscosity as ViscosityFamily>::Viscosity<S> as Viscosity<S>>::new(eta);
                F::force(&law, &shear, class, x, v).f
            }
        }
    }
    fn with_formulation<S: Scalar, F: Formulation>(
        model: &Model,
        class: &Class<S>,
        x: &Corners<S>,
        v: &Corners<S>,
    ) -> Corners<S> {
        match model.law {
            scene::Law::NeoHookean { .. } => with::<S, F, NeoHookeanLaw>(model, class, x, v),
            scene::Law::MooneyRivlin { .. } => with::<S, F, MooneyRivlinLaw>(model, class, x, v),
            scene::Law::MooneyRivlinEq4 { .. } => with::<S, F, MooneyRivlinEq4Law>(model, class, x, v),
        }
    }
    match model.element {
        scene::Element::Q1p0 => with_formulation::<S, Q1p0>(model, class, x, v),
        scene::Element::Full => with_formulation::<S, Full>(model, class, x, v),
        scene::Element::UniformGradient { .. } => with_formulation::<S, UniformGradient>(model, class, x, v),
    }
}

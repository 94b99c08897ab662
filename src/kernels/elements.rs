//! The element pass, several elements at a time: corners are fetched, the formulation gives their forces, and these go onto
//! the node lines. One kernel for every formulation, law, viscosity and level of instructions.

use super::fetch::{Copied, copy_of_thread, corners};
use super::layout::Item;
use super::memory::LaneMemory;
use super::scatter::{add_batch, add_loose};
use super::shared::Shared;
use super::state::Aligned;
use crate::physics::element::{Compose, Composition, Formulation, LaneShapes};
use crate::physics::lanes::{InLanes, Instructions, Lanes, first};
use crate::physics::material::{Fading, Hyperelastic, Viscosity};
use crate::physics::scalar::{Real, Scalar};
use std::marker::PhantomData;
use std::ops::Range;

/// Constant data of the element passes.
pub struct Elements<T> {
    pub items: Vec<Item>,
    /// Number of each item's first batch, and of all batches at the end.
    pub first_batch: Vec<usize>,
    /// Reference geometry by lanes, an entry of [`Class::NUMBERS`] vectors each.
    pub shapes: Aligned<T>,
}

/// What an item reports: its first element whose det F is not positive.
#[derive(Debug, Clone, Copy, Default)]
pub struct Failed(pub Option<usize>);

/// What viscous elements, and those that remember, need to know of a step.
#[derive(Debug, Clone, Copy, Default)]
pub struct ElementStep<'a> {
    /// Time before that of the positions over which the velocities are means [s].
    pub before: f64,
    /// Weight of powers in the sums of items.
    pub weight: f64,
    /// Terms of the Prony series.
    pub terms: &'a [Fading],
    /// Whether what relaxes in the step is kept.
    pub keeps: bool,
}

/// An element pass, composed for one formulation, law and viscosity.
pub trait ElementPass<T>: Send + Sync {
    /// Corner forces of an item onto the slots of its lines; viscous work and loss [J] are added to the item's sums.
    ///
    /// # Safety
    /// An item of the early phase of [`Shared`]'s contract.
    unsafe fn forces(
        &self,
        elements: &Elements<T>,
        item: usize,
        shared: &Shared<T>,
        step: ElementStep,
    ) -> Failed;

    /// The numbers of a class that it reads: [`Formulation::NUMBERS`].
    fn numbers(&self) -> Range<usize>;

    /// Points of an element that remember: none without a Prony series.
    fn points(&self) -> usize;
}

/// Composes the pass for these instructions; `extruded`: all elements are plane figures extruded along eta.
pub fn compose<T: Real>(
    instructions: impl Instructions,
    composition: &Composition,
    extruded: bool,
) -> Box<dyn ElementPass<T>> {
    composition.visit_fastest(extruded, Build { instructions, kind: PhantomData })
}

struct Build<T, I> {
    instructions: I,
    kind: PhantomData<T>,
}

impl<T: Real, I: Instructions> Compose for Build<T, I> {
    type Output = Box<dyn ElementPass<T>>;

    fn with<F: Formulation, L: Hyperelastic, V: Viscosity>(self, law: L, viscosity: V) -> Self::Output {
        Box::new(Composed::<F, L, V, I> {
            law,
            viscosity,
            instructions: self.instructions,
            kind: PhantomData,
        })
    }
}

struct Composed<F, L, V, I> {
    law: L,
    viscosity: V,
    instructions: I,
    kind: PhantomData<F>,
}

impl<T: Real, F: Formulation, L: Hyperelastic, V: Viscosity, I: Instructions> ElementPass<T>
    for Composed<F, L, V, I>
{
    fn numbers(&self) -> Range<usize> {
        F::NUMBERS
    }

    fn points(&self) -> usize {
        if V::REMEMBERS { F::POINTS } else { 0 }
    }

    unsafe fn forces(
        &self,
        elements: &Elements<T>,
        item: usize,
        shared: &Shared<T>,
        step: ElementStep,
    ) -> Failed {
        let (law, viscosity) = (self.law, self.viscosity.over(step.before));
        let kind = PhantomData::<F>;
        self.instructions.call(Pass { law, viscosity, elements, item, shared, step, kind })
    }
}

/// The pass over an item; made by [`ElementPass::forces`] alone, whose promise it holds.
struct Pass<'a, T, F, L, V> {
    law: L,
    viscosity: V,
    elements: &'a Elements<T>,
    item: usize,
    shared: &'a Shared<'a, T>,
    step: ElementStep<'a>,
    kind: PhantomData<F>,
}

impl<T: Real, F: Formulation, L: Hyperelastic, V: Viscosity> InLanes<T> for Pass<'_, T, F, L, V> {
    type Output = Failed;

    /// Batch by batch.
    #[inline(always)]
    fn run<N: Lanes<Real = T>>(self) -> Failed {
        let Pass { law, viscosity, elements, shared, .. } = self;
        let item = &elements.items[self.item];
        let places = &shared.places();
        // SAFETY: nobody else has this thread's copy: a pass ends before the next begins.
        let copy: &mut Copied<T> = unsafe { &mut *copy_of_thread() };
        if let Item::Loose(loose) = item {
            // SAFETY: the promise of `ElementPass::forces`.
            unsafe { copy.read(loose, places, N::WIDTH, V::ON) };
        }
        let mut carry = [[N::zero(); 3]; 4];
        let zero = N::zero();
        let mut report = Report { failed: Failed(None), work: zero, loss: zero };
        let weight = N::from_f64(self.step.weight);
        for (b, &shape) in item.shapes().iter().enumerate() {
            let shape = shape_at::<N, F>(elements, shape);
            // SAFETY: the promise of `ElementPass::forces`; an item has an entry of the table of shapes for every batch.
            let at = unsafe { corners::<N>(item, b, places, copy, V::ON) };
            let batch = elements.first_batch[self.item] + b;
            // SAFETY: a batch of the item, whose part of the memory is the item's.
            let mut memory = unsafe { LaneMemory::<N>::new(shared, batch, F::POINTS, &self.step) };
            let force = F::force(&law, &viscosity, &shape, &at.x, &at.v, &mut memory);
            // SAFETY: as above, and batches come in order.
            unsafe { add_batch(item, b, places, copy, &mut carry, &force.f) };
            let loss = weight * (force.viscous_power + force.memory_loss);
            let work = weight.mul_add(force.viscous_power, force.memory_work);
            report.note::<V>(item.elements(), b * N::WIDTH, [work, loss], force.min_j);
            if V::REMEMBERS && self.step.keeps {
                memory.add_loss(loss);
            }
        }
        // SAFETY: as above; the sums are the item's, one a lane.
        unsafe {
            if let Item::Loose(loose) = item {
                add_loose(loose, places, copy, N::WIDTH);
            }
            if V::ON {
                report.work.add_to(shared.viscous(self.item));
                report.loss.add_to(shared.loss(self.item));
            }
        }
        report.failed
    }
}

/// What is said of an item beside its forces.
struct Report<N> {
    failed: Failed,
    /// Viscous work and loss [J].
    work: N,
    loss: N,
}

impl<N: Lanes> Report<N> {
    /// Of a batch that begins with element `at` of the item. Lanes beyond the last element compute with other nodes: they say
    /// nothing.
    #[inline(always)]
    fn note<V: Viscosity>(&mut self, elements: &[u32], at: usize, [work, loss]: [N; 2], min_j: N) {
        let count = N::WIDTH.min(elements.len() - at);
        if V::ON {
            self.work += work.choose(N::zero(), first(count));
            self.loss += loss.choose(N::zero(), first(count));
        }
        let min_j = min_j.choose(N::one(), first(count));
        if min_j.any_not_positive() && self.failed.0.is_none() {
            self.failed.0 = first_failed(min_j, &elements[at..at + count]);
        }
    }
}

/// Reference geometry of a batch's lanes.
#[inline(always)]
fn shape_at<N: Lanes, F: Formulation>(elements: &Elements<N::Real>, entry: u32) -> LaneShapes<'_, N::Real> {
    let length = F::NUMBERS.len() * N::WIDTH;
    let numbers = &elements.shapes.slice()[entry as usize * length..][..length];
    // SAFETY: a vector for every number that the formulation says it reads.
    unsafe { LaneShapes::new(numbers, F::NUMBERS.start) }
}

/// The lowest of `elements` that failed.
#[cold]
#[inline(never)]
fn first_failed<N: Lanes>(min_j: N, elements: &[u32]) -> Option<usize> {
    let bad = |lane: &usize| {
        min_j.lane(*lane).partial_cmp(&<N::Real as Scalar>::zero()) != Some(std::cmp::Ordering::Greater)
    };
    (0..elements.len()).filter(bad).map(|lane| elements[lane] as usize).min()
}

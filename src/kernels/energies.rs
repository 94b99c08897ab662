//! Stored energies of a few elements at a time, in double precision.

use crate::physics::element::{Class, Compose, Composition, Corners, Energy, Formulation, SameShape};
use crate::physics::lanes::{InLanes, Instructions, Lanes};
use crate::physics::material::{Hyperelastic, Viscosity};
use std::marker::PhantomData;

/// Most elements at a time.
pub const MOST: usize = 8;

/// Corners of a few elements of one class, lane by lane.
pub struct Gathered(pub [[[f64; MOST]; 3]; 8]);

/// Their energies, lane by lane.
pub struct Batch {
    /// [J]
    pub strain: [f64; MOST],
    pub hourglass: [f64; MOST],
    /// Smallest det F over the points.
    pub min_j: [f64; MOST],
}

/// Energies of one formulation and law, for certain instructions.
pub trait EnergyPass: Send + Sync {
    /// How many elements it takes at a time.
    fn lanes(&self) -> usize;
    /// Energies of elements of a class; lanes beyond [`EnergyPass::lanes`] are not read.
    fn batch(&self, class: &Class<f64>, x: &Gathered) -> Batch;
}

/// The pass for these instructions.
pub fn compose(instructions: impl Instructions, composition: &Composition) -> Box<dyn EnergyPass> {
    composition.visit(Build(instructions))
}

struct Build<I>(I);

impl<I: Instructions> Compose for Build<I> {
    type Output = Box<dyn EnergyPass>;

    /// Energies know nothing of viscosity.
    fn with<F: Formulation, L: Hyperelastic, V: Viscosity>(self, law: L, _viscosity: V) -> Self::Output {
        boxed::<F, L, I>(law, self.0)
    }
}

fn boxed<F: Formulation, L: Hyperelastic, I: Instructions>(law: L, instructions: I) -> Box<dyn EnergyPass> {
    Box::new(Composed::<F, L, I> { law, instructions, kind: PhantomData })
}

struct Composed<F, L, I> {
    law: L,
    instructions: I,
    kind: PhantomData<F>,
}

impl<F: Formulation, L: Hyperelastic, I: Instructions> EnergyPass for Composed<F, L, I> {
    fn lanes(&self) -> usize {
        self.instructions.width::<f64>()
    }

    fn batch(&self, class: &Class<f64>, x: &Gathered) -> Batch {
        self.instructions.call(OfBatch { law: self.law, class, x, kind: PhantomData::<F> })
    }
}

struct OfBatch<'a, F, L> {
    law: L,
    class: &'a Class<f64>,
    x: &'a Gathered,
    kind: PhantomData<F>,
}

impl<F: Formulation, L: Hyperelastic> InLanes<f64> for OfBatch<'_, F, L> {
    type Output = Batch;

    #[inline(always)]
    fn run<N: Lanes<Real = f64>>(self) -> Batch {
        const { assert!(N::WIDTH <= MOST) };
        let mut corners: Corners<N> = [[N::zero(); 3]; 8];
        for c in 0..8 {
            for d in 0..3 {
                // SAFETY: there is room for the widest lanes.
                corners[c][d] = unsafe { N::load(self.x.0[c][d].as_ptr(), 0) };
            }
        }
        let Energy { strain, hourglass, min_j } = F::energy(&self.law, &SameShape(self.class), &corners);
        let mut batch = Batch { strain: [0.0; MOST], hourglass: [0.0; MOST], min_j: [0.0; MOST] };
        // SAFETY: as above.
        unsafe {
            strain.store(batch.strain.as_mut_ptr(), 0);
            hourglass.store(batch.hourglass.as_mut_ptr(), 0);
            min_j.store(batch.min_j.as_mut_ptr(), 0);
        }
        batch
    }
}

//! What one step of an element costs: floating-point operations, by running the routines on a counting scalar, and
//! bytes, from the arrays that each pass of the CPU engine goes through.

use serde::{Deserialize, Serialize};

use super::counting::{Counted, Operations, count};
use hexroll::model::Model;
use hexroll::physics::element::{Class, Compose, Corners, Formulation};
use hexroll::physics::material::{Forgetful, Hyperelastic, Viscosity};
use hexroll::physics::node::{Loads, Prediction, StepSize};
use hexroll::physics::scalar::{Real, Scalar};
use hexroll::physics::tensor::{add, axpy};
use std::marker::PhantomData;

/// A pass over the mesh: what it must read, write and compute in one step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pass {
    pub name: String,
    /// Bytes read and written, every array once.
    pub bytes: f64,
    pub flops: f64,
}

/// Operations of the force routine of one element of the model's own formulation, law and viscosity, in precision `T`.
pub fn element_operations<T: Real>(model: &Model) -> Operations {
    let class: Class<Counted<T>> = model.classes[0].cast();
    let x = corners::<T>(&model.mesh.nodes, &model.mesh.hexes[0]);
    let count = Count { class, x, kind: PhantomData::<T> };
    model.composition().visit_fastest(model.is_extruded(), count)
}

struct Count<T: Real> {
    class: Class<Counted<T>>,
    x: Corners<Counted<T>>,
    kind: PhantomData<T>,
}

impl<T: Real> Compose for Count<T> {
    type Output = Operations;

    fn with<F: Formulation, L: Hyperelastic, V: Viscosity>(self, law: L, viscosity: V) -> Operations {
        count(|| F::force(&law, &viscosity, &self.class, &self.x, &self.x, &mut Forgetful)).1
    }
}

fn corners<T: Real>(nodes: &[[f64; 3]], hex: &[u32; 8]) -> Corners<Counted<T>> {
    hex.map(|n| nodes[n as usize].map(Counted::from_f64))
}

/// Operations of one node without contact: the sum over its `corners` forces, the new velocity and the new position.
/// Works and impulses are left out: they are our book-keeping, not the scheme.
pub fn node_operations<T: Real>(corners: usize) -> Operations {
    let number = Counted::<T>::from_f64;
    let three = [number(0.5); 3];
    let step = StepSize { dt: number(0.1), dtm: number(0.1) };
    let prediction = Prediction::new(&Loads { gravity: three, alpha: number(0.0) }, step);
    let work = || {
        let force = (0..corners).fold(three, |sum, _| add(sum, three));
        let v = prediction.velocity(number(1.0), force, three);
        axpy(v, step.dt, three)
    };
    count(work).1
}

/// Operations of a step of the whole model, the element pass and the node pass.
pub fn step_operations<T: Real>(model: &Model) -> [f64; 2] {
    let element = element_operations::<T>(model).flops() as f64;
    // Corners are shared out among the nodes: one sum a corner, wherever it goes.
    let (bare, one) = (node_operations::<T>(0).flops() as f64, node_operations::<T>(1).flops() as f64);
    let (elements, nodes) = (model.element_count() as f64, model.node_count() as f64);
    [element * elements, bare * nodes + (one - bare) * 8.0 * elements]
}

/// The passes of a step of the CPU engine in precision `T`: one, since a node moves while the forces of its elements are
/// in the cache. It reads and writes positions and velocities and reads mass and inverse mass, each once; nodal forces stay
/// in the cache of a core.
pub fn cpu_passes<T: Real>(model: &Model) -> Vec<Pass> {
    let nodes = model.node_count() as f64;
    let [element_flops, node_flops] = step_operations::<T>(model);
    let bytes = size_of::<T>() as f64 * (3.0 * 4.0 + 2.0) * nodes;
    vec![Pass { name: "step".into(), bytes, flops: element_flops + node_flops }]
}

/// Size of the arrays that a step of the CPU engine goes through [bytes]: positions, velocities, masses. Forces are those of
/// a few layers.
pub fn cpu_arrays<T: Real>(model: &Model) -> f64 {
    size_of::<T>() as f64 * (3.0 * 2.0 + 2.0) * model.node_count() as f64
}

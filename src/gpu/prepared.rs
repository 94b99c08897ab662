//! A body ready for the device: everything that is decided on the host.

use super::Gpu;
use super::buffers::{self, Buffers};
use super::chains::{self, Chains};
use super::compose::{Choice, RimKind};
use super::counts::Counts;
use super::order::{self, Order, Ordered};
use super::precision::Precision;
use super::resident::Shape;
use super::series::Series;
use super::upload::{self, Table};
use crate::error::Result;
use crate::model::mesh::Mesh;
use crate::model::{Model, frame};
use crate::scene::{Friction, Road, Scene};

/// What a body of this scene needs of every kernel, before a stage says more.
pub fn choice(model: &Model, scene: &Scene, chains: &Chains, precision: Precision) -> Choice {
    let relaxes = !model.relaxation.terms.is_empty();
    Choice {
        element: model.element,
        law: model.law,
        viscous: model.viscosity.is_some() || relaxes,
        relaxes,
        road: scene.road.as_ref().map(Road::name),
        friction: scene.friction,
        held: !model.mesh.held.is_empty(),
        gravity: scene.gravity != [0.0; 3],
        damping: false,
        rim: if model.mesh.rim.is_empty() { RimKind::None } else { RimKind::Prescribed },
        precision,
        extruded: model.is_extruded(),
        shared_classes: chains.shared_classes,
        lattice: chains.lattice.is_some(),
        joined: chains.is_joined(),
    }
}

/// A body in the device's numbers.
pub struct Prepared {
    pub model: Model,
    /// The model's numbers by the device's, where they differ.
    pub order: Option<Order>,
    /// The mesh in the model's numbers, where friction looks at pressure.
    pub mesh: Option<Mesh>,
    pub choice: Choice,
    pub counts: Counts,
    pub series: Option<Series>,
    pub constants: Vec<(&'static str, f64)>,
    pub tables: Vec<Table>,
    /// How it fits into one work group, if it does.
    pub shape: Option<Shape>,
    pub scene: Scene,
    pub grain: f64,
    pub frame: [f64; 3],
}

impl Prepared {
    /// # Errors
    /// It does not fit the adapter's limits, or the adapter does not have the precision.
    pub fn new(gpu: &Gpu, model: &Model, scene: &Scene, precision: Precision) -> Result<Prepared> {
        if let Some(gap) = scene.beyond_gpu() {
            return Err(gap);
        }
        precision.check(gpu)?;
        let real = precision.real();
        let mesh = scene.friction.filter(Friction::needs_area).map(|_| model.mesh.clone());
        let Ordered { model, order } = order::ordered(model);
        let model = model.into_owned();
        let chains = Chains::new(
            &model,
            chains::longest(gpu.report.software, model.element_count()),
            !gpu.report.software,
        );
        buffers::check_limits(gpu, &model, &chains, scene.road.is_some(), real)?;
        let choice = choice(&model, scene, &chains, precision);
        let counts = Counts::of(&model, &chains, choice.road.is_some(), gpu.report.workgroups);
        let grain = frame::grain(&model.mesh);
        Ok(Prepared {
            mesh,
            choice,
            constants: upload::constants(&model, scene, &chains),
            tables: upload::tables(&model, &chains, &choice, scene.road.as_ref()),
            shape: match precision {
                // A resident kernel has no place for what points remember.
                Precision::F32 if choice.relaxes => None,
                Precision::F32 => Shape::new(gpu, &chains, counts.nodes),
                // No work group's memory holds positions and forces in more than 32 bits each.
                Precision::F32Plus | Precision::F64 => None,
            },
            counts,
            series: Series::of(&model),
            scene: scene.clone(),
            frame: frame::shift(grain, model.mesh.axle, [0.0; 3], scene.road.as_ref()),
            grain,
            order,
            model,
        })
    }

    /// Whether one dispatch can take the steps of both: same kernels with the same constants, same tables.
    pub fn is_alike(&self, other: &Prepared) -> bool {
        self.choice == other.choice
            && self.constants == other.constants
            && self.shape == other.shape
            && self.tables == other.tables
    }

    /// Bodies of this kind whose arrays the adapter can bind as one.
    pub fn most_bodies(&self, gpu: &Gpu) -> usize {
        let most = gpu.report.storage_binding.min(gpu.report.buffer);
        (most / upload::largest_part(&self.counts, self.choice.precision.real())).max(1) as usize
    }

    /// Buffers for so many bodies of this kind; the first one's.
    pub fn buffers(&self, gpu: &Gpu, bodies: usize) -> Buffers {
        upload::create(gpu, &self.tables, &self.choice, &self.counts, bodies)
    }
}

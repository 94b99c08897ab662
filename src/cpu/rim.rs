//! The rim's own equation of motion, where a component is free.

use crate::engine::{StageSetup, Step};
use crate::model::Model;
use crate::physics::rim::{self, Coordinates, SPIN};
use glam::DVec3;

/// State of the rim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RimState {
    /// Coordinates at t(n), and their half-step rates.
    pub q: Coordinates,
    pub rate: Coordinates,
    /// Mass of the rim nodes [kg] and their inertia about the axle [kg m2].
    pub node_mass: f64,
    pub node_inertia: f64,
}

/// Force and moment about the axle of the rubber and of body forces on the rim nodes [N, N m].
#[derive(Debug, Clone, Copy, Default)]
pub struct Reaction {
    pub force: [f64; 3],
    pub moment: [f64; 3],
}

impl RimState {
    /// At rest with the axle where the mesh has it.
    pub fn new(model: &Model) -> Self {
        let mesh = &model.mesh;
        let [x, y, z] = mesh.axle;
        let mass = |n: &u32| model.mass[*n as usize];
        let arm2 = |n: &u32| {
            let node = mesh.nodes[*n as usize];
            let [x, _, z]: [f64; 3] = std::array::from_fn(|d| node[d] - mesh.axle[d]);
            x * x + z * z
        };
        RimState {
            q: [x, y, z, 0.0, 0.0, 0.0],
            rate: [0.0; 6],
            node_mass: mesh.rim.iter().map(mass).sum(),
            node_inertia: mesh.rim.iter().map(|n| mass(n) * arm2(n)).sum(),
        }
    }

    pub fn is_free(setup: &StageSetup) -> bool {
        setup.free.iter().any(Option::is_some)
    }

    /// Coordinates at t(n+1) and the rates that lead there: prescribed components from the plan, free ones from
    /// the reaction at t(n).
    pub fn advanced(
        &self,
        setup: &StageSetup,
        step: &Step,
        reaction: &Reaction,
    ) -> (Coordinates, Coordinates) {
        let (mut q, mut rate) = (step.rim, self.rate);
        for component in 0..6 {
            let Some(own) = setup.free[component] else {
                rate[component] = (q[component] - self.q[component]) / step.dt;
                continue;
            };
            let (inertia, push) = if component == SPIN {
                let along = rim::axle_direction(&self.q).dot(DVec3::from(reaction.moment));
                (own + self.node_inertia, along)
            } else {
                (own + self.node_mass, reaction.force[component])
            };
            let h = 0.5 * setup.mass_damping * step.dtm();
            let acceleration = (push + step.load[component]) / inertia;
            rate[component] = ((1.0 - h) * self.rate[component] + step.dtm() * acceleration) / (1.0 + h);
            q[component] = self.q[component] + step.dt * rate[component];
        }
        (q, rate)
    }
}

//! Host side of the rim: coordinates in double precision, moves of a window from the device.

use super::buffers::vec4;
use super::layout;
use crate::engine::StageSetup;
use crate::model::Model;
use crate::physics::rim::{self, Coordinates, SPIN};
use glam::DMat3;

/// Coordinates at the start of the window with their half-step rates, and what the device needs to know of the rim.
#[derive(Debug, Clone)]
pub struct FreeRim {
    pub q: Coordinates,
    pub rate: Coordinates,
    pub node_mass: f64,
    pub node_inertia: f64,
}

impl FreeRim {
    pub fn new(model: &Model) -> FreeRim {
        let [x, y, z] = model.mesh.axle;
        let node = |&n: &u32| {
            let (mass, at) = (model.mass[n as usize], model.mesh.nodes[n as usize]);
            (mass, mass * ((at[0] - x).powi(2) + (at[2] - z).powi(2)))
        };
        let (masses, inertias): (Vec<f64>, Vec<f64>) = model.mesh.rim.iter().map(node).unzip();
        FreeRim {
            q: [x, y, z, 0.0, 0.0, 0.0],
            rate: [0.0; 6],
            node_mass: masses.iter().sum(),
            node_inertia: inertias.iter().sum(),
        }
    }

    pub fn set_rate(&mut self, setup: &StageSetup, rate: &Coordinates) {
        for ((own, given), free) in self.rate.iter_mut().zip(rate).zip(&setup.free) {
            if free.is_some() {
                *own = *given;
            }
        }
    }

    /// State of the rim at the start of a window.
    pub fn upload(&self, frame: [f64; 3]) -> layout::RimState {
        let columns = |m: DMat3| m.to_cols_array_2d().map(vec4);
        let rotation = columns(rim::rotation(&self.q));
        let start = columns(DMat3::from_rotation_y(self.q[SPIN]));
        let origin = vec4(std::array::from_fn(|d| self.q[d] - frame[d]));
        let rate = [self.rate[0], self.rate[1], self.rate[2], self.rate[SPIN]];
        layout::RimState {
            at: [0.0; 4],
            velocity: rate,
            origin,
            start0: start[0],
            start1: start[1],
            start2: start[2],
            direction: vec4(rim::axle_direction(&self.q).to_array()),
            axle: origin,
            axle_velocity: [0.0; 4],
            axle_before: origin,
            rotation0: rotation[0],
            rotation1: rotation[1],
            rotation2: rotation[2],
            rate0: [0.0; 4],
            rate1: [0.0; 4],
            rate2: [0.0; 4],
        }
    }

    /// Adds the moves of a window.
    pub fn download(&mut self, state: &layout::RimState) {
        for (k, component) in [0, 1, 2, SPIN].into_iter().enumerate() {
            self.q[component] += state.at[k];
            self.rate[component] = state.velocity[k];
        }
    }
}

//! What steps add up besides moving nodes.

use crate::physics::lanes::WIDEST;

/// Sums of a line over the steps of a window, in double precision; arrays have one sum a lane.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub struct LineSums {
    /// Work of the whole internal force, the viscous part included.
    pub internal: [f64; WIDEST],
    pub body_force: [f64; WIDEST],
    pub damping: [f64; WIDEST],
    pub rim: [f64; WIDEST],
    /// Internal force on rim nodes and its moment about the axle, times the mean step.
    pub rim_impulse: [[f64; WIDEST]; 3],
    pub rim_moment_impulse: [[f64; WIDEST]; 3],
    pub mixed_kinetic: [f64; WIDEST],
    pub net_force2: [f64; WIDEST],
    pub internal_force2: [f64; WIDEST],
    pub normal: f64,
    pub friction: f64,
}

impl Default for LineSums {
    fn default() -> Self {
        let none = [0.0; WIDEST];
        LineSums {
            internal: none,
            body_force: none,
            damping: none,
            rim: none,
            rim_impulse: [none; 3],
            rim_moment_impulse: [none; 3],
            mixed_kinetic: none,
            net_force2: none,
            internal_force2: none,
            normal: 0.0,
            friction: 0.0,
        }
    }
}

/// Contact of a line in one step.
#[derive(Debug, Clone, Copy, Default)]
pub struct LineContact {
    pub force: [f64; 3],
    pub touching: u32,
    /// Of those: nodes that were free the step before, and nodes that changed between stick and slip.
    pub entered: u32,
    pub switched: u32,
}

/// A surface node over a window.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SurfaceSum {
    /// Position and half-step velocity at the end of the window, absolute [m, m/s].
    pub x: [f64; 3],
    pub v: [f64; 3],
    /// Sum of contact force times mean step [N s].
    pub impulse: [f64; 3],
    /// Work of the tangential force on the node [J].
    pub friction_work: f64,
    /// Work that the road's motion puts in: force times velocity of the road's surface at the node, times mean step [J]. What
    /// friction dissipates is this less the friction work.
    pub road_work: f64,
    /// Steps in contact, and those of them that stick.
    pub touching: u32,
    pub sticking: u32,
    /// State in the last step.
    pub touches: bool,
    pub sticks: bool,
}

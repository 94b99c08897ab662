//! The rim's coordinates as unknowns: where its nodes are, and how they move with a free component.

use crate::model::Model;
use crate::physics::rim::{self, Coordinates, SPIN};
use crate::physics::tensor::Vec3;
use glam::DVec3;

/// Rim nodes and where they sit on the rim.
#[derive(Debug, Clone)]
pub struct RimNodes {
    pub nodes: Vec<u32>,
    /// Relative to the axle, in the reference orientation [m].
    arms: Vec<DVec3>,
    /// Mass of the nodes [kg], and their inertia about the axle [kg m2].
    pub mass: f64,
    pub inertia: f64,
}

impl RimNodes {
    pub fn new(model: &Model) -> RimNodes {
        let mesh = &model.mesh;
        let axle = DVec3::from(mesh.axle);
        let arms: Vec<DVec3> = mesh.rim.iter().map(|&n| DVec3::from(mesh.nodes[n as usize]) - axle).collect();
        let masses = || mesh.rim.iter().map(|&n| model.mass[n as usize]);
        let inertia = masses().zip(&arms).map(|(m, a)| m * (a.x * a.x + a.z * a.z)).sum();
        RimNodes { nodes: mesh.rim.clone(), arms, mass: masses().sum(), inertia }
    }

    /// Inertia of the rim nodes against a free component [kg, kg m2].
    pub fn node_inertia(&self, component: usize) -> f64 {
        if component == SPIN { self.inertia } else { self.mass }
    }

    /// Puts the rim nodes where the coordinates say.
    pub fn place(&self, q: &Coordinates, x: &mut [Vec3<f64>]) {
        let (turn, axle) = (rim::rotation(q), rim::axle(q));
        for (&n, &arm) in self.nodes.iter().zip(&self.arms) {
            x[n as usize] = (axle + turn * arm).to_array();
        }
    }

    /// Velocities of the rim nodes from the rates of the coordinates.
    pub fn velocities(&self, q: &Coordinates, rate: &Coordinates, v: &mut [Vec3<f64>]) {
        let (turn, omega) = (rim::rotation(q), rim::angular_velocity(q, rate));
        for (&n, &arm) in self.nodes.iter().zip(&self.arms) {
            v[n as usize] = (rim::axle(rate) + omega.cross(turn * arm)).to_array();
        }
    }

    /// dx/dq of a component that can be free (a translation or the spin), rim node by rim node.
    pub fn direction(&self, q: &Coordinates, component: usize) -> Vec<Vec3<f64>> {
        let (turn, along) = (rim::rotation(q), rim::axle_direction(q));
        let one = |arm: &DVec3| {
            if component == SPIN { along.cross(turn * *arm) } else { unit(component) }.to_array()
        };
        self.arms.iter().map(one).collect()
    }

    /// sum f . d2x/dq2 of the spin [N m]: the stiffness of forces that turn with the rim.
    pub fn spin_stiffness(&self, q: &Coordinates, force: &[Vec3<f64>]) -> f64 {
        let (turn, along) = (rim::rotation(q), rim::axle_direction(q));
        let one = |(&n, &arm): (&u32, &DVec3)| {
            DVec3::from(force[n as usize]).dot(along.cross(along.cross(turn * arm)))
        };
        self.nodes.iter().zip(&self.arms).map(one).sum()
    }

    /// Force and moment about the axle that `force` at the rim nodes adds up to.
    pub fn resultant(
        &self,
        axle: [f64; 3],
        x: &[Vec3<f64>],
        force: impl Fn(usize) -> Vec3<f64>,
    ) -> [[f64; 3]; 2] {
        let (mut sum, mut moment) = (DVec3::ZERO, DVec3::ZERO);
        for &n in &self.nodes {
            let f = DVec3::from(force(n as usize));
            sum += f;
            moment += (DVec3::from(x[n as usize]) - DVec3::from(axle)).cross(f);
        }
        [sum.to_array(), moment.to_array()]
    }
}

fn unit(component: usize) -> DVec3 {
    [DVec3::X, DVec3::Y, DVec3::Z][component]
}

//! Velocities that are set: the body's own at the start, with the rim's free components; the rim's at the start of a stage.

use super::state::{Run, State};
use crate::error::Result;
use crate::physics::rim;
use crate::scene::InitialVelocity;
use glam::DVec3;

impl Run<'_> {
    /// The body's own initial velocity, v + omega x (x - centroid), in the first stage. The rim is a part of the body: a free
    /// component starts with the velocity that the axle's point has there, or with the turn about the axle.
    pub fn start_body(&mut self) -> Result<()> {
        let body = &self.scene.body;
        let (model, total) = (self.model, self.model.mass.iter().sum::<f64>());
        let position = |n: usize| DVec3::from(model.mesh.nodes[n]);
        let moment: DVec3 = (0..model.node_count()).map(|n| position(n) * model.mass[n]).sum();
        let centroid = moment / total;
        let (v, omega) = (DVec3::from(body.velocity), DVec3::from(body.angular_velocity));
        if v == DVec3::ZERO && omega == DVec3::ZERO {
            return Ok(());
        }
        let field = |x: DVec3| v + omega.cross(x - centroid);
        let rim = &mut self.state.rim;
        let [x, y, z] = field(rim::axle(&rim.at)).to_array();
        let rate = [x, y, z, 0.0, 0.0, omega.dot(rim::axle_direction(&rim.at))];
        for (component, free) in rim.motion.setup(0.0).free.iter().enumerate() {
            if free.is_some() {
                rim.rate[component] = rate[component];
            }
        }
        self.set_velocities(field)
    }

    /// The velocities that a stage begins with at `time`, if it sets any.
    pub fn start_stage(&mut self, velocity: Option<InitialVelocity>, time: f64) -> Result<()> {
        match velocity {
            Some(InitialVelocity::Rim) => self.start_with_rim(time),
            Some(InitialVelocity::Zero) => {
                self.state.rim.rate = [0.0; 6];
                self.set_velocities(|_| DVec3::ZERO)
            }
            None => Ok(()),
        }
    }

    /// The rigid velocity of the rim's motion for every node, and for the rim's free components.
    fn start_with_rim(&mut self, time: f64) -> Result<()> {
        let rim = &mut self.state.rim;
        let mut rate = rim.motion.rate_at(time);
        for (component, free) in rim.motion.setup(0.0).free.iter().enumerate() {
            if free.is_some() {
                rate[component] = rim.rate[component];
            }
        }
        let omega = rim::angular_velocity(&rim.at, &rate);
        let (axle, velocity) = (rim::axle(&rim.at), rim::axle(&rate));
        rim.rate = rate;
        self.set_velocities(|x| velocity + omega.cross(x - axle))
    }

    fn set_velocities(&mut self, field: impl Fn(DVec3) -> DVec3) -> Result<()> {
        let x = self.engine.state()?.x;
        let held = &self.model.mesh.held;
        let free = |n: usize, d: usize| held.get(n).is_none_or(|bits| bits >> d & 1 == 0);
        let velocity = |(n, &x): (usize, &[f64; 3])| {
            let v = field(DVec3::from(x)).to_array();
            std::array::from_fn(|d| if free(n, d) { v[d] } else { 0.0 })
        };
        let v: Vec<[f64; 3]> = x.iter().enumerate().map(velocity).collect();
        self.engine.set_velocity(&v, &self.state.rim.rate)?;
        let square = |v: &[f64; 3]| v.iter().map(|c| c * c).sum::<f64>();
        let kinetic = v.iter().zip(&self.model.mass).map(|(v, m)| 0.5 * m * square(v)).sum();
        let State { totals, rim, .. } = &mut self.state;
        totals.ledger.velocities_set(kinetic);
        totals.ledger.rim_set(rim.own_kinetic());
        self.state.control.before = 0.0;
        Ok(())
    }
}

//! Internal forces at any positions, by the step's own element pass and in its own buffers: meanwhile the state is on
//! the host, bit for bit, and goes back before anything else is asked for.

use super::buffers::step_stride;
use super::engine::GpuEngine;
use super::layout::decode;
use super::programs::element_groups;
use super::readback::Readback;
use crate::error::Result;
use crate::physics::material::Pace;

impl GpuEngine {
    /// Forces at `x`, `v`; see [`Engine::force`](crate::engine::Engine::force).
    pub(super) fn trial_force(&mut self, x: &[[f64; 3]], v: &[[f64; 3]]) -> Result<Vec<[f64; 3]>> {
        self.body.lend()?;
        let Self { body, programs, series, .. } = self;
        body.write_positions(x);
        body.write_velocities(v, false)?;
        if let Some(series) = series {
            // A change of shape without time: terms resist it with all of their modulus.
            body.write("fading", &series.fading(0.0, 0.0, Pace::Timed));
        }
        // Velocities are those of the positions' time.
        body.buffers.get("step").write(&body.gpu, &vec![0; step_stride(body.real())]);
        let mut read = Readback::default();
        // The gather pass writes where the velocities were: the element pass has read them.
        let forces = read.add(body.buffers.get("velocities"));
        let data = read.run(&body.gpu, |encoder| {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            programs.force.dispatch(&mut pass, element_groups(&body.counts), 0);
            programs.gather.dispatch(&mut pass, body.counts.groups(body.counts.nodes), 0);
        })?;
        let forces: Vec<[f64; 4]> = decode(body.real(), data.part(forces));
        Ok(body.by_model(forces.into_iter().map(|[x, y, z, _]| [x, y, z]).collect()))
    }
}

//! Internal forces at any positions, by the step's own element pass and in its own buffers: meanwhile the state is on
//! the host, bit for bit, and goes back before anything else is asked for.

use super::buffers::vec4;
use super::engine::GpuEngine;
use super::layout::{decode, encode};
use super::readback::Readback;
use super::upload::split;
use crate::error::Result;

impl GpuEngine {
    /// Forces at `x`, `v`; see [`Engine::force`](crate::engine::Engine::force).
    pub(super) fn trial_force(&mut self, x: &[[f64; 3]], v: &[[f64; 3]]) -> Result<Vec<[f64; 3]>> {
        self.lend()?;
        self.write_positions(x);
        let v: Vec<[f64; 4]> = self.by_device(v).into_iter().map(vec4).collect();
        self.buffers.get("velocities").write(&self.gpu, &encode(self.real(), &v));
        let mut read = Readback::default();
        // The gather pass writes where the velocities were: the element pass has read them.
        let forces = read.add(self.buffers.get("velocities"));
        let data = read.run(&self.gpu, |encoder| {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            self.force.dispatch(&mut pass, self.element_groups(), 0);
            self.gather.dispatch(&mut pass, self.counts.groups(self.counts.nodes), 0);
        })?;
        let forces: Vec<[f64; 4]> = decode(self.real(), data.part(forces));
        Ok(self.by_model(forces.into_iter().map(|[x, y, z, _]| [x, y, z]).collect()))
    }

    pub(super) fn write_positions(&self, x: &[[f64; 3]]) {
        let precision = self.choice.precision;
        let (hi, lo) = split(&self.by_device(x), self.frame, &self.masses, precision);
        let write = |name, data: &[[f64; 4]]| {
            self.buffers.get(name).write(&self.gpu, &encode(precision.real(), data));
        };
        write("positions", &hi);
        if precision.has_pairs() {
            write("positions_lo", &lo);
        }
    }

    /// Takes the state to the host, if it is not there.
    fn lend(&mut self) -> Result<()> {
        if self.lent.is_some() {
            return Ok(());
        }
        let lo: &[&'static str] = if self.choice.precision.has_pairs() { &["positions_lo"] } else { &[] };
        let names = [&["positions", "velocities", "viscous_work"], lo].concat();
        let mut read = Readback::default();
        let parts: Vec<_> = names.iter().map(|name| read.add(self.buffers.get(name))).collect();
        let data = read.run(&self.gpu, |_| {})?;
        self.lent =
            Some(names.into_iter().zip(parts).map(|(name, part)| (name, data.part(part).to_vec())).collect());
        Ok(())
    }

    /// Gives the device its state back.
    pub(super) fn restore(&mut self) -> Result<()> {
        let Some(lent) = self.lent.take() else { return Ok(()) };
        for (name, bytes) in lent {
            self.buffers.get(name).write(&self.gpu, &bytes);
        }
        // The trial may have met a failure, which is no step's.
        self.reset_failure();
        self.gpu.check()
    }
}

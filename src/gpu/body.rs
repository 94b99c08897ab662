//! The state of a body on the device: its buffers, how its nodes are numbered there, and what its positions are relative to.

use super::Gpu;
use super::buffers::{Buffers, vec4};
use super::counts::Counts;
use super::layout::{Real, decode, encode};
use super::order::Order;
use super::precision::Precision;
use super::readback::Readback;
use super::upload::split;
use crate::engine::State;
use crate::error::Result;

/// A body on the device.
pub struct Body {
    pub gpu: Gpu,
    pub buffers: Buffers,
    pub counts: Counts,
    pub precision: Precision,
    /// The model's numbers by the device's, where they differ.
    pub order: Option<Order>,
    /// Mass of each node, by the device's numbers [kg].
    pub masses: Vec<f64>,
    /// What positions on the device are relative to [m].
    pub frame: [f64; 3],
    /// The state, while the device's buffers serve for forces elsewhere.
    pub lent: Option<Vec<(&'static str, Vec<u8>)>>,
}

impl Body {
    /// What numbers are on the device.
    pub fn real(&self) -> Real {
        self.precision.real()
    }

    /// What stands by the device's nodes, by the model's.
    pub fn by_model<T: Copy + Default>(&self, values: Vec<T>) -> Vec<T> {
        match &self.order {
            Some(order) => order.to_model(&values),
            None => values,
        }
    }

    /// The reverse.
    pub fn by_device<T: Copy>(&self, values: &[T]) -> Vec<T> {
        self.order.as_ref().map_or(values.to_vec(), |order| order.to_device(values))
    }

    /// The model's number of an element.
    pub fn element(&self, number: usize) -> usize {
        self.order.as_ref().map_or(number, |order| order.elements[number] as usize)
    }

    /// Writes the first entries of a buffer.
    pub fn write<T: super::layout::Wgsl>(&self, name: &str, values: &[T]) {
        self.buffers.get(name).write(&self.gpu, &encode(self.real(), values));
    }

    /// Positions [m] and velocities [m/s] by the model's numbers, absolute.
    pub fn state(&self) -> Result<State> {
        let mut read = Readback::default();
        let (x, v) = (read.add(self.buffers.get("positions")), read.add(self.buffers.get("velocities")));
        let lo = self.precision.has_pairs().then(|| read.add(self.buffers.get("positions_lo")));
        let data = read.run(&self.gpu, |_| {})?;
        let vectors = |part| -> Vec<[f64; 4]> { decode(self.real(), data.part(part)) };
        let v = vectors(v).into_iter().map(|[x, y, z, _]| [x, y, z]).collect();
        Ok(State { x: self.absolute(&vectors(x), lo.map(vectors).as_deref()), v: self.by_model(v) })
    }

    /// Absolute positions; `lo`: what is beside them in pairs.
    fn absolute(&self, hi: &[[f64; 4]], lo: Option<&[[f64; 4]]>) -> Vec<[f64; 3]> {
        let at = |n: usize, d: usize| hi[n][d] + lo.map_or(0.0, |lo| lo[n][d]) + self.frame[d];
        self.by_model((0..hi.len()).map(|n| std::array::from_fn(|d| at(n, d))).collect())
    }

    /// Absolute positions [m] by the model's numbers.
    pub fn write_positions(&self, x: &[[f64; 3]]) {
        let (hi, lo) = split(&self.by_device(x), self.frame, &self.masses, self.precision);
        self.write("positions", &hi);
        if self.precision.has_pairs() {
            self.write("positions_lo", &lo);
        }
    }

    /// Velocities [m/s] by the model's numbers; `keep_works`: the works of a window that stand beside them stay there.
    pub fn write_velocities(&self, v: &[[f64; 3]], keep_works: bool) -> Result<()> {
        let mut v: Vec<[f64; 4]> = self.by_device(v).into_iter().map(vec4).collect();
        if keep_works {
            let mut read = Readback::default();
            let part = read.add(self.buffers.get("velocities"));
            let data = read.run(&self.gpu, |_| {})?;
            let old: Vec<[f64; 4]> = decode(self.real(), data.part(part));
            v.iter_mut().zip(&old).for_each(|(v, old)| v[3] = old[3]);
        }
        self.write("velocities", &v);
        Ok(())
    }

    /// No element has failed.
    pub fn reset_failure(&self) {
        self.buffers.get("failure").write(&self.gpu, bytemuck::cast_slice(&[u32::MAX; 4]));
    }

    /// Takes the state to the host, if it is not there.
    pub fn lend(&mut self) -> Result<()> {
        if self.lent.is_some() {
            return Ok(());
        }
        let lo: &[&'static str] = if self.precision.has_pairs() { &["positions_lo"] } else { &[] };
        let names = [&["positions", "velocities", "viscous_work"], lo].concat();
        let mut read = Readback::default();
        let parts: Vec<_> = names.iter().map(|name| read.add(self.buffers.get(name))).collect();
        let data = read.run(&self.gpu, |_| {})?;
        self.lent =
            Some(names.into_iter().zip(parts).map(|(name, part)| (name, data.part(part).to_vec())).collect());
        Ok(())
    }

    /// Gives the device its state back.
    pub fn restore(&mut self) -> Result<()> {
        let Some(lent) = self.lent.take() else { return Ok(()) };
        for (name, bytes) in lent {
            self.buffers.get(name).write(&self.gpu, &bytes);
        }
        // The trial may have met a failure, which is no step's.
        self.reset_failure();
        self.gpu.check()
    }
}

//! What a sample brings back: sums of the window, and the step that would come.

use super::counts::PARTIALS;
use super::engine::GpuEngine;
use super::layout::{Real, RimState, SurfaceRecord, Wgsl, decode};
use super::programs::element_groups;
use super::readback::Readback;
use super::upload::inverse_areas;
use crate::engine::{Probe, Step, SurfaceSum, Window, Works};
use crate::error::Result;

impl GpuEngine {
    /// Encodes everything a sample needs before it is copied out.
    fn encode_sample(&self, encoder: &mut wgpu::CommandEncoder) {
        let Self { programs, body, .. } = self;
        let (counts, stage, sums) = (&body.counts, programs.stage(), &programs.reductions);
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            programs.energy.dispatch(&mut pass, element_groups(counts), 0);
            sums.add_energies(&mut pass);
            sums.add_rim(&mut pass);
            sums.add_viscous(&mut pass);
            sums.add_loss(&mut pass);
        }
        if programs.choice.viscous {
            let (from, to) = (body.buffers.get("partials_viscous"), body.buffers.get("kept_viscous"));
            from.copy_to(encoder, to);
            body.buffers.get("viscous_work").clear(encoder);
        }
        if programs.has_free_rim() {
            let (from, to) = (body.buffers.get("rim_state"), body.buffers.get("rim_state_probe"));
            from.copy_to(encoder, to);
        }
        let mut pass = encoder.begin_compute_pass(&Default::default());
        programs.force.dispatch(&mut pass, element_groups(counts), 0);
        if let Some(rim) = &stage.probe_rim {
            rim.dispatch(&mut pass, [1, 1, 1], 0);
        }
        stage.probe.dispatch(&mut pass, counts.groups(counts.nodes), 0);
        sums.add_probes(&mut pass);
        sums.add_viscous(&mut pass);
        if let Some(surface) = &programs.surface_state {
            surface.dispatch(&mut pass, counts.groups(counts.surface), 0);
        }
    }

    fn clear_sums(&self) {
        let mut encoder = self.body.gpu.device.create_command_encoder(&Default::default());
        for name in ["rim_sums", "surface_sums", "viscous_work", "viscous_loss"] {
            self.body.buffers.get(name).clear(&mut encoder);
        }
        // The probe may have met the failure that the next step will report.
        self.body.gpu.queue.submit([encoder.finish()]);
        self.body.reset_failure();
    }

    /// The window since the last sample, and the probe; see [`Engine::sample`](crate::engine::Engine::sample). In one piece: it is a
    /// table of which sum is which quantity.
    pub(super) fn take_sample(&mut self, next: &Step) -> Result<Window> {
        self.body.restore()?;
        self.ready()?;
        let half = 0.5 * next.dt_before;
        let entry = self.plan_entry((self.pace.steps, 0), next, &self.rim.q, [half, 0.0, half], false);
        self.write_fading(std::slice::from_ref(next));
        self.write_plan(&[entry]);
        let mut read = Readback::default();
        let names = [
            "partials_rim",
            "kept_viscous",
            "partials_viscous",
            "partials_probes",
            "partials_energies",
            "surface_sums",
            "contact_states",
            "surface_states",
            "rim_state",
            "partials_loss",
        ];
        let parts = names.map(|n| read.add(self.body.buffers.get(n)));
        let data = read.run(&self.body.gpu, |encoder| self.encode_sample(encoder))?;
        let [rim, viscous, half_viscous, probes, energies, sums, contact, states, rim_state, loss] =
            parts.map(|p| data.part(p));
        if self.programs.has_free_rim() {
            self.rim.download(&RimState::take(self.body.real(), rim_state));
        }
        let mut window = Window {
            steps: std::mem::take(&mut self.pace.window_steps),
            rim: self.rim.q,
            rim_rate: self.rim.rate,
            step_contact: std::mem::take(&mut self.pace.step_contact),
            ..Window::default()
        };
        let real = self.body.real();
        let sum = |bytes: &[u8], column: usize| column_sum(real, bytes, column);
        let (e, least) = (sum(energies, 0), least_w(real, energies));
        (window.strain, window.hourglass, window.min_jacobian) = (e[0], e[1], least);
        let (w, r0, r1) = (sum(probes, 3), sum(rim, 0), sum(rim, 1));
        let total =
            |bytes: &[u8]| if self.programs.choice.viscous { sum(bytes, 0).iter().sum() } else { 0.0 };
        window.rim_impulse = [r0[0], r0[1], r0[2]];
        window.rim_moment_impulse = [r1[0], r1[1], r1[2]];
        window.works = Works {
            internal: w[0],
            viscous: total(viscous),
            damping: w[2],
            body_force: w[1],
            rim: r0[3],
            ..Works::default()
        };
        // Viscosity alone gives nothing back.
        let lost = |bytes: &[u8]| sum(bytes, 0).iter().sum();
        window.dissipated = if self.series.is_some() { lost(loss) } else { -window.works.viscous };
        let (p, h, c) = (sum(probes, 0), sum(probes, 1), sum(probes, 2));
        window.kinetic = p[1];
        window.probe = Probe {
            mixed_kinetic: p[0],
            half_works: Works {
                internal: h[0],
                viscous: total(half_viscous),
                damping: h[2],
                body_force: h[1],
                rim: h[3],
                normal: c[0],
                friction: c[1],
            },
            net_force: p[2].sqrt(),
            internal_force: p[3].sqrt(),
        };
        window.works.internal -= window.works.viscous;
        window.probe.half_works.internal -= window.probe.half_works.viscous;
        if self.body.counts.surface > 0 {
            self.read_surface(&mut window, [sums, contact, states]);
            self.refresh_areas(&window);
        }
        self.clear_sums();
        self.follow()?;
        self.write_rim();
        Ok(window)
    }

    /// Areas of the surface nodes at the end of a window, where friction looks at pressure.
    fn refresh_areas(&self, window: &Window) {
        let (Some(mesh), Some(road)) = (&self.mesh, &self.road) else { return };
        let at = |n: u32| match mesh.surface.binary_search(&n) {
            Ok(k) => window.surface[k].x,
            // A rim node beside the surface: its facet faces no road.
            Err(_) => mesh.nodes[n as usize],
        };
        let areas = inverse_areas(mesh, at, road, self.body.real());
        self.body.buffers.get("inverse_areas").write(&self.body.gpu, &areas);
    }

    fn read_surface(&self, window: &mut Window, [sums, contact, states]: [&[u8]; 3]) {
        let sums: Vec<SurfaceRecord> = decode(self.body.real(), sums);
        let contact: &[u32] = bytemuck::cast_slice(contact);
        let states: Vec<[f64; 4]> = decode(self.body.real(), states);
        for (k, record) in sums.iter().take(self.body.counts.surface).enumerate() {
            let [x, v] = [states[2 * k], states[2 * k + 1]];
            window.works.normal += record.normal_work;
            window.works.friction += record.friction_work;
            window.surface.push(SurfaceSum {
                x: std::array::from_fn(|d| x[d] + self.body.frame[d]),
                v: [v[0], v[1], v[2]],
                impulse: [0, 1, 2].map(|d| record.impulse[d]),
                friction_work: record.friction_work,
                road_work: record.impulse[3],
                touching: record.touching,
                sticking: record.sticking,
                touches: contact[k] != 0,
                sticks: contact[k] == 2,
            });
        }
    }
}

/// Sum of one column's partials, first to last, in double precision.
fn column_sum(real: Real, bytes: &[u8], column: usize) -> [f64; 4] {
    let partials: Vec<[f64; 4]> = decode(real, bytes);
    let mut sum = [0.0; 4];
    for partial in &partials[column * PARTIALS..(column + 1) * PARTIALS] {
        for (s, p) in sum.iter_mut().zip(partial) {
            *s += p;
        }
    }
    sum
}

fn least_w(real: Real, bytes: &[u8]) -> f64 {
    let partials: Vec<[f64; 4]> = decode(real, bytes);
    partials.iter().map(|p| p[3]).fold(f64::INFINITY, f64::min)
}

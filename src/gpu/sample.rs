//! What a sample brings back: sums of the window, and the step that would come.

use super::Gpu;
use super::buffers::Buffers;
use super::compose::{Choice, Kernel};
use super::engine::{GpuEngine, PARTIALS};
use super::layout::{Real, RimState, SurfaceRecord, Wgsl, decode};
use super::program::Program;
use super::readback::Readback;
use super::stage::{Bound, StagePrograms};
use super::upload::inverse_areas;
use crate::engine::{Probe, Step, SurfaceSum, Window, Works};
use crate::error::Result;

/// Sums of records.
pub struct Reductions {
    rim: Option<Bound>,
    viscous: Option<Bound>,
    probes: Bound,
    energies: Bound,
}

impl Reductions {
    pub fn new(gpu: &Gpu, choice: &Choice, buffers: &Buffers, rim: bool) -> Result<Self> {
        let make = |records: &'static str, partials: &'static str, width: f64, least: f64| -> Result<Bound> {
            let constants = [("width", width), ("least_w", least)];
            let program = Program::new(gpu, choice, Kernel::Reduce, &constants)?;
            Ok(Bound::new(gpu, program, |name| {
                buffers.get(if name == "records" { records } else { partials })
            }))
        };
        Ok(Reductions {
            rim: if rim { Some(make("rim_sums", "partials_rim", 2.0, 0.0)?) } else { None },
            viscous: if choice.viscous {
                Some(make("viscous_work", "partials_viscous", 1.0, 0.0)?)
            } else {
                None
            },
            probes: make("probes", "partials_probes", 4.0, 0.0)?,
            energies: make("energies", "partials_energies", 1.0, 1.0)?,
        })
    }
}

impl GpuEngine {
    /// Encodes everything a sample needs before it is copied out.
    fn encode_sample(&self, stage: &StagePrograms, encoder: &mut wgpu::CommandEncoder) {
        let counts = &self.counts;
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            self.energy.dispatch(&mut pass, self.element_groups(), 0);
            self.reductions.energies.dispatch(&mut pass, [PARTIALS as u32, 1, 1], 0);
            if let Some(rim) = &self.reductions.rim {
                rim.dispatch(&mut pass, [PARTIALS as u32, 2, 1], 0);
            }
            if let Some(viscous) = &self.reductions.viscous {
                viscous.dispatch(&mut pass, [PARTIALS as u32, 1, 1], 0);
            }
        }
        if self.reductions.viscous.is_some() {
            let (from, to) = (self.buffers.get("partials_viscous"), self.buffers.get("kept_viscous"));
            from.copy_to(encoder, to);
            self.buffers.get("viscous_work").clear(encoder);
        }
        if self.has_free_rim() {
            let (from, to) = (self.buffers.get("rim_state"), self.buffers.get("rim_state_probe"));
            from.copy_to(encoder, to);
        }
        let mut pass = encoder.begin_compute_pass(&Default::default());
        self.force.dispatch(&mut pass, self.element_groups(), 0);
        if let Some(rim) = &stage.probe_rim {
            rim.dispatch(&mut pass, [1, 1, 1], 0);
        }
        stage.probe.dispatch(&mut pass, counts.groups(counts.nodes), 0);
        self.reductions.probes.dispatch(&mut pass, [PARTIALS as u32, 4, 1], 0);
        if let Some(viscous) = &self.reductions.viscous {
            viscous.dispatch(&mut pass, [PARTIALS as u32, 1, 1], 0);
        }
        if let Some(surface) = &self.surface_state {
            surface.dispatch(&mut pass, counts.groups(counts.surface), 0);
        }
    }

    fn clear_sums(&self) {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        for name in ["rim_sums", "surface_sums", "viscous_work"] {
            self.buffers.get(name).clear(&mut encoder);
        }
        // The probe may have met the failure that the next step will report.
        self.gpu.queue.submit([encoder.finish()]);
        self.reset_failure();
    }

    pub(super) fn reset_failure(&self) {
        self.buffers.get("failure").write(&self.gpu, bytemuck::cast_slice(&[u32::MAX; 4]));
    }

    /// The window since the last sample, and the probe; see [`Engine::sample`](crate::engine::Engine::sample).
    pub(super) fn take_sample(&mut self, next: &Step) -> Result<Window> {
        self.restore()?;
        self.ready()?;
        let stage = self.stage.as_ref().expect("it is ready");
        let half = 0.5 * next.dt_before;
        let entry = self.plan_entry((self.steps, 0), next, &self.rim.q, [half, 0.0, half]);
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
        ];
        let parts = names.map(|n| read.add(self.buffers.get(n)));
        let data = read.run(&self.gpu, |encoder| self.encode_sample(stage, encoder))?;
        let [rim, viscous, half_viscous, probes, energies, sums, contact, states, rim_state] =
            parts.map(|p| data.part(p));
        if self.has_free_rim() {
            self.rim.download(&RimState::take(self.real(), rim_state));
        }
        let mut window = Window {
            steps: std::mem::take(&mut self.window_steps),
            rim: self.rim.q,
            rim_rate: self.rim.rate,
            step_contact: std::mem::take(&mut self.step_contact),
            ..Window::default()
        };
        let real = self.real();
        let sum = |bytes: &[u8], column: usize| column_sum(real, bytes, column);
        let (e, least) = (sum(energies, 0), least_w(real, energies));
        (window.strain, window.hourglass, window.min_jacobian) = (e[0], e[1], least);
        let (w, r0, r1) = (sum(probes, 3), sum(rim, 0), sum(rim, 1));
        let total = |bytes: &[u8]| if self.choice.viscous { sum(bytes, 0).iter().sum() } else { 0.0 };
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
        if self.counts.surface > 0 {
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
        let areas = inverse_areas(mesh, at, road, self.real());
        self.buffers.get("inverse_areas").write(&self.gpu, &areas);
    }

    fn read_surface(&self, window: &mut Window, [sums, contact, states]: [&[u8]; 3]) {
        let sums: Vec<SurfaceRecord> = decode(self.real(), sums);
        let contact: &[u32] = bytemuck::cast_slice(contact);
        let states: Vec<[f64; 4]> = decode(self.real(), states);
        for (k, record) in sums.iter().take(self.surface_nodes.len()).enumerate() {
            let [x, v] = [states[2 * k], states[2 * k + 1]];
            window.works.normal += record.normal_work;
            window.works.friction += record.friction_work;
            window.surface.push(SurfaceSum {
                x: std::array::from_fn(|d| x[d] + self.frame[d]),
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

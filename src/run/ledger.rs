//! From windows to history rows: totals, balances, means.

use super::chatter;
use crate::engine::{SurfaceSum, Window, Works};
use crate::model::Model;
use crate::model::areas::{contact_areas, extents};
use crate::physics::rim;
use crate::physics::tensor::dot;
use crate::record::Sample;
use crate::scene::Road;

/// Running totals of a simulation.
#[derive(Debug, Clone, Default)]
pub struct Ledger {
    works: Works,
    /// Kinetic energy put in by setting velocities [J], as the two balances see it.
    given_kinetic: f64,
    given_mixed: f64,
    /// Energies of the last window.
    kinetic: f64,
    mixed_kinetic: f64,
    started: bool,
    strain_start: f64,
    /// Largest single term so far [J]: what errors are relative to.
    pub largest_term: f64,
    pub worst_balance: f64,
    pub worst_stored_balance: f64,
    /// Deepest gap of a surface node at any sample [m]; not negative up to round-off.
    pub worst_gap: f64,
    /// Energy that friction has dissipated at every surface node [J] (empty before the first window with a road).
    pub friction_energy: Vec<f64>,
}

/// Where and when a window ends.
#[derive(Debug, Clone)]
pub struct WindowEnd {
    pub time: f64,
    /// Sum of the mean steps over which its forces acted [s].
    pub length: f64,
    pub dt: f64,
    pub stage: String,
}

impl Ledger {
    /// Adds what friction dissipates at each node: the road's tangential work on the body, less what the road puts in.
    fn book_friction(&mut self, road: Option<&Road>, w: &Window) {
        let Some(Road::Plane { velocity, .. }) = road else { return };
        self.friction_energy.resize(w.surface.len(), 0.0);
        for (energy, sum) in self.friction_energy.iter_mut().zip(&w.surface) {
            *energy += dot(sum.impulse, *velocity) - sum.friction_work;
        }
    }

    /// Velocities were set: `kinetic` is the new kinetic energy, at rest of nothing stored.
    pub fn velocities_set(&mut self, kinetic: f64) {
        self.given_kinetic += kinetic - self.kinetic;
        self.given_mixed += kinetic - self.mixed_kinetic;
        (self.kinetic, self.mixed_kinetic) = (kinetic, kinetic);
    }

    /// The stored energy before the first step.
    pub fn start(&mut self, strain: f64) {
        (self.started, self.strain_start) = (true, strain);
    }

    /// Books a window and makes its row.
    pub fn row(&mut self, model: &Model, road: Option<&Road>, end: &WindowEnd, w: &Window) -> Sample {
        debug_assert!(self.started);
        self.works.accumulate(&w.works);
        self.book_friction(road, w);
        (self.kinetic, self.mixed_kinetic) = (w.kinetic, w.probe.mixed_kinetic);
        let works = &self.works;
        let outer = works.without_internal();
        let balance = w.kinetic - self.given_kinetic - (outer + works.internal);
        let stored = w.strain + w.hourglass - self.strain_start + w.probe.mixed_kinetic
            - self.given_mixed
            - (outer + w.probe.half_works.without_internal());
        let terms = [
            w.kinetic,
            w.strain,
            self.given_kinetic,
            works.internal,
            works.viscous,
            works.damping,
            works.body_force,
            works.rim,
            works.normal,
            works.friction,
        ];
        self.largest_term = terms.iter().fold(self.largest_term, |m, t| m.max(t.abs()));
        self.worst_balance = self.worst_balance.max(balance.abs());
        self.worst_stored_balance = self.worst_stored_balance.max(stored.abs());
        let mut row = contact_part(model, road, end.length, w);
        if let Some(gap) = lowest_gap(road, w) {
            self.worst_gap = self.worst_gap.min(gap);
        }
        let mean = |i: f64| i / end.length;
        let road_impulse = |d: usize| w.surface.iter().map(|s| s.impulse[d]).sum::<f64>();
        [row.road_fx_N, row.road_fy_N, row.road_fz_N] = [0, 1, 2].map(|d| mean(road_impulse(d)));
        [row.road_fx_std_N, row.road_fy_std_N, row.road_fz_std_N] = chatter::deviation(&w.step_contact);
        [row.rim_fx_N, row.rim_fy_N, row.rim_fz_N] = w.rim_impulse.map(mean);
        [row.rim_mx_Nm, row.rim_my_Nm, row.rim_mz_Nm] = w.rim_moment_impulse.map(mean);
        [row.axle_x_m, row.axle_y_m, row.axle_z_m] = [w.rim[0], w.rim[1], w.rim[2]];
        Sample {
            time_s: end.time,
            stage: end.stage.clone(),
            rim_angle_rad: w.rim[rim::SPIN],
            steer_rad: w.rim[3],
            camber_rad: w.rim[4],
            kinetic_J: w.kinetic,
            strain_J: w.strain,
            hourglass_J: w.hourglass,
            external_work_J: works.rim + works.body_force,
            friction_work_J: works.friction,
            contact_work_J: works.normal,
            damping_work_J: works.damping,
            viscous_work_J: works.viscous,
            balance_error_J: balance,
            stored_balance_error_J: stored,
            min_jacobian: w.min_jacobian,
            dt_s: end.dt,
            ..row
        }
    }
}

/// Area, extents, number and states of the touching nodes.
fn contact_part(model: &Model, road: Option<&Road>, length: f64, w: &Window) -> Sample {
    let mut row = Sample::default();
    let Some(road) = road else { return row };
    let touching: u64 = w.surface.iter().map(|s| u64::from(s.touching)).sum();
    if touching == 0 {
        return row;
    }
    let sticking: u64 = w.surface.iter().map(|s| u64::from(s.sticking)).sum();
    let at = |n: u32| match model.mesh.surface.binary_search(&n) {
        Ok(k) => w.surface[k].x,
        // A rim node: no road contact, and only the corner of a facet beside one.
        Err(_) => model.mesh.nodes[n as usize],
    };
    let areas = contact_areas(&model.mesh, at, road);
    let share = |s: &SurfaceSum| f64::from(s.touching) / w.steps as f64;
    row.contact_area_m2 = w.surface.iter().zip(&areas).map(|(s, a)| share(s) * a).sum();
    row.contact_nodes = touching as f64 / w.steps as f64;
    row.sticking_share = sticking as f64 / touching as f64;
    let touches = |k: usize| 2 * u64::from(w.surface[k].touching) >= w.steps;
    let axes = road_axes(road, &w.rim);
    [row.footprint_length_m, row.footprint_width_m] = extents(&model.mesh, at, road, touches, axes);
    let Road::Plane { normal, .. } = road;
    let pressure = |(s, area): (&SurfaceSum, &f64)| {
        if *area > 0.0 { dot(s.impulse, *normal) / (length * area) } else { 0.0 }
    };
    row.peak_pressure_Pa = w.surface.iter().zip(&areas).map(pressure).fold(0.0, f64::max);
    let steps = &w.step_contact;
    let touched: u64 = steps.iter().map(|s| u64::from(s.touching)).sum();
    let changes: u64 = steps.iter().map(|s| u64::from(s.changes)).sum();
    row.changing_share = if touched > 0 { changes as f64 / touched as f64 } else { 0.0 };
    row
}

/// Unit vectors in the road: along the wheel's heading, and to its left.
pub fn road_axes(road: &Road, rim: &rim::Coordinates) -> [[f64; 3]; 2] {
    let Road::Plane { normal, .. } = *road;
    let normal = glam::DVec3::from(normal);
    // The axle is square to the heading; where it stands on end, x is taken.
    let across = rim::axle_direction(rim);
    let heading = Some(across.cross(normal)).filter(|h| h.length() > 1e-6).unwrap_or(glam::DVec3::X);
    let heading = heading.reject_from(normal).normalize_or(glam::DVec3::X);
    [heading.to_array(), normal.cross(heading).to_array()]
}

fn lowest_gap(road: Option<&Road>, w: &Window) -> Option<f64> {
    let Some(Road::Plane { point, normal, .. }) = road else { return None };
    let gap = |x: &[f64; 3]| (0..3).map(|d| normal[d] * (x[d] - point[d])).sum::<f64>();
    w.surface.iter().map(|s| gap(&s.x)).min_by(f64::total_cmp)
}

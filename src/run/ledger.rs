//! From windows to history rows: totals, balances, means.

use super::footprint::Footprint;
use super::scatter::Scatter;
use crate::engine::{Window, Works};
use crate::physics::rim;
use crate::record::Sample;
use crate::scene::Road;

/// Running totals of a simulation.
#[derive(Debug, Clone, Default)]
pub struct Ledger {
    works: Works,
    /// Kinetic energy put in by setting velocities [J], as the two balances see it.
    given_kinetic: f64,
    given_mixed: f64,
    /// Kinetic energy of the rim's own mass that was set, not worked for [J], and what it was last.
    rim_given: f64,
    rim_kinetic: f64,
    /// Energies of the last window.
    kinetic: f64,
    mixed_kinetic: f64,
    started: bool,
    strain_start: f64,
    /// Largest stored energy so far [J]: what matters of it is told by that.
    pub largest_stored: f64,
    /// Largest single term so far [J]: what errors are relative to.
    pub largest_term: f64,
    pub worst_balance: f64,
    pub worst_stored_balance: f64,
    /// Deepest gap of a surface node at any sample [m]; not negative up to round-off.
    pub worst_gap: f64,
    /// Energy that friction has dissipated at every surface node [J] (empty before the first window with a road).
    pub friction_energy: Vec<f64>,
    /// Work that the road's motion has put in [J].
    pub road_work: f64,
    /// Energy that viscosity and relaxation have turned into heat [J].
    dissipated: f64,
}

/// Where and when a window ends.
#[derive(Debug, Clone)]
pub struct WindowEnd {
    pub time: f64,
    /// Sum of the mean steps over which its forces acted [s].
    pub length: f64,
    pub dt: f64,
    pub stage: String,
    /// Kinetic energy of the rim's own mass and inertia [J].
    pub rim_kinetic: f64,
}

impl Ledger {
    /// Adds what friction dissipates at each node: the road's tangential work on the body, less what the road puts in.
    fn book_friction(&mut self, w: &Window) {
        self.friction_energy.resize(w.surface.len(), 0.0);
        for (energy, sum) in self.friction_energy.iter_mut().zip(&w.surface) {
            *energy += sum.road_work - sum.friction_work;
            self.road_work += sum.road_work;
        }
    }

    /// Velocities were set: `kinetic` is the new kinetic energy, at rest of nothing stored.
    pub fn velocities_set(&mut self, kinetic: f64) {
        self.given_kinetic += kinetic - self.kinetic;
        self.given_mixed += kinetic - self.mixed_kinetic;
        (self.kinetic, self.mixed_kinetic) = (kinetic, kinetic);
    }

    /// The rates of free components were set, or other components are free from now on: `kinetic` is the kinetic energy of
    /// the rim's own mass [J].
    pub fn rim_set(&mut self, kinetic: f64) {
        self.rim_given += kinetic - self.rim_kinetic;
        self.rim_kinetic = kinetic;
    }

    /// The stored energy before the first step.
    pub fn start(&mut self, strain: f64) {
        (self.started, self.strain_start) = (true, strain);
    }

    /// Books a window and makes its row; `footprint` and `scatter` were taken over its parts.
    ///
    /// The balances are those of the body, which the rim works on. The row's energies are those of body and rim: the work
    /// that was done on the rim's own mass, its change of kinetic energy, is added to both sides.
    pub fn row(
        &mut self,
        road: Option<&Road>,
        end: &WindowEnd,
        w: &Window,
        footprint: &Footprint,
        scatter: &Scatter,
    ) -> Sample {
        debug_assert!(self.started);
        self.rim_kinetic = end.rim_kinetic;
        let work_on_rim = self.rim_kinetic - self.rim_given;
        self.works.accumulate(&w.works);
        self.book_friction(w);
        self.dissipated += w.dissipated;
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
        self.largest_stored = self.largest_stored.max(w.strain + w.hourglass);
        self.worst_balance = self.worst_balance.max(balance.abs());
        self.worst_stored_balance = self.worst_stored_balance.max(stored.abs());
        let mut row = footprint.row();
        count_contact(&mut row, w, scatter);
        if let Some(gap) = lowest_gap(road, w) {
            self.worst_gap = self.worst_gap.min(gap);
        }
        let mean = |i: f64| i / end.length;
        let road_impulse = |d: usize| w.surface.iter().map(|s| s.impulse[d]).sum::<f64>();
        [row.road_fx_N, row.road_fy_N, row.road_fz_N] = [0, 1, 2].map(|d| mean(road_impulse(d)));
        [row.road_fx_std_N, row.road_fy_std_N, row.road_fz_std_N] = scatter.deviation();
        [row.rim_fx_N, row.rim_fy_N, row.rim_fz_N] = w.rim_impulse.map(mean);
        [row.rim_mx_Nm, row.rim_my_Nm, row.rim_mz_Nm] = w.rim_moment_impulse.map(mean);
        [row.axle_x_m, row.axle_y_m, row.axle_z_m] = [w.rim[0], w.rim[1], w.rim[2]];
        Sample {
            time_s: end.time,
            stage: end.stage.clone(),
            rim_angle_rad: w.rim[rim::SPIN],
            steer_rad: w.rim[3],
            camber_rad: w.rim[4],
            kinetic_J: w.kinetic + self.rim_kinetic,
            strain_J: w.strain,
            hourglass_J: w.hourglass,
            external_work_J: works.rim + works.body_force + work_on_rim,
            friction_work_J: works.friction,
            road_work_J: self.road_work,
            contact_work_J: works.normal,
            damping_work_J: works.damping,
            viscous_work_J: works.viscous,
            balance_error_J: balance,
            stored_balance_error_J: stored,
            min_jacobian: w.min_jacobian,
            dt_s: end.dt,
            dissipation_J: self.dissipated,
            ..row
        }
    }
}

/// Numbers and states of the touching nodes.
fn count_contact(row: &mut Sample, w: &Window, scatter: &Scatter) {
    let touching: u64 = w.surface.iter().map(|s| u64::from(s.touching)).sum();
    if touching == 0 {
        return;
    }
    let sticking: u64 = w.surface.iter().map(|s| u64::from(s.sticking)).sum();
    row.contact_nodes = touching as f64 / w.steps as f64;
    row.sticking_share = sticking as f64 / touching as f64;
    row.changing_share = scatter.changing_share();
}

fn lowest_gap(road: Option<&Road>, w: &Window) -> Option<f64> {
    let road = road?;
    w.surface.iter().map(|s| road.gap(s.x)).min_by(f64::total_cmp)
}

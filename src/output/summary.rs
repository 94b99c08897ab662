//! `summary.json`: how a run was made and what it came to.

use serde::{Deserialize, Deserializer, Serialize};

use super::stages::{self, Span};
use super::{ContactScatter, Rolling};
use crate::precision::Precision;
use crate::record::{ContactNoise, Estimate, Sample};
use crate::scene::{Method, Scene, Stage};

/// A run in numbers. Seconds, joules and newtons are in the names.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Summary {
    pub scene_file: String,
    pub title: String,
    /// SHA-256 of the scene's effective text, hexadecimal.
    pub scene_hash: String,
    /// SHA-256 of the mesh that was read from a file, hexadecimal; none of a generated one, which the scene's text says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh_hash: Option<String>,
    /// GPU adapter and its driver; none on the CPU engine.
    pub adapter: Option<String>,
    pub driver: Option<String>,
    /// `gpu` or `cpu`, and why it was taken, in words.
    pub engine: String,
    pub engine_reason: String,
    pub precision: Precision,
    pub threads: usize,
    pub elements: usize,
    pub nodes: usize,
    pub steps: u64,
    /// Simulated time [s].
    #[serde(deserialize_with = "number")]
    pub time_s: f64,
    /// Smallest and largest step used, and the critical step at the start [s].
    #[serde(deserialize_with = "number")]
    pub dt_min_s: f64,
    #[serde(deserialize_with = "number")]
    pub dt_max_s: f64,
    #[serde(deserialize_with = "number")]
    pub critical_dt_s: f64,
    #[serde(deserialize_with = "number")]
    pub wall_time_s: f64,
    #[serde(deserialize_with = "number")]
    pub element_updates_per_s: f64,
    /// Energy balance by accumulated work, and by stored energy.
    pub balance: WorstBalance,
    pub stored_balance: WorstBalance,
    /// Where hourglass energy was most beside the strain energy; none of an element without hourglass modes, or while
    /// nothing to speak of is stored.
    #[serde(default)]
    pub hourglass: Option<HourglassShare>,
    /// Energy that rounding alone makes: an error below it has no other cause, whatever its share [J].
    #[serde(default)]
    pub round_off_J: f64,
    /// Classes of the run's own errors in time and rounding, estimated.
    #[serde(default)]
    pub errors: Errors,
    /// Deepest surface node below the road at any sample [m], 0 if none was; none without a road.
    pub worst_penetration_m: Option<f64>,
    /// Whether every stage ran to its end.
    pub finished: bool,
    pub stages: Vec<StageMeans>,
    pub versions: Versions,
    pub warnings: Vec<String>,
}

/// Estimated classes of error, relative to forces and deformation ([`Estimate`]); none where a kind
/// does not arise or is not estimated.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Errors {
    /// What the length of the step does.
    pub time_step: Option<f64>,
    /// What the precision does.
    pub rounding: Option<f64>,
    /// Net over internal force that a relaxed stage ended with.
    pub residual: Option<f64>,
}

impl From<Estimate> for Errors {
    fn from(Estimate { time_step, rounding, residual }: Estimate) -> Errors {
        Errors { time_step, rounding, residual }
    }
}

/// The worst sample of an energy balance.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct WorstBalance {
    /// Largest absolute error [J].
    #[serde(deserialize_with = "number")]
    pub worst_error_J: f64,
    /// That error over the largest energy or work, by magnitude, of the whole run.
    #[serde(deserialize_with = "number")]
    pub share_of_largest_term: f64,
}

/// The largest share of hourglass energy at a time when the stored energy matters ([`Sample::hourglass_share`]).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct HourglassShare {
    /// Hourglass energy over strain energy.
    #[serde(deserialize_with = "number")]
    pub of_strain_energy: f64,
    /// When [s].
    #[serde(deserialize_with = "number")]
    pub time_s: f64,
}

impl HourglassShare {
    /// Of a history; `rounding`: what rounding leaves of its stored energies [J].
    pub fn of(history: &[Sample], rounding: f64) -> Option<HourglassShare> {
        let most = history.iter().map(Sample::stored).fold(0.0, f64::max);
        let share = |s: &Sample| {
            let of_strain_energy = s.hourglass_share(most, rounding)?;
            Some(HourglassShare { of_strain_energy, time_s: s.time_s })
        };
        let shares = history.iter().filter_map(share);
        shares.max_by(|a, b| a.of_strain_energy.total_cmp(&b.of_strain_energy))
    }
}

/// Means over the last 30 % of a stage's time.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct StageMeans {
    pub stage: String,
    #[serde(deserialize_with = "number")]
    pub start_s: f64,
    #[serde(deserialize_with = "number")]
    pub end_s: f64,
    /// Start of the part the means are taken over [s].
    #[serde(deserialize_with = "number")]
    pub means_from_s: f64,
    #[serde(deserialize_with = "number")]
    pub mean_road_fx_N: f64,
    #[serde(deserialize_with = "number")]
    pub mean_road_fy_N: f64,
    #[serde(deserialize_with = "number")]
    pub mean_road_fz_N: f64,
    #[serde(deserialize_with = "number")]
    pub mean_rim_fx_N: f64,
    #[serde(deserialize_with = "number")]
    pub mean_rim_fy_N: f64,
    #[serde(deserialize_with = "number")]
    pub mean_rim_fz_N: f64,
    #[serde(deserialize_with = "number")]
    pub mean_rim_mx_Nm: f64,
    #[serde(deserialize_with = "number")]
    pub mean_rim_my_Nm: f64,
    #[serde(deserialize_with = "number")]
    pub mean_rim_mz_Nm: f64,
    #[serde(deserialize_with = "number")]
    pub mean_axle_z_m: f64,
    #[serde(deserialize_with = "number")]
    pub mean_contact_area_m2: f64,
    /// Scatter of the contact force from step to step; none without contact, and of implicit stages.
    pub contact: Option<ContactScatter>,
    /// Figures of a wheel that rolls; none where nothing does.
    pub rolling: Option<Rolling>,
}

/// What the program was built from.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Versions {
    pub hexroll: String,
    pub wgpu: String,
}

impl Versions {
    /// This build's: the crate's version, and wgpu's as `Cargo.lock` fixes it.
    pub fn current() -> Versions {
        let lock = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.lock"));
        let wgpu = lock
            .split("[[package]]")
            .find_map(|package| package.trim_start().strip_prefix("name = \"wgpu\"\nversion = \""))
            .and_then(|rest| rest.split('"').next());
        Versions { hexroll: env!("CARGO_PKG_VERSION").into(), wgpu: wgpu.unwrap_or("unknown").into() }
    }
}

impl StageMeans {
    /// The means of every stage of a history. Of stages named in `settling` (quasi-static ones, which end at rest) the
    /// last window is taken instead.
    pub fn of(history: &[Sample], settling: &[&str]) -> Vec<StageMeans> {
        let of = |span: &Span| {
            let settles = settling.contains(&span.stage.as_str());
            let last = || stages::starts_at(history, span.rows.end - 1)..span.end;
            StageMeans::over(history, span, if settles { last() } else { span.tail() })
        };
        stages::spans(history).iter().map(of).collect()
    }

    fn over(history: &[Sample], span: &Span, tail: std::ops::Range<f64>) -> StageMeans {
        let mean = |value: fn(&Sample) -> f64| stages::mean(history, &tail, value);
        StageMeans {
            stage: span.stage.clone(),
            start_s: span.start,
            end_s: span.end,
            means_from_s: tail.start,
            mean_road_fx_N: mean(|s| s.road_fx_N),
            mean_road_fy_N: mean(|s| s.road_fy_N),
            mean_road_fz_N: mean(|s| s.road_fz_N),
            mean_rim_fx_N: mean(|s| s.rim_fx_N),
            mean_rim_fy_N: mean(|s| s.rim_fy_N),
            mean_rim_fz_N: mean(|s| s.rim_fz_N),
            mean_rim_mx_Nm: mean(|s| s.rim_mx_Nm),
            mean_rim_my_Nm: mean(|s| s.rim_my_Nm),
            mean_rim_mz_Nm: mean(|s| s.rim_mz_Nm),
            mean_axle_z_m: mean(|s| s.axle_z_m),
            mean_contact_area_m2: mean(|s| s.contact_area_m2),
            contact: None,
            rolling: None,
        }
    }

    /// The means of every stage of a run, with the scatter of its contact force, given as the run found it in each, and the
    /// figures of rolling; `free_radius`: what a longitudinal slip is related to [m].
    pub fn of_run(
        scene: &Scene,
        history: &[Sample],
        noise: &[Option<ContactNoise>],
        free_radius: Option<f64>,
    ) -> Vec<StageMeans> {
        let settles = |s: &&Stage| matches!(s.method, Method::QuasiStatic { .. });
        let settling: Vec<&str> = scene.stages.iter().filter(settles).map(|s| s.name.as_str()).collect();
        let mut means = StageMeans::of(history, &settling);
        let Some(road) = &scene.road else { return means };
        for ((i, mean), span) in means.iter_mut().enumerate().zip(stages::spans(history)) {
            // A quasi-static stage ends at rest: how it got there is nobody's concern.
            let Some(stage) = scene.stages.get(i).filter(|s| !settling.contains(&s.name.as_str())) else {
                continue;
            };
            let noise = noise.get(i).copied().flatten();
            let end = &history[span.rows.end - 1];
            let normal = road.normal([end.axle_x_m, end.axle_y_m, end.axle_z_m]);
            mean.contact = noise.and_then(|n| ContactScatter::of(&n, normal, scene.output.chatter_limit));
            if let Some(contact) = &mut mean.contact {
                contact.sticking_share = sticking(&history[span.rows.clone()], mean.means_from_s);
            }
            let radius = stage.slip.and(free_radius);
            mean.rolling = Rolling::of(history, &span, stage, road, radius);
        }
        means
    }
}

/// Sticking over touching nodes in the rows that end after `from`; none if none touches.
fn sticking(rows: &[Sample], from: f64) -> Option<f64> {
    let rows = || rows.iter().filter(|s| s.time_s > from);
    let touching = rows().map(|s| s.contact_nodes).sum::<f64>();
    let held = rows().map(|s| s.contact_nodes * s.sticking_share).sum::<f64>();
    (touching > 0.0).then(|| held / touching)
}

/// Energies and works that a balance adds up.
const TERMS: [fn(&Sample) -> f64; 8] = [
    |s| s.kinetic_J,
    |s| s.strain_J,
    |s| s.hourglass_J,
    |s| s.external_work_J,
    |s| s.friction_work_J,
    |s| s.contact_work_J,
    |s| s.damping_work_J,
    |s| s.viscous_work_J,
];

impl WorstBalance {
    /// The accumulated-work balance of a history.
    pub fn of(history: &[Sample]) -> WorstBalance {
        WorstBalance::of_column(history, |s| s.balance_error_J)
    }

    /// The stored-energy balance of a history.
    pub fn of_stored(history: &[Sample]) -> WorstBalance {
        WorstBalance::of_column(history, |s| s.stored_balance_error_J)
    }

    fn of_column(history: &[Sample], error: fn(&Sample) -> f64) -> WorstBalance {
        let worst_error_J = largest(history.iter().map(error));
        let term = largest(history.iter().flat_map(|s| TERMS.map(|term| term(s))));
        let share_of_largest_term = if worst_error_J == 0.0 { 0.0 } else { worst_error_J / term };
        WorstBalance { worst_error_J, share_of_largest_term }
    }
}

/// Largest magnitude; NaN if any value is.
pub(super) fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).fold(0.0, |worst, v| if v.is_nan() || v > worst { v } else { worst })
}

/// JSON has no NaN or infinity: they are written as null, and come back as NaN.
pub(super) fn number<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

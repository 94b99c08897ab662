//! What the command finds out, as it is written to JSON and read back.

use serde::{Deserialize, Serialize};

use super::cpu_limits::CpuLimits;
use super::critical::CriticalReport;
use super::floor::Bound;
use super::gpu_limits::GpuLimits;
use super::kind::Kind;
use super::machine::Machine;
use super::straight::StraightRun;
use super::work::Pass;

/// A whole record.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Report {
    pub machine: Machine,
    pub limits: Limits,
    pub rows: Vec<Row>,
    /// Rows that were asked for and are not there.
    pub missing: Vec<Missing>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub critical: Option<CriticalReport>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub straight: Vec<StraightRun>,
}

/// Measured limits of what the rows ran on.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Limits {
    pub cpu: Vec<CpuLimits>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gpu: Option<GpuLimits>,
}

/// Least, median and most of repeated measurements.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Spread {
    pub min: f64,
    pub median: f64,
    pub max: f64,
}

impl Spread {
    /// Of at least one value.
    pub fn of(mut values: Vec<f64>) -> Spread {
        values.sort_by(f64::total_cmp);
        let n = values.len();
        let median = 0.5 * (values[(n - 1) / 2] + values[n / 2]);
        Spread { min: values[0], median, max: values[n - 1] }
    }
}

/// One engine on one wheel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    pub engine: Kind,
    /// Instructions of a CPU engine, adapter of a GPU engine.
    pub lanes: String,
    /// 0 on a GPU.
    pub threads: usize,
    /// Independent wheels computed at the same time; rates are of all together.
    pub copies: usize,
    pub element: String,
    pub elements: usize,
    pub nodes: usize,
    /// `structured`, as generated; `shuffled`: elements and nodes in random order; `distorted`: every element of a shape
    /// of its own.
    pub mesh: String,
    pub contact: bool,
    /// Shear viscosity [Pa s]; 0: elastic.
    pub viscosity: f64,
    /// Time step [s].
    pub dt: f64,
    /// Steps taken in all, and steps of each of the repeated measurements.
    pub steps: u64,
    pub batch: usize,
    pub us_per_step: Spread,
    /// Whole-step element updates per second, from the median.
    pub updates_per_s: f64,
    /// Least time of a step by the limits, what share of the median it is, and what it comes from.
    pub floor_us: f64,
    pub fraction: f64,
    pub bound_by: Bound,
    pub bytes_per_update: f64,
    pub flops_per_update: f64,
    /// The largest share of the multiply-add rate that the force routine's mix of operations can reach: a sum or a
    /// product alone takes the place of both.
    pub mix: f64,
    /// Bytes and operations of a step by pass.
    pub passes: Vec<Pass>,
    /// Time by pass [us], where the device says.
    pub pass_us: Vec<f64>,
    pub steps_per_submit: Option<usize>,
    /// Memory that the engine takes, where it is large enough to be told from the rest [bytes].
    pub memory_per_element: Option<f64>,
    /// Of the positions after all steps against cpu-f64, relative to the deformation; none where it is not finite.
    pub error: Option<f64>,
    pub error_limit: f64,
    /// Why the fraction is below one half.
    pub reason: Option<String>,
}

impl Row {
    /// A fast wrong run is a failed run.
    pub fn failed(&self) -> bool {
        self.error.is_none_or(|e| e > self.error_limit)
    }
}

/// A row that is not there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Missing {
    pub engine: Kind,
    pub element: String,
    pub elements: usize,
    /// Did not fit or was not possible here (`false`), or went wrong (`true`).
    pub failed: bool,
    pub reason: String,
}

impl Report {
    /// Everything that went wrong, in words.
    pub fn failures(&self) -> Vec<String> {
        let of_row = |r: &Row| {
            let error = r.error.map_or("is not finite".into(), |e| format!("{e:.1e}"));
            format!(
                "{} {} {}: error {error} (limit {:.0e})",
                r.engine.name(),
                r.element,
                r.elements,
                r.error_limit
            )
        };
        let of_missing =
            |m: &Missing| format!("{} {} {}: {}", m.engine.name(), m.element, m.elements, m.reason);
        let wrong = self.rows.iter().filter(|r| r.failed()).map(of_row);
        wrong.chain(self.missing.iter().filter(|m| m.failed).map(of_missing)).collect()
    }
}

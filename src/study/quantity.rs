//! What a study or a sweep tabulates: means of a stage.

use crate::output::summary::StageMeans;

/// A mean by its name and unit.
#[derive(Debug, Clone, Copy)]
pub struct Quantity {
    /// Name of the column.
    pub name: &'static str,
    pub symbol: &'static str,
    pub unit: &'static str,
    /// In the column's unit; NaN where the run has none.
    pub value: fn(&StageMeans) -> f64,
}

fn rolling(means: &StageMeans, value: fn(&crate::output::Rolling) -> f64) -> f64 {
    means.rolling.as_ref().map_or(f64::NAN, value)
}

/// Every quantity, in the order of the tables.
pub const QUANTITIES: [Quantity; 14] = [
    Quantity { name: "road_fx", symbol: "Fx", unit: "N", value: |m| m.mean_road_fx_N },
    Quantity { name: "road_fy", symbol: "Fy", unit: "N", value: |m| m.mean_road_fy_N },
    Quantity { name: "road_fz", symbol: "Fz", unit: "N", value: |m| m.mean_road_fz_N },
    Quantity { name: "rim_mx", symbol: "Mx", unit: "N m", value: |m| m.mean_rim_mx_Nm },
    Quantity { name: "rim_my", symbol: "My", unit: "N m", value: |m| m.mean_rim_my_Nm },
    Quantity { name: "rim_mz", symbol: "Mz", unit: "N m", value: |m| m.mean_rim_mz_Nm },
    Quantity { name: "axle_z", symbol: "axle height", unit: "mm", value: |m| 1e3 * m.mean_axle_z_m },
    Quantity {
        name: "contact_area",
        symbol: "contact area",
        unit: "mm2",
        value: |m| 1e6 * m.mean_contact_area_m2,
    },
    Quantity {
        name: "aligning_moment",
        symbol: "aligning moment",
        unit: "N m",
        value: |m| rolling(m, |r| r.aligning_moment_Nm),
    },
    Quantity {
        name: "pneumatic_trail",
        symbol: "pneumatic trail",
        unit: "mm",
        value: |m| rolling(m, |r| r.pneumatic_trail_m.map_or(f64::NAN, |t| 1e3 * t)),
    },
    Quantity {
        name: "rolling_resistance",
        symbol: "rolling resistance",
        unit: "N",
        value: |m| rolling(m, |r| r.rolling_resistance_N),
    },
    Quantity {
        name: "effective_radius",
        symbol: "effective radius",
        unit: "mm",
        value: |m| rolling(m, |r| 1e3 * r.effective_radius_m),
    },
    Quantity {
        name: "footprint_length",
        symbol: "footprint length",
        unit: "mm",
        value: |m| rolling(m, |r| 1e3 * r.footprint_length_m),
    },
    Quantity {
        name: "peak_pressure",
        symbol: "peak pressure",
        unit: "kPa",
        value: |m| rolling(m, |r| 1e-3 * r.peak_pressure_Pa),
    },
];

/// A force or moment below this share of the largest of its kind is zero by symmetry, or as good as that.
const NOTHING: f64 = 1e-4;

/// Runs whose values differ by less than this, relative, have the value prescribed.
const SAME: f64 = 1e-9;

/// The quantities that some of the runs have, that are more than round-off beside others of their unit, and that are not
/// the same in all of several runs.
pub fn present(means: &[&StageMeans]) -> Vec<Quantity> {
    let size = |q: &Quantity| means.iter().map(|m| (q.value)(m).abs()).fold(0.0, f64::max);
    let scale = |unit: &str| QUANTITIES.iter().filter(|q| q.unit == unit).map(size).fold(0.0, f64::max);
    let varies = |q: &Quantity| {
        let first = means.first().map_or(0.0, |m| (q.value)(m));
        let same = |m: &&StageMeans| ((q.value)(m) - first).abs() <= SAME * first.abs();
        means.len() < 2 || !means.iter().all(same)
    };
    let something = |q: &Quantity| size(q) > NOTHING * scale(q.unit);
    QUANTITIES.into_iter().filter(|q| something(q) && varies(q)).collect()
}

/// A value for a table: 0 where it is round-off beside the others of its quantity.
pub fn cleaned(value: f64, all: impl Iterator<Item = f64>) -> f64 {
    let size = all.map(f64::abs).fold(0.0, f64::max);
    if value.abs() < SAME * size { 0.0 } else { value }
}

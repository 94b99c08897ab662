//! Plots of a history: which columns stand together.

use hexroll::output::stages::Span;
use hexroll::plot::svg::Event;
use hexroll::plot::{Mark, Panel, Series};
use hexroll::record::Sample;

/// Columns that share a pair of axes.
struct Group {
    title: &'static str,
    axis: &'static str,
    /// From SI to the axis's unit.
    factor: f64,
    /// Names of columns, and what the plot calls them; one alone needs no name.
    columns: &'static [(&'static str, &'static str)],
}

/// Forces, and what a wheel does.
const MOTION: &[Group] = &[
    Group {
        title: "Road on the body",
        axis: "force [N]",
        factor: 1.0,
        columns: &[("road_fx_N", "fx"), ("road_fy_N", "fy"), ("road_fz_N", "fz")],
    },
    Group {
        title: "Scatter of that force between steps",
        axis: "standard deviation [N]",
        factor: 1.0,
        columns: &[("road_fx_std_N", "fx"), ("road_fy_std_N", "fy"), ("road_fz_std_N", "fz")],
    },
    Group {
        title: "Rim on the body",
        axis: "force [N]",
        factor: 1.0,
        columns: &[("rim_fx_N", "fx"), ("rim_fy_N", "fy"), ("rim_fz_N", "fz")],
    },
    Group {
        title: "Rim on the body, about the axle",
        axis: "moment [N m]",
        factor: 1.0,
        columns: &[("rim_mx_Nm", "mx"), ("rim_my_Nm", "my"), ("rim_mz_Nm", "mz")],
    },
    Group { title: "Height of the axle", axis: "z [mm]", factor: 1e3, columns: &[("axle_z_m", "")] },
    Group {
        title: "Spin angle of the rim",
        axis: "angle [rad]",
        factor: 1.0,
        columns: &[("rim_angle_rad", "")],
    },
];

const FOOTPRINT: &[Group] = &[
    Group { title: "Contact area", axis: "area [mm2]", factor: 1e6, columns: &[("contact_area_m2", "")] },
    Group {
        title: "Footprint",
        axis: "extent [mm]",
        factor: 1e3,
        columns: &[("footprint_length_m", "length"), ("footprint_width_m", "width")],
    },
    Group {
        title: "Peak pressure",
        axis: "pressure [kPa]",
        factor: 1e-3,
        columns: &[("peak_pressure_Pa", "")],
    },
    Group { title: "Touching nodes", axis: "nodes", factor: 1.0, columns: &[("contact_nodes", "")] },
    Group {
        title: "Contact states",
        axis: "share of touching nodes",
        factor: 1.0,
        columns: &[("sticking_share", "stick"), ("changing_share", "change in a step")],
    },
];

const ENERGY: &[Group] = &[
    Group {
        title: "Stored energies",
        axis: "energy [J]",
        factor: 1.0,
        columns: &[("kinetic_J", "kinetic"), ("strain_J", "strain"), ("hourglass_J", "hourglass")],
    },
    Group {
        title: "Works on the body",
        axis: "work [J]",
        factor: 1.0,
        columns: &[
            ("external_work_J", "external"),
            ("friction_work_J", "friction"),
            ("road_work_J", "road"),
            ("contact_work_J", "contact"),
            ("damping_work_J", "damping"),
            ("viscous_work_J", "viscous"),
        ],
    },
    Group {
        title: "Error of the balance by work done",
        axis: "error [J]",
        factor: 1.0,
        columns: &[("balance_error_J", "")],
    },
    Group {
        title: "Error of the balance by stored energy",
        axis: "error [J]",
        factor: 1.0,
        columns: &[("stored_balance_error_J", "")],
    },
    Group { title: "Smallest det F", axis: "det F", factor: 1.0, columns: &[("min_jacobian", "")] },
    Group { title: "Step", axis: "dt [us]", factor: 1e6, columns: &[("dt_s", "")] },
];

/// Plots of forces and motion.
pub fn motion(history: &[Sample]) -> Vec<Panel> {
    panels(MOTION, history)
}

pub fn footprint(history: &[Sample]) -> Vec<Panel> {
    panels(FOOTPRINT, history)
}

pub fn energy(history: &[Sample]) -> Vec<Panel> {
    panels(ENERGY, history)
}

/// Where stages begin.
pub fn starts(spans: &[Span]) -> Vec<Event> {
    spans.iter().map(|span| Event { x: span.start, name: span.stage.clone() }).collect()
}

/// Every group that has something to show: a column that is zero throughout is left out.
fn panels(groups: &[Group], history: &[Sample]) -> Vec<Panel> {
    let series = |group: &Group, (column, label): &(&str, &str)| {
        let (_, value) = Sample::COLUMNS.iter().find(|(name, _)| name == column)?;
        let points: Vec<[f64; 2]> = history.iter().map(|s| [s.time_s, group.factor * value(s)]).collect();
        let something = points.iter().any(|p| p[1] != 0.0);
        something.then(|| Series { label: (*label).into(), points, bars: Vec::new(), mark: Mark::Curve })
    };
    let panel = |group: &Group| {
        let series: Vec<Series> = group.columns.iter().filter_map(|c| series(group, c)).collect();
        let (title, y) = (group.title.into(), group.axis.into());
        (!series.is_empty()).then(|| Panel { title, x: "time [s]".into(), y, series, log_x: false })
    };
    groups.iter().filter_map(panel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_column_that_is_plotted_exists() {
        let known: Vec<&str> = Sample::COLUMNS.iter().map(|(name, _)| *name).collect();
        let groups = [MOTION, FOOTPRINT, ENERGY].into_iter().flatten();
        let plotted: Vec<&str> = groups.flat_map(|g| g.columns.iter().map(|c| c.0)).collect();
        for column in &plotted {
            assert!(known.contains(column), "no column {column}");
        }
        assert_eq!(plotted.len(), 34);
    }

    #[test]
    fn what_is_zero_throughout_is_left_out() {
        let history: Vec<Sample> = (0..5)
            .map(|i| Sample {
                time_s: f64::from(i),
                road_fz_N: f64::from(i),
                axle_z_m: 0.04,
                ..Sample::default()
            })
            .collect();
        let panels = motion(&history);
        let titles: Vec<&str> = panels.iter().map(|p| p.title.as_str()).collect();
        assert_eq!(titles, ["Road on the body", "Height of the axle"]);
        assert_eq!(panels[0].series.len(), 1);
        assert_eq!(panels[1].series[0].points[3], [3.0, 40.0]);
    }
}

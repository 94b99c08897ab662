//! What a tyre engineer reads first: forces in the wheel's axes, radii, losses, footprint.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::stages::{self, Span};
use super::summary::number;
use crate::model::areas::road_axes;
use crate::physics::tensor::{dot, sub};
use crate::record::Sample;
use crate::scene::{Road, Stage};

/// A rolling wheel over the last 30 % of a stage. Axes lie in the road: along the wheel's heading, and to its left;
/// the normal points up. Forces and moments are the road's on the wheel.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Rolling {
    /// Speed of the axle over the road, and spin.
    #[serde(deserialize_with = "number")]
    pub speed_m_s: f64,
    #[serde(deserialize_with = "number")]
    pub spin_rad_s: f64,
    /// From the heading to the velocity, positive to the left.
    #[serde(deserialize_with = "number")]
    pub slip_angle_deg: f64,
    /// (omega R_free - v)/v, where the scene gives or measures the free-rolling radius.
    pub longitudinal_slip: Option<f64>,
    #[serde(deserialize_with = "number")]
    pub longitudinal_force_N: f64,
    #[serde(deserialize_with = "number")]
    pub side_force_N: f64,
    #[serde(deserialize_with = "number")]
    pub normal_force_N: f64,
    /// About the normal through the wheel's centre.
    #[serde(deserialize_with = "number")]
    pub aligning_moment_Nm: f64,
    /// How far behind the wheel's centre the side force acts: - aligning moment / side force. None below 1 % of the
    /// normal force.
    pub pneumatic_trail_m: Option<f64>,
    /// All losses over the way: energy per metre, and the parts of it by friction (slip), viscosity, and landing nodes
    /// and damping.
    #[serde(deserialize_with = "number")]
    pub rolling_resistance_N: f64,
    #[serde(deserialize_with = "number")]
    pub friction_loss_N: f64,
    #[serde(deserialize_with = "number")]
    pub viscous_loss_N: f64,
    #[serde(deserialize_with = "number")]
    pub other_loss_N: f64,
    /// Height of the axle over the road.
    #[serde(deserialize_with = "number")]
    pub loaded_radius_m: f64,
    /// Speed along the heading over spin; at a rim without torque that is the free-rolling radius.
    #[serde(deserialize_with = "number")]
    pub effective_radius_m: f64,
    pub free_rolling_radius_m: Option<f64>,
    #[serde(deserialize_with = "number")]
    pub footprint_length_m: f64,
    #[serde(deserialize_with = "number")]
    pub footprint_width_m: f64,
    #[serde(deserialize_with = "number")]
    pub footprint_area_m2: f64,
    #[serde(deserialize_with = "number")]
    pub mean_pressure_Pa: f64,
    #[serde(deserialize_with = "number")]
    pub peak_pressure_Pa: f64,
}

/// A wheel that turns by less than this over the tail does not roll [rad].
const LEAST_TURN: f64 = 1e-3;

impl Rolling {
    /// The figures of a stage; none unless it rolls on a road. `free_radius`: what its longitudinal slip is related to [m]. In one
    /// piece: it is the list of the figures' formulas.
    pub fn of(
        history: &[Sample],
        span: &Span,
        stage: &Stage,
        road: &Road,
        free_radius: Option<f64>,
    ) -> Option<Rolling> {
        let tail = span.tail();
        let (first, last) = ends(history, span, &tail)?;
        let length = last.time_s - first.time_s;
        let rate = |value: fn(&Sample) -> f64| (value(last) - value(first)) / length;
        let spin_rad_s = rate(|s| s.rim_angle_rad);
        let axle = |s: &Sample| [s.axle_x_m, s.axle_y_m, s.axle_z_m];
        let travel = sub(axle(last), axle(first)).map(|d| d / length);
        let mean = |value: fn(&Sample) -> f64| stages::mean(history, &tail, value);
        let place = [mean(|s| s.axle_x_m), mean(|s| s.axle_y_m), mean(|s| s.axle_z_m)];
        let (normal, velocity) = (road.normal(place), road.velocity(place));
        let v = sub(travel, velocity);
        let speed_m_s = dot(v, v).sqrt();
        let way = speed_m_s * length;
        if (spin_rad_s * length).abs() < LEAST_TURN || way == 0.0 {
            return None;
        }
        let force = [mean(|s| s.road_fx_N), mean(|s| s.road_fy_N), mean(|s| s.road_fz_N)];
        let moment = [mean(|s| -s.rim_mx_Nm), mean(|s| -s.rim_my_Nm), mean(|s| -s.rim_mz_Nm)];
        let [heading, left] = road_axes(
            road,
            &[place[0], place[1], place[2], mean(|s| s.steer_rad), mean(|s| s.camber_rad), 0.0],
        );
        let [ahead, aside] = [dot(v, heading), dot(v, left)];
        let [side_force_N, normal_force_N] = [dot(force, left), dot(force, normal)];
        let aligning_moment_Nm = dot(moment, normal);
        let loss = |value: fn(&Sample) -> f64| -rate(value) * length / way;
        let friction_loss_N = loss(|s| s.friction_work_J - s.road_work_J);
        let viscous_loss_N = loss(|s| s.viscous_work_J);
        let other_loss_N = loss(|s| s.contact_work_J + s.damping_work_J);
        let effective_radius_m = ahead / spin_rad_s;
        let area = mean(|s| s.contact_area_m2);
        Some(Rolling {
            speed_m_s,
            spin_rad_s,
            slip_angle_deg: aside.atan2(ahead).to_degrees(),
            longitudinal_slip: free_radius.map(|radius| (spin_rad_s * radius - ahead) / ahead),
            longitudinal_force_N: dot(force, heading),
            side_force_N,
            normal_force_N,
            aligning_moment_Nm,
            pneumatic_trail_m: (side_force_N.abs() > 0.01 * normal_force_N.abs())
                .then(|| -aligning_moment_Nm / side_force_N),
            rolling_resistance_N: friction_loss_N + viscous_loss_N + other_loss_N,
            friction_loss_N,
            viscous_loss_N,
            other_loss_N,
            loaded_radius_m: road.height(place),
            effective_radius_m,
            free_rolling_radius_m: stage.rolls_freely().then_some(effective_radius_m),
            footprint_length_m: mean(|s| s.footprint_length_m),
            footprint_width_m: mean(|s| s.footprint_width_m),
            footprint_area_m2: area,
            mean_pressure_Pa: if area > 0.0 { normal_force_N / area } else { 0.0 },
            peak_pressure_Pa: mean(|s| s.peak_pressure_Pa),
        })
    }
}

/// The rows at which the tail begins (the last that ends by then, in the stage if it can be) and ends.
fn ends<'h>(history: &'h [Sample], span: &Span, tail: &Range<f64>) -> Option<(&'h Sample, &'h Sample)> {
    let rows = &history[span.rows.clone()];
    let last = rows.last()?;
    let slack = 1e-9 * (span.end - span.start);
    let first = rows.iter().rev().find(|s| s.time_s <= tail.start + slack).unwrap_or(&rows[0]);
    (last.time_s > first.time_s).then_some((first, last))
}

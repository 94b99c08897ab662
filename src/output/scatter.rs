//! Whether a rolling run's contact force is smooth, hums with its mesh, or chatters.

use serde::{Deserialize, Serialize};

use super::summary::number;
use crate::physics::tensor::dot;
use crate::record::ContactNoise;
use crate::scene::Road;

/// What the scatter of the contact force says of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    #[default]
    Smooth,
    /// The corners of a coarse ring mesh are heard: a matter of the mesh, periodic, without a mean.
    Tone,
    /// Constant friction on a body with too little viscosity: the means are not to be believed.
    Chattering,
}

/// Scatter of the road's force from step to step over the last 30 % of a stage; x, y, z.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ContactScatter {
    pub verdict: Verdict,
    #[serde(deserialize_with = "number")]
    pub from_s: f64,
    #[serde(deserialize_with = "number")]
    pub to_s: f64,
    pub steps: u64,
    #[serde(deserialize_with = "number")]
    pub mean_normal_N: f64,
    /// Standard deviation of the single steps about the mean [N].
    pub std_N: [f64; 3],
    /// Node-passing tone of a ring mesh, with its multiples: frequency, standard deviation, and its worst component over
    /// the mean normal force. None without a spinning ring.
    pub tone_Hz: Option<f64>,
    pub tone_std_N: [f64; 3],
    #[serde(deserialize_with = "number")]
    pub tone_share: f64,
    /// What is left without the tone and a linear drift: standard deviation, and its worst component over the mean
    /// normal force.
    pub remaining_std_N: [f64; 3],
    #[serde(deserialize_with = "number")]
    pub remaining_share: f64,
    /// Nodes that change their contact state from one step to the next, over touching nodes.
    #[serde(deserialize_with = "number")]
    pub changing_share: f64,
    /// Share above which a scatter is named.
    #[serde(deserialize_with = "number")]
    pub limit: f64,
}

impl ContactScatter {
    /// Judges a stage's noise; none where the body was off the road.
    pub fn of(noise: &ContactNoise, road: &Road, limit: f64) -> Option<ContactScatter> {
        let Road::Plane { normal, .. } = road;
        let mean_normal_N = dot(noise.mean, *normal);
        if mean_normal_N <= 0.0 {
            return None;
        }
        let share = |std: [f64; 3]| std.into_iter().fold(0.0, f64::max) / mean_normal_N;
        let tone_std_N = noise.tone.map_or([0.0; 3], |t| t.std);
        let (tone_share, remaining_share) = (share(tone_std_N), share(noise.remaining));
        let verdict = if remaining_share > limit {
            Verdict::Chattering
        } else if tone_share > limit {
            Verdict::Tone
        } else {
            Verdict::Smooth
        };
        Some(ContactScatter {
            verdict,
            from_s: noise.start,
            to_s: noise.end,
            steps: noise.steps,
            mean_normal_N,
            std_N: noise.std,
            tone_Hz: noise.tone.map(|t| t.frequency),
            tone_std_N,
            tone_share,
            remaining_std_N: noise.remaining,
            remaining_share,
            changing_share: noise.changing_share,
            limit,
        })
    }
}

//! Whether a rolling run's contact force is smooth, hums with its mesh, or chatters.

use serde::{Deserialize, Serialize};

use super::summary::number;
use crate::physics::tensor::dot;
use crate::record::ContactNoise;

/// What the scatter of the contact force says of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    #[default]
    Smooth,
    /// The corners of a coarse ring mesh are heard: a matter of the mesh, periodic, without a mean.
    Tone,
    /// Constant friction on a body with too little viscosity: nodes leave the road and come back, and what depends on
    /// them is not to be believed.
    Chattering,
    /// The scatter is no larger than what rounding does to forces: the precision is too low for this body and load.
    Rounding,
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
    /// Sticking over touching nodes in the same time; none of runs that did not note it.
    #[serde(default)]
    pub sticking_share: Option<f64>,
    /// Share above which a scatter is named.
    #[serde(deserialize_with = "number")]
    pub limit: f64,
}

/// Steps that a judgement takes: some hundred, the periods of a body's lower modes.
const LEAST_STEPS: u64 = 300;

impl ContactScatter {
    /// Judges a stage's noise; none where the body has left the road on the way, or of so few steps that a motion looks
    /// like noise.
    ///
    /// `normal`: of the road where the body touches it.
    pub fn of(noise: &ContactNoise, normal: [f64; 3], limit: f64) -> Option<ContactScatter> {
        let mean_normal_N = dot(noise.mean, normal);
        if mean_normal_N <= 0.0 || noise.free_steps > 0 || noise.steps < LEAST_STEPS {
            return None;
        }
        let share = |std: [f64; 3]| std.into_iter().fold(0.0, f64::max) / mean_normal_N;
        let tone_std_N = noise.tone.map_or([0.0; 3], |t| t.std);
        let (tone_share, remaining_share) = (share(tone_std_N), share(noise.remaining));
        let verdict = if remaining_share > limit {
            if noise.rounding.is_some_and(|class| class >= remaining_share) {
                Verdict::Rounding
            } else {
                Verdict::Chattering
            }
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
            sticking_share: None,
            limit,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Tone;

    const UP: [f64; 3] = [0.0, 0.0, 1.0];

    /// 300 N, with a tone and a rest of so many newtons along z.
    fn noise(tone: f64, rest: f64) -> ContactNoise {
        let along = |z: f64| [0.0, 0.0, z];
        ContactNoise {
            steps: 2000,
            mean: along(300.0),
            std: along(tone.hypot(rest)),
            tone: Some(Tone { frequency: 490.0, std: along(tone) }),
            remaining: along(rest),
            ..ContactNoise::default()
        }
    }

    #[test]
    fn the_limit_parts_smooth_from_tone_and_chatter() {
        let verdict = |tone, rest, limit| ContactScatter::of(&noise(tone, rest), UP, limit).unwrap().verdict;
        assert_eq!(verdict(14.9, 14.9, 0.05), Verdict::Smooth);
        assert_eq!(verdict(15.1, 14.9, 0.05), Verdict::Tone);
        assert_eq!(verdict(14.9, 15.1, 0.05), Verdict::Chattering);
        assert_eq!(verdict(50.0, 15.1, 0.05), Verdict::Chattering, "chatter matters more");
        assert_eq!(verdict(50.0, 15.1, 0.2), Verdict::Smooth);
        // Chatter has no cause beside the one that is as large as it.
        let rounded = |rounding| ContactNoise { rounding, ..noise(0.0, 30.0) };
        let verdict = |rounding| ContactScatter::of(&rounded(rounding), UP, 0.05).unwrap().verdict;
        assert_eq!(verdict(Some(0.09)), Verdict::Chattering);
        assert_eq!(verdict(Some(0.11)), Verdict::Rounding);
        // Sideways scatter counts against the normal force too.
        let sideways = ContactNoise { remaining: [0.0, 16.0, 0.0], ..noise(0.0, 0.0) };
        assert_eq!(ContactScatter::of(&sideways, UP, 0.05).unwrap().verdict, Verdict::Chattering);
    }

    #[test]
    fn what_leaves_the_road_or_hardly_steps_is_not_judged() {
        let judged = |noise: ContactNoise| ContactScatter::of(&noise, UP, 0.05).is_some();
        assert!(judged(noise(1.0, 1.0)));
        assert!(!judged(ContactNoise { free_steps: 1, ..noise(1.0, 1.0) }));
        assert!(!judged(ContactNoise { steps: 200, ..noise(1.0, 1.0) }));
        assert!(!judged(ContactNoise { mean: [0.0; 3], ..noise(1.0, 1.0) }));
    }
}

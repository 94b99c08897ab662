//! The nearest point of a smooth height over a plane.

use std::cmp::Ordering;

/// A smooth height: value and slopes along u and v.
pub trait Smooth {
    /// Height [m] and its two slopes at (u, v).
    fn height(&self, u: f64, v: f64) -> [f64; 3];
}

/// A point of the surface: u, v, height and slopes there.
#[derive(Debug, Clone, Copy)]
pub struct Foot {
    pub place: [f64; 2],
    pub height: f64,
    pub slope: [f64; 2],
}

impl Foot {
    fn at(surface: &impl Smooth, place: [f64; 2]) -> Foot {
        let [height, along, across] = surface.height(place[0], place[1]);
        Foot { place, height, slope: [along, across] }
    }

    fn square_distance(&self, x: [f64; 3]) -> f64 {
        let [a, b, c] = self.offset(x);
        a * a + b * b + c * c
    }

    fn offset(&self, x: [f64; 3]) -> [f64; 3] {
        [x[0] - self.place[0], x[1] - self.place[1], x[2] - self.height]
    }

    /// Unit normal.
    pub fn normal(&self) -> [f64; 3] {
        let [a, b] = self.slope;
        let length = (1.0 + a * a + b * b).sqrt();
        [-a / length, -b / length, 1.0 / length]
    }

    /// Distance of x along the normal.
    pub fn gap(&self, x: [f64; 3]) -> f64 {
        let ([a, b, c], n) = (self.offset(x), self.normal());
        a * n[0] + b * n[1] + c * n[2]
    }

    /// How far x is from being above this foot: the foot of its shadow on the tangent plane, from here.
    fn step(&self, x: [f64; 3]) -> [f64; 2] {
        let ([a, b, c], [p, q]) = (self.offset(x), self.slope);
        // The metric [1 + p p, p q; p q, 1 + q q] against the offset's parts along the two tangents.
        let (s, t) = (a + p * c, b + q * c);
        let det = 1.0 + p * p + q * q;
        [((1.0 + q * q) * s - p * q * t) / det, ((1.0 + p * p) * t - p * q * s) / det]
    }
}

/// Rounds that a node near the surface needs a handful of, and a far one may use up.
const MOST: usize = 40;
const HALVINGS: usize = 30;

/// The foot of x, by steps to the shadow of x on the tangent plane. Each leaves the distance times the curvature of the error before:
/// what a step of a run leaves of a node is round-off after a few. A step that does not come nearer is halved, so that a point far away
/// ends at a near point of the surface too.
pub fn nearest(surface: &impl Smooth, x: [f64; 3]) -> Foot {
    let mut foot = Foot::at(surface, [x[0], x[1]]);
    let mut distance = foot.square_distance(x);
    for _ in 0..MOST {
        let mut step = foot.step(x);
        let length = step[0].hypot(step[1]);
        // An error e along the surface is one of e^2 over the radius of curvature in the gap.
        let rounding = 4.0 * f64::EPSILON * (x[0].abs() + x[1].abs() + x[2].abs());
        // Not "at most": where the height is not a number nothing is to be found.
        if length.partial_cmp(&rounding) != Some(Ordering::Greater) {
            break;
        }
        let most = distance * (1.0 + 1e-12) + rounding * rounding;
        let mut next = Foot::at(surface, [foot.place[0] + step[0], foot.place[1] + step[1]]);
        let mut reached = next.square_distance(x);
        let mut halvings = 0;
        while reached > most && halvings < HALVINGS {
            step = step.map(|s| 0.5 * s);
            next = Foot::at(surface, [foot.place[0] + step[0], foot.place[1] + step[1]]);
            reached = next.square_distance(x);
            halvings += 1;
        }
        (foot, distance) = (next, reached);
        if halvings == HALVINGS {
            break;
        }
    }
    foot
}

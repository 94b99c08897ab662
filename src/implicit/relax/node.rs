//! A node's own equations with its contact law.

use crate::implicit::contact::{Status, Surface, frame};
use crate::implicit::matrix::{Block, product, times, transposed};
use crate::physics::tensor::{Vec3, add, sub};

/// K d = b + f with the contact law between d and f.
pub struct NodeProblem<'a> {
    pub stiffness: &'a Block,
    pub inverse: &'a Block,
    pub b: Vec3<f64>,
    /// Its index among the surface nodes.
    pub surface_index: usize,
    /// Position before the correction, and at the start of the increment.
    pub x: Vec3<f64>,
    pub start: Vec3<f64>,
}

impl NodeProblem<'_> {
    /// Displacement, contact force and state; `relaxed` is the displacement without contact.
    pub fn project(&self, surface: &Surface, relaxed: Vec3<f64>) -> (Vec3<f64>, Vec3<f64>, Status) {
        let free = (relaxed, [0.0; 3], Status::Free);
        let unloaded = times(self.inverse, self.b);
        // The relaxed displacement decides; where over-relaxation alone penetrates, the node only just touches.
        if surface.road.gap(add(self.x, relaxed)) >= 0.0 {
            return free;
        }
        let node = surface.local(self.surface_index, self.start, self.x, [0.0; 3], 1.0);
        let to_space = transposed(&node.frame);
        let stuck = times(&to_space, [-node.gap, -node.slip[0], -node.slip[1]]);
        if surface.friction.is_some() {
            let f = sub(times(self.stiffness, stuck), self.b);
            let [n, t1, t2] = times(&node.frame, f);
            let mu = surface.mu(self.surface_index, n, 0.0);
            if n > 0.0 && t1.hypot(t2) <= mu * n {
                return (stuck, f, Status::Stick);
            }
        }
        self.slide(surface, stuck).unwrap_or_else(|| {
            // Its normal force would pull: released, as far as over-relaxation does not penetrate.
            let d = if surface.road.gap(add(self.x, unloaded)) >= 0.0 { unloaded } else { relaxed };
            (d, [0.0; 3], Status::Free)
        })
    }

    /// On the surface with T = -mu N s/|s|: a fixed point for the direction of the slip.
    fn slide(&self, surface: &Surface, stuck: Vec3<f64>) -> Option<(Vec3<f64>, Vec3<f64>, Status)> {
        const ROUNDS: usize = 200;
        let q = frame(surface.road.normal(self.x));
        let local = product(&product(&q, self.stiffness), &transposed(&q));
        // Unknown: slip beyond the stuck position (s1, s2) and N, with the forces' balance
        // local (0, s) = b' + (N, -mu N u), b' = Q (b - K stuck).
        let b = times(&q, sub(self.b, times(self.stiffness, stuck)));
        let (a, c, d) = (local[1][1], 0.5 * (local[1][2] + local[2][1]), local[2][2]);
        let mut u = [b[1], b[2]];
        let mut s = [0.0_f64; 2];
        let mut normal = 0.0;
        for round in 0..ROUNDS {
            let l = u[0].hypot(u[1]);
            u = if l > 0.0 { u.map(|c| c / l) } else { [0.0; 2] };
            // (A + mu u k^T) s = b_t + mu u b_n, with N = k . s - b_n
            let k = [local[0][1], local[0][2]];
            let mu = surface.mu(self.surface_index, normal, s[0].hypot(s[1]) / surface.dt);
            let m =
                [[a + mu * u[0] * k[0], c + mu * u[0] * k[1]], [c + mu * u[1] * k[0], d + mu * u[1] * k[1]]];
            let rhs = [b[1] + mu * u[0] * b[0], b[2] + mu * u[1] * b[0]];
            let det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
            let new =
                [(rhs[0] * m[1][1] - rhs[1] * m[0][1]) / det, (m[0][0] * rhs[1] - m[1][0] * rhs[0]) / det];
            let change = (new[0] - s[0]).hypot(new[1] - s[1]);
            s = new;
            normal = k[0] * s[0] + k[1] * s[1] - b[0];
            if mu == 0.0 || (round > 0 && change <= 1e-12 * s[0].hypot(s[1])) {
                break;
            }
            // Back to the cone along -T + c s: the slip's own direction would swing where the slip is small.
            u = [0, 1].map(|i| mu * normal.max(0.0) * u[i] + 0.5 * (a + d) * s[i]);
        }
        if normal.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
            return None;
        }
        let d = add(stuck, times(&transposed(&q), [0.0, s[0], s[1]]));
        let f = sub(times(self.stiffness, d), self.b);
        Some((d, f, Status::Slip))
    }
}

//! Lines, arcs and corners that a profile is made of.

type Vec2 = [f64; 2];

fn sub(a: Vec2, b: Vec2) -> Vec2 {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: Vec2, b: Vec2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: Vec2, b: Vec2) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn unit(a: Vec2) -> Vec2 {
    let length = a[0].hypot(a[1]);
    [a[0] / length, a[1] / length]
}

/// A part of a profile, with the ground to its right as it is walked along +u.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Piece {
    /// Points at + s along, `from` <= s <= `to` [m].
    Line { at: Vec2, normal: Vec2, from: f64, to: f64 },
    /// Where two lines meet: outside of a convex one (`side` 1) and inside a concave one (-1) it is the nearest point. `normal`: of a
    /// node that lies on it.
    Corner { at: Vec2, normal: Vec2, side: f64 },
    /// A convex arc, from one normal to another.
    Arc { centre: Vec2, from: Vec2, to: Vec2, radius: f64 },
}

/// Distance along the normal, negative inside, and the normal.
pub type Seen = (f64, Vec2);

/// Distance below which a node lies on a corner, and has no direction from it [m].
const ON: f64 = 1e-15;
/// How far a profile goes on beyond its ends [m].
const FAR: f64 = 1e9;

impl Piece {
    /// How x sees the piece, if the piece has a point that is nearest.
    pub fn seen(&self, x: Vec2) -> Option<Seen> {
        match *self {
            Piece::Line { at, normal, from, to } => {
                let d = sub(x, at);
                let s = dot(d, [normal[1], -normal[0]]);
                // Below a corner that hardly bends rounding may put a node beyond the ends of both sides.
                let rounding = 4.0 * f64::EPSILON * (x[0].abs() + x[1].abs());
                (from - rounding <= s && s <= to + rounding).then(|| (dot(d, normal), normal))
            }
            Piece::Corner { at, normal, side } => {
                let d = sub(x, at);
                let distance = d[0].hypot(d[1]);
                let towards = if distance > ON { d.map(|c| side * c / distance) } else { normal };
                Some((side * distance, towards))
            }
            Piece::Arc { centre, from, to, radius } => {
                let d = sub(x, centre);
                // Clockwise from one to the other.
                (cross(from, d) <= 0.0 && cross(d, to) <= 0.0).then(|| {
                    let distance = d[0].hypot(d[1]);
                    (distance - radius, d.map(|c| c / distance))
                })
            }
        }
    }

    /// u where it begins and ends.
    pub fn reach(&self) -> [f64; 2] {
        match *self {
            Piece::Line { at, normal, from, to } => [from, to].map(|s| at[0] + s * normal[1]),
            Piece::Corner { at, .. } => [at[0]; 2],
            Piece::Arc { centre, from, to, radius } => [from, to].map(|n| centre[0] + radius * n[0]),
        }
    }

    /// Height at u, if it is there once.
    pub fn height(&self, u: f64) -> Option<f64> {
        let [low, high] = self.reach();
        if u < low || u > high || low == high {
            return None;
        }
        match *self {
            Piece::Line { at, normal, .. } => Some(at[1] - (u - at[0]) * normal[0] / normal[1]),
            Piece::Corner { .. } => None,
            Piece::Arc { centre, radius, .. } => {
                Some(centre[1] + (radius * radius - (u - centre[0]).powi(2)).max(0.0).sqrt())
            }
        }
    }

    /// As two vectors of the shaders: the last number says what it is.
    pub fn numbers(&self) -> [f64; 8] {
        match *self {
            Piece::Line { at, normal, from, to } => [at[0], at[1], normal[0], normal[1], from, to, 0.0, 0.0],
            Piece::Corner { at, normal, side } => [at[0], at[1], normal[0], normal[1], side, 0.0, 0.0, 1.0],
            Piece::Arc { centre, from, to, radius } => {
                [centre[0], centre[1], from[0], from[1], to[0], to[1], radius, 2.0]
            }
        }
    }
}

/// The pieces of a walk through `vertices`, convex corners rounded with `radius`, level beyond its ends.
///
/// # Errors
/// A radius that does not fit: the number of the corner, and what would.
pub fn through(vertices: &[Vec2], radius: f64) -> Result<Vec<Piece>, (usize, f64)> {
    let (first, last) = (vertices[0], vertices[vertices.len() - 1]);
    let mut path = vec![[first[0] - FAR, first[1]]];
    path.extend(vertices);
    path.push([last[0] + FAR, last[1]]);
    // How much of a side a corner's arc takes: R tan(a/2), a being the angle that the walk turns by.
    let way = |k: usize| unit(sub(path[k + 1], path[k]));
    let turn = |k: usize| {
        let (before, after) = (way(k - 1), way(k));
        cross(before, after).atan2(dot(before, after))
    };
    let corners = 1..path.len() - 1;
    let mut taken = vec![0.0; path.len()];
    for k in corners.clone().filter(|&k| turn(k) < 0.0) {
        taken[k] = radius * (-0.5 * turn(k)).tan();
    }
    let length = |k: usize| {
        let d = sub(path[k + 1], path[k]);
        d[0].hypot(d[1])
    };
    for k in 0..path.len() - 1 {
        let fits = length(k) / (taken[k] + taken[k + 1]);
        if fits < 1.0 {
            return Err((k, radius * fits));
        }
    }
    let mut pieces = Vec::new();
    for k in 0..path.len() - 1 {
        let ([u, w], [along, up]) = (path[k.max(1)], way(k));
        let normal = [-up, along];
        // Lines are told from their inner ends: those that never end have another end far away.
        let [from, to] = if k == 0 { [-FAR, -taken[1]] } else { [taken[k], length(k) - taken[k + 1]] };
        if from < to {
            pieces.push(Piece::Line { at: [u, w], normal, from, to });
        }
        if k + 2 < path.len() && turn(k + 1) != 0.0 {
            pieces.push(corner(path[k + 1], way(k), way(k + 1), taken[k + 1], radius));
        }
    }
    Ok(pieces)
}

/// A corner between two directions, rounded where the arc takes something of the sides.
fn corner(at: Vec2, before: Vec2, after: Vec2, taken: f64, radius: f64) -> Piece {
    let [from, to] = [before, after].map(|[along, up]| [-up, along]);
    if taken > 0.0 {
        let centre = [0, 1].map(|d| at[d] - taken * before[d] - radius * from[d]);
        return Piece::Arc { centre, from, to, radius };
    }
    let side = if cross(before, after) < 0.0 { 1.0 } else { -1.0 };
    Piece::Corner { at, normal: unit([from[0] + to[0], from[1] + to[1]]), side }
}

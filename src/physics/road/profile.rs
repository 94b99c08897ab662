use std::sync::Arc;

use super::base::Base;
use super::pieces::{self, Piece, Seen};
use super::{Surface, Texture};
use crate::scalar::{Real, Scalar};
use crate::tensor::{Vec3, vec3};

/// A profile of straight lines and arcs over a plane, extruded across: a cleat, a step, points.
///
/// The gap is the distance of the nearest point, exactly: above a convex corner that is the corner, and below a concave one too, where
/// both of its sides push.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    pub base: Base,
    pub shape: Arc<Shape>,
}

/// What a profile is, whatever base it stands on.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// In the order of u.
    pieces: Vec<Piece>,
    /// For equal shares of `range`: the first and one past the last piece that can be nearest.
    shares: Vec<[u32; 2]>,
    /// u of what the shares cover [m].
    range: [f64; 2],
    /// Length after which it comes again [m]; infinite: never.
    period: f64,
    /// Highest point, and how far the lowest is below it [m].
    top: f64,
    relief: f64,
    texture: Texture,
}

/// Pieces up to which all are looked at.
const FEW: usize = 12;
const MOST_SHARES: usize = 1 << 14;

impl Shape {
    /// The walk through `vertices` (u, height), u never falling, with convex corners rounded; `period`: length after which it comes
    /// again, not shorter than the walk and at the same height [m].
    ///
    /// # Errors
    /// A radius that does not fit, and the largest that would.
    pub fn new(vertices: &[[f64; 2]], radius: f64, period: Option<f64>) -> Result<Shape, f64> {
        let [start, end] = [vertices[0][0], vertices[vertices.len() - 1][0]];
        let walk = match period {
            None => vertices.to_vec(),
            Some(period) => {
                // A closing point that is the next one's first.
                let closes = end - start >= period && vertices.len() > 1;
                let one = &vertices[..vertices.len() - usize::from(closes)];
                let copy = |k: f64| one.iter().map(move |&[u, w]| [u + k * period, w]);
                [-1.0, 0.0, 1.0]
                    .into_iter()
                    .flat_map(copy)
                    .chain([[start + 2.0 * period, vertices[0][1]]])
                    .collect()
            }
        };
        let pieces = pieces::through(&walk, radius).map_err(|(_, fits)| fits)?;
        let [low, high] =
            [f64::min, f64::max].map(|pick| walk.iter().map(|p| p[1]).reduce(pick).unwrap_or(0.0));
        let range = period.map_or([start, end], |period| [start, start + period]);
        let mut shape = Shape {
            shares: Vec::new(),
            range,
            period: period.unwrap_or(f64::INFINITY),
            top: high,
            relief: high - low,
            texture: texture(vertices, radius),
            pieces,
        };
        shape.share_out();
        Ok(shape)
    }

    /// Gives every share of the range the pieces that a point above it can be nearest to: no farther than the ground below it.
    fn share_out(&mut self) {
        let count = if self.pieces.len() <= FEW { 1 } else { (2 * self.pieces.len()).min(MOST_SHARES) };
        let width = (self.range[1] - self.range[0]) / count as f64;
        // Seen from as far above the top as the lowest point is below it.
        let reach = (2.0 * self.relief).max(width);
        let reaches: Vec<[f64; 2]> = self.pieces.iter().map(Piece::reach).collect();
        let of = |k: usize| {
            let low = if k == 0 { f64::NEG_INFINITY } else { self.range[0] + k as f64 * width - reach };
            let high =
                if k + 1 == count { f64::INFINITY } else { self.range[0] + (k + 1) as f64 * width + reach };
            let first = reaches.partition_point(|r| r[1] < low);
            let end = reaches.partition_point(|r| r[0] <= high);
            [first as u32, end as u32]
        };
        self.shares = (0..count).map(of).collect();
    }

    /// u within the first period.
    fn wrapped(&self, u: f64) -> f64 {
        match self.period.is_finite() {
            true => u - self.period * ((u - self.range[0]) / self.period).floor(),
            false => u,
        }
    }

    fn near(&self, u: f64) -> &[Piece] {
        let share = (u - self.range[0]) / (self.range[1] - self.range[0]) * self.shares.len() as f64;
        let share = (share.max(0.0) as usize).min(self.shares.len() - 1);
        let [first, end] = self.shares[share];
        &self.pieces[first as usize..end as usize]
    }

    /// The nearest point of (u, height).
    fn nearest(&self, u: f64, w: f64) -> Seen {
        let u = self.wrapped(u);
        let seen = self.near(u).iter().filter_map(|piece| piece.seen([u, w]));
        seen.min_by(|a, b| a.0.abs().total_cmp(&b.0.abs())).unwrap_or((w - self.top, [0.0, 1.0]))
    }

    /// Height at u [m]; at a wall that of its top.
    pub fn height(&self, u: f64) -> f64 {
        let u = self.wrapped(u);
        self.near(u).iter().filter_map(|piece| piece.height(u)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Nothing of it is higher [m].
    pub fn top(&self) -> f64 {
        self.top
    }

    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }
}

/// The shortest side, the steepest, and the radius of the corners.
fn texture(vertices: &[[f64; 2]], radius: f64) -> Texture {
    let sides = || vertices.windows(2).map(|p| [p[1][0] - p[0][0], p[1][1] - p[0][1]]);
    Texture {
        shortest: sides().map(|[u, w]| u.hypot(w)).fold(f64::INFINITY, f64::min),
        steepest: sides().map(|[u, w]| (w / u).abs()).fold(0.0, f64::max),
        sharpest: radius,
    }
}

impl Profile {
    fn seen(&self, x: [f64; 3]) -> Seen {
        let [u, _, w] = self.base.local(x);
        self.shape.nearest(u, w)
    }
}

impl Surface for Profile {
    const NAME: &'static str = "profile";

    #[inline(always)]
    fn bound<S: Scalar>(&self, x: Vec3<S>) -> S {
        self.base.lifted(self.shape.top).bound(x)
    }

    fn gap<S: Real>(&self, x: Vec3<S>) -> S {
        let x = x.map(S::to_f64);
        let above = self.bound(x);
        S::from_f64(if above > self.shape.relief { above } else { self.seen(x).0 })
    }

    fn normal<S: Real>(&self, x: Vec3<S>) -> Vec3<S> {
        let x = x.map(S::to_f64);
        if self.bound(x) > self.shape.relief {
            return vec3(self.base.normal);
        }
        let [along, up] = self.seen(x).1;
        vec3(self.base.vector([along, 0.0, up]))
    }

    fn velocity<S: Real>(&self, _x: Vec3<S>) -> Vec3<S> {
        vec3([0.0; 3])
    }

    fn moves(&self) -> bool {
        false
    }

    fn seen_from(&self, origin: [f64; 3]) -> Self {
        Profile { base: self.base.seen_from(origin), shape: self.shape.clone() }
    }

    fn invariant(&self) -> [bool; 3] {
        self.base.invariant_across()
    }

    fn acts_along(&self, direction: usize) -> Option<&'static str> {
        (!self.invariant()[direction]).then_some("the road's normal points")
    }

    fn height(&self, x: [f64; 3]) -> f64 {
        self.base.local(x)[2]
    }

    fn chart(&self, x: [f64; 3]) -> [f64; 2] {
        let [u, v, _] = self.base.local(x);
        [u, v]
    }

    fn point(&self, [u, v]: [f64; 2]) -> [f64; 3] {
        self.base.place([u, v, self.shape.height(u)])
    }

    fn tangents(&self, x: [f64; 3]) -> [[f64; 3]; 2] {
        self.base.tangents(self.normal(x))
    }

    fn straight(&self) -> [f64; 2] {
        [self.shape.texture.shortest / 20.0, f64::INFINITY]
    }

    fn texture(&self) -> Option<Texture> {
        Some(self.shape.texture)
    }

    fn constants(&self) -> Vec<(&'static str, f64)> {
        let Shape { pieces, range, period, top, relief, shares, .. } = &*self.shape;
        let mut all = self.base.constants();
        all.push(("road_top", *top));
        all.push(("road_relief", *relief));
        all.push(("road_start", range[0]));
        // Zero: it does not come again.
        all.push(("road_period", if period.is_finite() { *period } else { 0.0 }));
        all.push(("road_pieces", pieces.len() as f64));
        all.push(("road_shares", shares.len() as f64));
        let length = range[1] - range[0];
        all.push(("road_per_length", if length > 0.0 { shares.len() as f64 / length } else { 0.0 }));
        all
    }

    /// Two vectors for each piece, then one for each share.
    fn array(&self) -> Vec<f64> {
        let pieces = self.shape.pieces.iter().flat_map(Piece::numbers);
        let shares =
            self.shape.shares.iter().flat_map(|[first, end]| [f64::from(*first), f64::from(*end), 0.0, 0.0]);
        pieces.chain(shares).collect()
    }

    fn description(&self) -> String {
        let Shape { pieces, period, range, top, .. } = &*self.shape;
        let again = match period.is_finite() {
            true => format!("again after {period} m"),
            false => format!("level beyond {range:?} m"),
        };
        let base = self.base.description();
        format!(
            "rigid profile of {} lines, arcs and corners, up to {top} m, {again}, {base}, at rest",
            pieces.len()
        )
    }
}

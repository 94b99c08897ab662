use std::sync::Arc;

use super::base::Base;
use super::nearest::{Foot, Smooth, nearest};
use super::samples::Samples;
use super::{Surface, Texture};
use crate::scalar::{Real, Scalar};
use crate::tensor::{Vec3, vec3};

/// Heights over a plane, sampled on a grid and bicubic between the samples.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightField {
    /// The first sample is at its point.
    pub base: Base,
    pub samples: Arc<Samples>,
}

impl HeightField {
    fn foot(&self, x: [f64; 3]) -> (Foot, [f64; 3]) {
        let local = self.base.local(x);
        (nearest(&*self.samples, local), local)
    }
}

impl Surface for HeightField {
    const NAME: &'static str = "height-field";

    #[inline(always)]
    fn bound<S: Scalar>(&self, x: Vec3<S>) -> S {
        self.base.lifted(self.samples.top()).bound(x)
    }

    fn gap<S: Real>(&self, x: Vec3<S>) -> S {
        let x = x.map(S::to_f64);
        let above = self.bound(x);
        if above > self.samples.relief() {
            return S::from_f64(above);
        }
        let (foot, local) = self.foot(x);
        S::from_f64(foot.gap(local))
    }

    fn normal<S: Real>(&self, x: Vec3<S>) -> Vec3<S> {
        let x = x.map(S::to_f64);
        if self.bound(x) > self.samples.relief() {
            return vec3(self.base.normal);
        }
        vec3(self.base.vector(self.foot(x).0.normal()))
    }

    fn velocity<S: Real>(&self, _x: Vec3<S>) -> Vec3<S> {
        vec3([0.0; 3])
    }

    fn moves(&self) -> bool {
        false
    }

    fn seen_from(&self, origin: [f64; 3]) -> Self {
        HeightField { base: self.base.seen_from(origin), samples: self.samples.clone() }
    }

    fn invariant(&self) -> [bool; 3] {
        [false; 3]
    }

    fn acts_along(&self, _direction: usize) -> Option<&'static str> {
        Some("the road's normal points")
    }

    fn height(&self, x: [f64; 3]) -> f64 {
        self.base.local(x)[2]
    }

    fn chart(&self, x: [f64; 3]) -> [f64; 2] {
        let [u, v, _] = self.base.local(x);
        [u, v]
    }

    fn point(&self, [u, v]: [f64; 2]) -> [f64; 3] {
        // A picture shows a hole as level ground.
        let height = Smooth::height(&*self.samples, u, v)[0];
        self.base.place([u, v, if height.is_nan() { 0.0 } else { height }])
    }

    fn tangents(&self, x: [f64; 3]) -> [[f64; 3]; 2] {
        self.base.tangents(self.normal(x))
    }

    fn straight(&self) -> [f64; 2] {
        self.samples.spacing()
    }

    fn texture(&self) -> Option<Texture> {
        Some(self.samples.texture())
    }

    fn constants(&self) -> Vec<(&'static str, f64)> {
        let mut all = self.base.constants();
        let ([columns, rows], spacing) = (self.samples.size(), self.samples.spacing());
        all.extend([
            ("road_top", self.samples.top()),
            ("road_relief", self.samples.relief()),
            ("road_columns", columns as f64),
            ("road_rows", rows as f64),
            ("road_columns_per_length", 1.0 / spacing[0]),
            ("road_rows_per_length", 1.0 / spacing[1]),
            ("road_again", f64::from(u8::from(self.samples.comes_again()))),
        ]);
        all
    }

    /// The heights, and what fills the last vector.
    fn array(&self) -> Vec<f64> {
        let mut heights = self.samples.without_holes();
        heights.resize(heights.len().next_multiple_of(4), 0.0);
        heights
    }

    fn description(&self) -> String {
        let (samples, base) = (self.samples.description(), self.base.description());
        format!("rigid height field of {samples}, {base}, at rest")
    }
}

use super::base::Base;
use super::nearest::{Foot, Smooth, nearest};
use super::{Surface, Texture};
use crate::scalar::{Real, Scalar};
use crate::tensor::{Vec3, vec3};

/// A cosine over a plane, extruded across: height = amplitude cos(2 pi u / wavelength), a crest at the base's point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave {
    pub base: Base,
    /// Half of what crests and troughs are apart [m].
    pub amplitude: f64,
    /// [m]
    pub wavelength: f64,
}

impl Smooth for Wave {
    fn height(&self, u: f64, _v: f64) -> [f64; 3] {
        // Whole waves are taken off first: a far place has the digits of a near one.
        let waves = u / self.wavelength;
        let k = std::f64::consts::TAU / self.wavelength;
        let (sin, cos) = (std::f64::consts::TAU * (waves - waves.round())).sin_cos();
        [self.amplitude * cos, -self.amplitude * k * sin, 0.0]
    }
}

impl Wave {
    fn foot(&self, x: [f64; 3]) -> (Foot, [f64; 3]) {
        let local = self.base.local(x);
        (nearest(self, local), local)
    }

    fn wave_number(&self) -> f64 {
        std::f64::consts::TAU / self.wavelength
    }
}

impl Surface for Wave {
    const NAME: &'static str = "wave";

    #[inline(always)]
    fn bound<S: Scalar>(&self, x: Vec3<S>) -> S {
        self.base.lifted(self.amplitude).bound(x)
    }

    fn gap<S: Real>(&self, x: Vec3<S>) -> S {
        let x = x.map(S::to_f64);
        let above = self.bound(x);
        if above > 2.0 * self.amplitude {
            return S::from_f64(above);
        }
        let (foot, local) = self.foot(x);
        S::from_f64(foot.gap(local))
    }

    fn normal<S: Real>(&self, x: Vec3<S>) -> Vec3<S> {
        let x = x.map(S::to_f64);
        if self.bound(x) > 2.0 * self.amplitude {
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
        Wave { base: self.base.seen_from(origin), ..*self }
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
        self.base.place([u, v, Smooth::height(self, u, v)[0]])
    }

    fn tangents(&self, x: [f64; 3]) -> [[f64; 3]; 2] {
        self.base.tangents(self.normal(x))
    }

    fn straight(&self) -> [f64; 2] {
        [self.wavelength / 24.0, f64::INFINITY]
    }

    fn texture(&self) -> Option<Texture> {
        let k = self.wave_number();
        Some(Texture {
            shortest: self.wavelength,
            steepest: self.amplitude.abs() * k,
            sharpest: 1.0 / (self.amplitude.abs() * k * k),
        })
    }

    fn constants(&self) -> Vec<(&'static str, f64)> {
        let mut all = self.base.constants();
        all.extend([("road_amplitude", self.amplitude), ("road_wavelength", self.wavelength)]);
        all
    }

    fn description(&self) -> String {
        let Wave { base, amplitude, wavelength } = self;
        format!("rigid cosine of {amplitude} m, a wave in {wavelength} m, {}, at rest", base.description())
    }
}

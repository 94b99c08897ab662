//! Engines that can be timed: one in a precision.

use hexroll::engine::Engine;
use hexroll::gpu::{Gpu, GpuEngine};
use hexroll::model::Model;
use hexroll::scene::Scene;
use hexroll::{Error, Precision, Result, cpu};
use serde::{Deserialize, Serialize};

/// Engines that can be timed.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, clap::ValueEnum, Serialize, Deserialize,
)]
pub enum Kind {
    #[serde(rename = "cpu-f64")]
    CpuF64,
    #[serde(rename = "cpu-f32")]
    CpuF32,
    #[serde(rename = "gpu-f32")]
    GpuF32,
    #[value(name = "gpu-f32+")]
    #[serde(rename = "gpu-f32+")]
    GpuF32Plus,
    #[serde(rename = "gpu-f64")]
    GpuF64,
}

impl Kind {
    pub const ALL: [Kind; 5] = [Kind::CpuF64, Kind::CpuF32, Kind::GpuF32, Kind::GpuF32Plus, Kind::GpuF64];

    pub fn name(self) -> &'static str {
        match self {
            Kind::CpuF64 => "cpu-f64",
            Kind::CpuF32 => "cpu-f32",
            Kind::GpuF32 => "gpu-f32",
            Kind::GpuF32Plus => "gpu-f32+",
            Kind::GpuF64 => "gpu-f64",
        }
    }

    pub fn on_gpu(self) -> bool {
        match self {
            Kind::CpuF64 | Kind::CpuF32 => false,
            Kind::GpuF32 | Kind::GpuF32Plus | Kind::GpuF64 => true,
        }
    }

    /// What it computes in.
    pub fn precision(self) -> Precision {
        match self {
            Kind::CpuF64 | Kind::GpuF64 => Precision::F64,
            Kind::CpuF32 | Kind::GpuF32 => Precision::F32,
            Kind::GpuF32Plus => Precision::F32Plus,
        }
    }

    /// The engine at rest. `threads` as [`cpu::engine`] takes them; `gpu` is the adapter of those on one.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] where one is needed and none is open; as [`GpuEngine::new`].
    pub fn engine(
        self,
        model: &Model,
        scene: &Scene,
        threads: usize,
        gpu: Option<&Gpu>,
    ) -> Result<Box<dyn Engine>> {
        if !self.on_gpu() {
            return cpu::engine(model, scene, self.precision(), threads);
        }
        let gpu = gpu.ok_or_else(|| Error::NoAdapter { detail: "none is open".into() })?;
        Ok(Box::new(GpuEngine::new(gpu, model, scene, self.precision())?))
    }

    /// Largest error of a row after `steps` over which the wheel came to a mean `deformation` [m].
    ///
    /// f64 differs from the reference by rounding alone (lanes, order of sums), which the contact's switching
    /// amplifies over some thousand steps. In f32 every step rounds a position of up to 62 mm by 2e-9 m at most, at
    /// random: sqrt(steps) times twice that is allowed, which matters where the wheel is hardly deformed yet. Beside
    /// it 1e-3: stick and slip alternate in another order (seen: 3e-4); a shear modulus off by 1 % makes 6e-3.
    pub fn error_limit(self, steps: u64, deformation: f64) -> f64 {
        match self.precision() {
            Precision::F64 => 1e-8,
            Precision::F32Plus => 1e-3,
            Precision::F32 => 1e-3 + 4e-9 * (steps as f64).sqrt() / deformation,
        }
    }
}

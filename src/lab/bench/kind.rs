//! Engines that can be timed.

use hexroll::gpu;

/// Engines that can be timed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Kind {
    CpuF64,
    CpuF32,
    GpuF32,
    #[value(name = "gpu-f32+")]
    GpuF32Plus,
    GpuF64,
}

impl Kind {
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
        self.gpu_precision().is_some()
    }

    /// Of the GPU engine, if it is one.
    pub fn gpu_precision(self) -> Option<gpu::Precision> {
        match self {
            Kind::CpuF64 | Kind::CpuF32 => None,
            Kind::GpuF32 => Some(gpu::Precision::F32),
            Kind::GpuF32Plus => Some(gpu::Precision::F32Plus),
            Kind::GpuF64 => Some(gpu::Precision::F64),
        }
    }

    /// Whether it computes in double precision.
    pub fn is_double(self) -> bool {
        matches!(self, Kind::CpuF64 | Kind::GpuF64)
    }

    /// Largest error of a row after `steps` over which the wheel came to a mean `deformation` [m].
    ///
    /// f64 differs from the reference by rounding alone (lanes, order of sums), which the contact's switching
    /// amplifies over some thousand steps. In f32 every step rounds a position of up to 62 mm by 2e-9 m at most, at
    /// random: sqrt(steps) times twice that is allowed, which matters where the wheel is hardly deformed yet. Beside
    /// it 1e-3: stick and slip alternate in another order (seen: 3e-4); a shear modulus off by 1 % makes 6e-3.
    pub fn error_limit(self, steps: u64, deformation: f64) -> f64 {
        match self {
            Kind::CpuF64 | Kind::GpuF64 => 1e-8,
            Kind::GpuF32Plus => 1e-3,
            Kind::CpuF32 | Kind::GpuF32 => 1e-3 + 4e-9 * (steps as f64).sqrt() / deformation,
        }
    }
}

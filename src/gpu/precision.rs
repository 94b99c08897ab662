//! Arithmetic of the GPU engine.

use super::Gpu;
use super::layout::Real;
use crate::error::{Error, Result};

/// Precisions of the GPU engine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Precision {
    /// Single.
    F32,
    /// Single, with positions as unevaluated sums of two numbers.
    F32Plus,
    /// Double, on adapters that have it.
    F64,
}

impl Precision {
    pub const ALL: [Precision; 3] = [Precision::F32, Precision::F32Plus, Precision::F64];

    pub fn name(self) -> &'static str {
        match self {
            Precision::F32 => "f32",
            Precision::F32Plus => "f32+",
            Precision::F64 => "f64",
        }
    }

    /// What `real` is in the shaders.
    pub fn real(self) -> Real {
        match self {
            Precision::F32 | Precision::F32Plus => Real::Single,
            Precision::F64 => Real::Double,
        }
    }

    /// Whether positions are pairs.
    pub fn has_pairs(self) -> bool {
        self == Precision::F32Plus
    }

    /// # Errors
    /// [`Error::Unsupported`] where the adapter does not have it.
    pub fn check(self, gpu: &Gpu) -> Result<()> {
        if self.real() == Real::Double && !gpu.report.doubles {
            return Err(Error::Unsupported {
                what: format!(
                    "double precision on {}, whose shaders do not have it (SHADER_F64)",
                    gpu.report.name
                ),
                instead: "use --precision f32 or f32+ there, or --engine cpu".into(),
            });
        }
        Ok(())
    }
}

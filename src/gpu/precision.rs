//! Arithmetic of the GPU engine: what an adapter has, and what a precision is in the shaders.

use super::layout::Real;
use super::{AdapterReport, Gpu};
use crate::error::{Error, Result};
pub use crate::precision::Precision;

impl AdapterReport {
    /// Whether the GPU engine can compute in a precision on this adapter.
    pub fn has(&self, precision: Precision) -> bool {
        self.doubles || precision.is_single()
    }
}

impl Precision {
    /// What `real` is in the shaders.
    pub fn real(self) -> Real {
        if self.is_single() { Real::Single } else { Real::Double }
    }

    /// # Errors
    /// [`Error::Unsupported`] where the adapter does not have it.
    pub fn check(self, gpu: &Gpu) -> Result<()> {
        if !gpu.report.has(self) {
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

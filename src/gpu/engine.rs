use super::Gpu;
use crate::engine::*;
use crate::error::Result;
use crate::model::Model;
use crate::physics::rim::Coordinates;
use crate::scene::Scene;

/// The GPU engine.
pub struct GpuEngine {}

impl GpuEngine {
    /// An engine at rest in the reference shape. `plus`: positions as hi + lo pairs (`f32+`).
    /// Errors: the scene does not fit the adapter's limits.
    pub fn new(_gpu: &Gpu, _model: &Model, _scene: &Scene, _plus: bool) -> Result<Self> {
        todo!()
    }
}

impl Engine for GpuEngine {
    fn info(&self) -> EngineInfo {
        todo!()
    }
    fn begin_stage(&mut self, _: &StageSetup) -> Result<()> {
        todo!()
    }
    fn advance(&mut self, _: &[Step]) -> Result<()> {
        todo!()
    }
    fn sample(&mut self, _: &Step) -> Result<Window> {
        todo!()
    }
    fn state(&mut self) -> Result<State> {
        todo!()
    }
    fn set_velocity(&mut self, _: &[[f64; 3]], _: &Coordinates) -> Result<()> {
        todo!()
    }
    fn force(&mut self, _: &[[f64; 3]], _: &[[f64; 3]]) -> Result<Vec<[f64; 3]>> {
        todo!()
    }
}

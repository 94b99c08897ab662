//! What a run would hold on the CPU, and what there is.

use serde::Serialize;

use crate::choose;
use hexroll::memory::{self, Part};
use hexroll::scene::Scene;
use hexroll::{Precision, cpu};

/// Memory of runs on the CPU engine.
#[derive(Debug, Serialize)]
pub struct CpuMemory {
    pub runs: Vec<OfRun>,
    /// Memory that can be had now [bytes], and what limits it; none where the system does not say.
    pub there: Option<u64>,
    pub limit: Option<&'static str>,
}

/// What a run in one precision holds when it holds most.
#[derive(Debug, Serialize)]
pub struct OfRun {
    pub precision: Precision,
    pub bytes: u64,
    pub parts: Vec<Part>,
}

impl CpuMemory {
    pub fn of(scene: &Scene) -> CpuMemory {
        let there = memory::there();
        let run = |precision| {
            let need = choose::need(scene, Some(precision));
            OfRun { precision, bytes: need.bytes(), parts: need.parts }
        };
        CpuMemory {
            runs: cpu::PRECISIONS.map(run).into(),
            there: there.map(|t| t.bytes),
            limit: there.map(|t| t.limit),
        }
    }
}

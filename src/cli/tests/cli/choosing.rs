//! Which engines may run a scene, and which adapter is taken.

use hexroll::gpu::AdapterReport;
use hexroll::{Error, Precision};
use hexroll_cli::choose::{Candidates, EngineChoice, candidates, usable};

use EngineChoice::{Auto, Cpu, Gpu};
use Precision::{F32, F32Plus, F64};

#[test]
fn every_engine_gets_the_precision_that_it_has() {
    let both = |cpu, gpu| Candidates { cpu, gpu };
    for (engine, precision, expected) in [
        (Auto, None, both(Some(F64), Some(F32))),
        (Auto, Some(F64), both(Some(F64), Some(F64))),
        (Auto, Some(F32), both(Some(F32), Some(F32))),
        (Auto, Some(F32Plus), both(None, Some(F32Plus))),
        (Cpu, None, both(Some(F64), None)),
        (Cpu, Some(F32), both(Some(F32), None)),
        (Gpu, None, both(None, Some(F32))),
        (Gpu, Some(F32Plus), both(None, Some(F32Plus))),
        (Gpu, Some(F64), both(None, Some(F64))),
    ] {
        assert_eq!(candidates(engine, precision).unwrap(), expected, "{engine:?} {precision:?}");
    }
    let refused = candidates(Cpu, Some(F32Plus));
    assert!(matches!(refused, Err(Error::Unsupported { .. })), "{refused:?}");
}

fn adapter(name: &str, software: bool, unusable: Option<&str>) -> AdapterReport {
    AdapterReport {
        name: name.into(),
        backend: "vulkan".into(),
        driver: String::new(),
        software,
        storage_binding: 1 << 27,
        buffer: 1 << 28,
        storage_buffers: 16,
        workgroups: 65_535,
        shared_memory: 1 << 15,
        timestamps: false,
        doubles: false,
        unusable: unusable.map(Into::into),
    }
}

#[test]
fn the_first_adapter_that_can_be_used_is_taken() {
    let all = [
        adapter("Old Card", false, Some("it has no compute shaders")),
        adapter("New Card", false, None),
        adapter("llvmpipe", true, None),
    ];
    let taken = |name| usable(&all, name).map(|a| a.name.as_str());
    assert_eq!(taken(None), Some("New Card"));
    assert_eq!(taken(Some("LLVM")), Some("llvmpipe"));
    assert_eq!(taken(Some("old")), None, "naming it does not make it usable");
    assert_eq!(usable(&[], None), None);
}

//! The same bits: from run to run, and of a body alone and among others.

use super::rig::{Plan, VISCOUS, adapter, kinds, scene};
use crate::report::{Case, Claim};
use hexroll::engine::Engine;
use hexroll::gpu::{GpuEngine, advance_together, ensemble};
use hexroll::{Precision, Result};

pub const REPEAT: Case = Case {
    name: "parity_repeat",
    theorem: "five_runs_on_a_gpu_have_the_same_bits",
    title: "Five runs have the same bits",
    source: "forces are summed in a fixed order, with no atomics",
    setup: "the viscous wheel, 20 x 3 x 3 elements, thrown at the road, 300 steps, five times",
    everyday: true,
    run: repeat,
};

pub const ENSEMBLE: Case = Case {
    name: "parity_ensemble",
    theorem: "a_body_among_others_has_the_bits_it_has_alone",
    title: "A body among others has the bits it has alone",
    source: "bodies share buffers and dispatches, and nothing else",
    setup: "the viscous wheel of 880 elements, thrown at the road, 200 steps, eight at once and one alone, f32",
    everyday: true,
    run: together,
};

fn thrown(sets: &[&str], steps: usize) -> Result<Plan> {
    Plan::new(scene(VISCOUS, sets)?, steps, |x| [1.0, 0.2 * x[0], -1.0 + x[1]])
}

fn repeat() -> Result<Vec<Claim>> {
    let gpu = adapter()?;
    let plan = thrown(&["body.mesh.elements=[20, 3, 3]"], 300)?;
    let mut claims = Vec::new();
    for kind in kinds(&gpu) {
        let first = plan.on(kind, &gpu)?;
        let mut others = 0;
        for _ in 0..4 {
            others += u32::from(plan.on(kind, &gpu)? != first);
        }
        let what = format!("{}: runs of four that differ from the first", kind.name());
        claims.push(Claim::absolute(what, "", f64::from(others), 0.0, 0.0, "bits are the same or not"));
        let touching = first.1.surface.iter().filter(|s| s.touching > 0).count();
        let what = format!("{}: nodes that touched", kind.name());
        claims.push(Claim::at_least(what, "", touching as f64, 1.0, "contact is part of what is repeated"));
    }
    Ok(claims)
}

fn together() -> Result<Vec<Claim>> {
    const BODIES: usize = 8;
    let gpu = adapter()?;
    let plan = thrown(&[], 200)?;
    let mut alone = GpuEngine::new(&gpu, &plan.model, &plan.scene, Precision::F32)?;
    // As in an ensemble: in one work group's memory.
    alone.set_resident(true)?;
    let (expected, _) = plan.drive(&mut alone)?;
    let mut bodies = ensemble(&gpu, &[(&plan.model, &plan.scene); BODIES])?;
    bodies.iter_mut().try_for_each(|body| plan.start(body))?;
    advance_together(&mut bodies, &plan.steps)?;
    let mut others = 0;
    for body in &mut bodies {
        others += u32::from(body.state()? != expected);
    }
    let what = format!("bodies of {BODIES} whose state is not that of the one alone");
    Ok(vec![Claim::absolute(what, "", f64::from(others), 0.0, 0.0, "bits are the same or not")])
}

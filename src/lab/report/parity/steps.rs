//! A thousand steps: a block that spins and stretches, a wheel that is pressed on the road.

use super::rig::{BLOCK as SPINNING, PRESSED, Plan, adapter, kinds, scene};
use crate::bench::kind::Kind;
use crate::report::{Case, Claim};
use hexroll::{Precision, Result};

pub const BLOCK: Case = Case {
    name: "parity_block",
    theorem: "a_spinning_block_on_a_gpu_is_the_cpus",
    title: "A spinning, vibrating block, a thousand steps",
    source: "the CPU engine in f64, the same steps",
    setup: "the shipped scene spinning_block, 377 rad/s and strains of some per cent",
    everyday: true,
    run: block,
};

pub const WHEEL: Case = Case {
    name: "parity_wheel",
    theorem: "a_pressed_wheel_on_a_gpu_is_the_cpus",
    title: "The paper's wheel pressed on the road, a thousand steps",
    source: "the CPU engine in f64, the same steps",
    setup: "the shipped scene lat100_static_height: 880 elements, mu = 1, mass damping",
    everyday: true,
    run: wheel,
};

fn block() -> Result<Vec<Claim>> {
    let turning = |x: [f64; 3]| {
        let r = [x[0] - 0.05, x[1] - 0.02];
        [1.0 - 377.0 * r[1] + 60.0 * r[0], 377.0 * r[0] - 20.0 * r[1], 3.0 * (x[0] / 0.05).sin()]
    };
    let plan = Plan::new(scene(SPINNING, &[])?, 1000, turning)?;
    let reason = "displacements as large as the block, of which a step rounds 6e-8 at random; pairs round velocities alone";
    claims(
        &plan,
        |precision| match precision {
            Precision::F64 => 1e-11,
            Precision::F32 => 3e-6,
            Precision::F32Plus => 1.5e-6,
        },
        reason,
    )
}

fn wheel() -> Result<Vec<Claim>> {
    let plan = Plan::new(scene(PRESSED, &[])?, 1000, |_| [0.0; 3])?;
    let reason = "displacements of a millimetre, of which single precision resolves 2e-6, and nodes that land a step sooner or later";
    let mut claims = claims(
        &plan,
        |precision| match precision {
            Precision::F64 => 1e-12,
            Precision::F32 => 1e-4,
            Precision::F32Plus => 8e-6,
        },
        reason,
    )?;
    let gpu = adapter()?;
    for kind in kinds(&gpu) {
        let (state, _) = plan.on(kind, &gpu)?;
        let deepest = plan.model.mesh.surface.iter().map(|&n| -state.x[n as usize][2]).fold(0.0, f64::max);
        let what = format!("{}: deepest node below the road", kind.name());
        let reason = "a rounding of a coordinate of 78 mm; in f64 and in pairs far less";
        claims.push(Claim::at_most(what, "m", deepest, 1e-8, reason));
    }
    Ok(claims)
}

/// How far displacements and stored energy are from the CPU's.
fn claims(plan: &Plan, bound: impl Fn(Precision) -> f64, reason: &'static str) -> Result<Vec<Claim>> {
    let gpu = adapter()?;
    let (exact, energies) = plan.on(Kind::CpuF64, &gpu)?;
    let mut claims = Vec::new();
    for kind in kinds(&gpu) {
        let (state, window) = plan.on(kind, &gpu)?;
        let error = plan.displacement_error(&state, &exact);
        let what = format!("{}: displacement", kind.name());
        claims.push(Claim::at_most(what, "", error, bound(kind.precision()), reason));
        let energy = (window.strain / energies.strain - 1.0).abs();
        let tolerance = if kind.precision().is_single() { 1e-2 } else { 1e-10 };
        let why = "stored energy is quadratic in strains, of which f32 knows a unit of one";
        claims.push(Claim::at_most(format!("{}: stored energy", kind.name()), "", energy, tolerance, why));
    }
    Ok(claims)
}

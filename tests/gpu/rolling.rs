//! Whole scenes, each engine with its own critical step.

use crate::rig::{Who, engine, note, scene};
use hexroll::gpu::Gpu;
use hexroll::model::Model;
use hexroll::output::{ContactScatter, Verdict};
use hexroll::record::Sample;
use hexroll_lab::rig::{Recorder, simulate_on};

/// Means of (Fx, Fz, My) over the last 30 ms, and what the scatter of the contact force says.
fn means(gpu: &Gpu, who: Who, stem: &str) -> ([f64; 3], ContactScatter) {
    let scene = scene(stem, &[""; 0]);
    let model = Model::new(&scene).unwrap();
    let mut kept = Recorder::default();
    let begun = std::time::Instant::now();
    let mut engine = engine(gpu, who, &model, &scene);
    let totals = simulate_on(&scene, &model, &mut *engine, &mut kept).unwrap();
    let tail = &kept.samples[kept.samples.len() - 30..];
    let mean = |of: fn(&Sample) -> f64| tail.iter().map(of).sum::<f64>() / 30.0;
    let means = [mean(|s| s.road_fx_N), mean(|s| s.road_fz_N), mean(|s| s.rim_my_Nm)];
    note(|| {
        format!(
            "{stem} {who:?}: {means:?} in {} steps, {:?}, {} eigenvalue iterations, balance {:.1e} stored {:.1e} of {:.2e} J, gap {:.1e}",
            totals.steps,
            begun.elapsed(),
            totals.lanczos_iterations,
            totals.ledger.worst_balance,
            totals.ledger.worst_stored_balance,
            totals.ledger.largest_term,
            totals.ledger.worst_gap
        )
    });
    let noise = totals.noise.iter().rev().find_map(Option::as_ref).expect("the last stage rolls");
    let scatter =
        ContactScatter::of(noise, scene.road.as_ref().unwrap().normal([0.0; 3]), scene.output.chatter_limit)
            .unwrap();
    note(|| format!("{stem} {who:?}: {scatter:?}"));
    (means, scatter)
}

/// Means within `tolerance`, the same verdict of the contact force of every step, and its level within `scatter`.
fn compare(gpu: &Gpu, stem: &str, engines: &[Who], verdict: Verdict, tolerance: f64, scatter: f64) {
    let (exact, expected) = means(gpu, Who::Cpu64, stem);
    assert_eq!(expected.verdict, verdict, "{stem}: {expected:?}");
    for &who in engines {
        let (got, found) = means(gpu, who, stem);
        for k in 0..3 {
            let error = (got[k] / exact[k] - 1.0).abs();
            assert!(error < tolerance, "{stem} {who:?}: {got:?} instead of {exact:?}");
        }
        assert_eq!(found.verdict, verdict, "{stem} {who:?}: {found:?}");
        let shares = |s: &ContactScatter| [s.tone_share, s.remaining_share, s.changing_share];
        for (got, exact) in shares(&found).into_iter().zip(shares(&expected)) {
            assert!((got - exact).abs() < scatter, "{stem} {who:?}: {found:?} instead of {expected:?}");
        }
    }
}

/// Viscosity leaves the tone of a coarse mesh, 3.5 % of the load: below the limit.
pub fn viscous(gpu: &Gpu) {
    compare(gpu, "lat100_straight_viscous", &[Who::Gpu, Who::Plus], Verdict::Smooth, 0.003, 0.001);
}

/// Without it friction amplifies rounding, so that single steps differ.
pub fn elastic(gpu: &Gpu) {
    compare(gpu, "lat100_straight", &[Who::Gpu], Verdict::Tone, 0.01, 0.03);
}

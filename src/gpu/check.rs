//! What `f32+` needs of an adapter, tried on it.

use super::Gpu;
use super::bound::Bound;
use super::buffers::Buffers;
use super::compose::{Choice, Kernel};
use super::program::Program;
use super::readback::Readback;
use crate::error::Result;

/// Runs the shader's own compensated sum on numbers whose errors are known exactly.
///
/// # Errors
/// The adapter's results are not error-free: hi + lo positions would drift.
pub fn compensated_sums(gpu: &Gpu, choice: &Choice) -> Result<()> {
    let mut state = 1u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state as f32 / u32::MAX as f32
    };
    // A move is mostly smaller than the coordinate, but not near zero: every other pair is the other way round.
    let pairs: Vec<[[f32; 4]; 2]> = (0..64)
        .map(|k| {
            let large = [next(), next() - 0.5, 0.04 * next(), 0.0];
            let small = [1e-5 * next(), 1e-3 * next(), 1e-8 * next(), 0.0];
            if k % 2 == 0 { [large, small] } else { [small, large] }
        })
        .collect();
    let mut buffers = Buffers::default();
    buffers.filled(gpu, "pairs", pairs.as_flattened());
    buffers.zeroed(gpu, "results", size_of::<[f32; 4]>(), 128);
    let program = Program::new(gpu, choice, Kernel::CheckSums, &[])?;
    let bound = Bound::new(gpu, program, |name| buffers.get(name));
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    bound.dispatch(&mut encoder.begin_compute_pass(&Default::default()), [1, 1, 1], 0);
    let mut read = Readback::default();
    let part = read.add(buffers.get("results"));
    let data = read.copy(gpu, encoder)?;
    let results: &[[f32; 4]] = bytemuck::cast_slice(data.part(part));
    for (k, [a, b]) in pairs.iter().enumerate() {
        for d in 0..3 {
            let exact = f64::from(a[d]) + f64::from(b[d]);
            let got = f64::from(results[2 * k][d]) + f64::from(results[2 * k + 1][d]);
            // A pair holds 48 bits; the terms span at most 24 + 27 of them.
            if (got - exact).abs() > exact.abs() * 2.0f64.powi(-46) {
                let detail = format!(
                    "compensated sums are not exact here ({got:e} for {exact:e}): use --precision f32"
                );
                return Err(gpu.error(detail));
            }
        }
    }
    Ok(())
}

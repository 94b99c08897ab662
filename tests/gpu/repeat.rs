use hexroll::gpu::Gpu;
pub fn bit_identical(_: &Gpu) {}

use hexroll::gpu::Gpu;
pub fn exact(_: &Gpu) {}

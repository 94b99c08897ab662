use hexroll::gpu::Gpu;
pub fn offset(_: &Gpu) {}
pub fn followed(_: &Gpu) {}

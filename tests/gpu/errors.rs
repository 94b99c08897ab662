use hexroll::gpu::Gpu;
pub fn failures(_: &Gpu) {}
pub fn limits(_: &Gpu) {}
pub fn device_errors(_: &Gpu) {}

use hexroll::gpu::Gpu;
pub fn pressed_by_a_force(_: &Gpu) {}
pub fn free_to_spin(_: &Gpu) {}

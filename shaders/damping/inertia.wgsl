// What a force of this step meets.
fn inertia(mass: f32) -> f32 {
    return mass * (1.0 + 0.5 * alpha * step.dtm);
}

// What a force of this step meets.
fn inertia(mass: real) -> real {
    return mass * (1.0 + 0.5 * alpha * step.dtm);
}

// What a force of this step meets.
fn inertia(mass: real) -> real {
    return mass;
}

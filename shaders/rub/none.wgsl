// Frictionless.

fn rub(role: u32, x: vec3r, v: vec3r, n: vec3r, push: real, per_step: real, pressed: vec3r) -> Rubbed {
    return Rubbed(pressed, 1u);
}

// The road moves along its surface, and pushes square to it.
fn road_work(force: vec3r, x: vec3r) -> real {
    return 0.0;
}

// No mass damping.

// Velocity at n+1/2 without contact.
fn predict(mass: real, f_int: vec3r, v: vec3r) -> vec3r {
    return v + step.dtm * (gravity() - f_int / mass);
}

fn damping_work(mass: real, before: vec3r, after: vec3r, way: vec3r) -> real {
    return 0.0;
}

// What a force of this step meets.
fn inertia(mass: real) -> real {
    return mass;
}

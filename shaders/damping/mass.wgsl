// Mass damping on the mean velocity of the step; twin of src/physics/node.rs.

override alpha: real;

// Velocity at n+1/2 without contact.
fn predict(mass: real, f_int: vec3r, v: vec3r) -> vec3r {
    let h = 0.5 * alpha * step.dtm;
    return (v * (1.0 - h) + step.dtm * (gravity() - f_int / mass)) / (1.0 + h);
}

fn damping_force(mass: real, before: vec3r, after: vec3r) -> vec3r {
    return -0.5 * alpha * mass * (before + after);
}

fn damping_work(mass: real, before: vec3r, after: vec3r, way: vec3r) -> real {
    return dot(damping_force(mass, before, after), way);
}

// What a force of this step meets.
fn inertia(mass: real) -> real {
    return mass * (1.0 + 0.5 * alpha * step.dtm);
}

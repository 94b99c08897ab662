// Mass damping on the mean velocity of the step; twin of src/physics/node.rs.

override alpha: f32;

// Velocity at n+1/2 without contact.
fn predict(mass: f32, f_int: vec3f, v: vec3f) -> vec3f {
    let h = 0.5 * alpha * step.dtm;
    return (v * (1.0 - h) + step.dtm * (gravity() - f_int / mass)) / (1.0 + h);
}

fn damping_force(mass: f32, before: vec3f, after: vec3f) -> vec3f {
    return -0.5 * alpha * mass * (before + after);
}

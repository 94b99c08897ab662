// Velocity at n+1/2 without contact.
fn predict(mass: f32, f_int: vec3f, v: vec3f) -> vec3f {
    return v + step.dtm * (gravity() - f_int / mass);
}

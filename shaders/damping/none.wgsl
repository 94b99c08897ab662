// Velocity at n+1/2 without contact.
fn predict(mass: real, f_int: vec3r, v: vec3r) -> vec3r {
    return v + step.dtm * (gravity() - f_int / mass);
}

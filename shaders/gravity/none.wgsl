// No body force.

fn gravity() -> vec3r {
    return vec3r(0.0);
}

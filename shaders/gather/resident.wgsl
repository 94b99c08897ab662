// Internal forces added up in the work group's memory.

fn add_force(n: u32, f: vec3r) {
    held_forces[3u * n] += f.x;
    held_forces[3u * n + 1u] += f.y;
    held_forces[3u * n + 2u] += f.z;
}

// Internal force of a node; its sum begins anew.
fn gather(n: u32) -> vec3r {
    let f = vec3r(held_forces[3u * n], held_forces[3u * n + 1u], held_forces[3u * n + 2u]);
    held_forces[3u * n] = 0.0;
    held_forces[3u * n + 1u] = 0.0;
    held_forces[3u * n + 2u] = 0.0;
    return f;
}

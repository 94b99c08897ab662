// Velocities where the node pass of the same work group has left them.

// Velocities of a face's corners.
struct Rates { a: vec3f, b: vec3f, c: vec3f, d: vec3f }

fn load_rates(nodes: vec4u) -> Rates {
    return Rates(velocities[nodes.x].xyz, velocities[nodes.y].xyz, velocities[nodes.z].xyz, velocities[nodes.w].xyz);
}

fn rates_of(low: Rates, high: Rates) -> Corners {
    return Corners(low.a, low.b, low.c, low.d, high.a, high.b, high.c, high.d);
}

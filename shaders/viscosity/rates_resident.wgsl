// Velocities where the node pass of the same work group has left them.

// Velocities of a face's corners.
struct Rates { a: vec3r, b: vec3r, c: vec3r, d: vec3r }

fn load_rates(nodes: vec4u) -> Rates {
    return Rates(velocities[of_nodes(nodes.x)].xyz, velocities[of_nodes(nodes.y)].xyz, velocities[of_nodes(nodes.z)].xyz, velocities[of_nodes(nodes.w)].xyz);
}

fn rates_of(low: Rates, high: Rates) -> Corners {
    return Corners(low.a, low.b, low.c, low.d, high.a, high.b, high.c, high.d);
}

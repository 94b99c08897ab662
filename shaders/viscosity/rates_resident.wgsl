// Velocities where the node pass of the same work group has left them.

// Velocities of a face's corners.
struct Rates { a: vec3f, b: vec3f, c: vec3f, d: vec3f }

fn load_rates(at: u32) -> Rates {
    return Rates(
        velocities[chain_nodes[at]].xyz,
        velocities[chain_nodes[at + CORNER]].xyz,
        velocities[chain_nodes[at + 2u * CORNER]].xyz,
        velocities[chain_nodes[at + 3u * CORNER]].xyz);
}

fn rates_of(low: Rates, high: Rates) -> Corners {
    return Corners(low.a, low.b, low.c, low.d, high.a, high.b, high.c, high.d);
}

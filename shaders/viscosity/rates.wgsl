// Velocities where the element pass looks for them.

@group(0) @binding(11) var<storage, read> velocities_in: array<vec4r>;

// Velocities of a face's corners.
struct Rates { a: vec3r, b: vec3r, c: vec3r, d: vec3r }

fn load_rates(nodes: vec4u) -> Rates {
    return Rates(velocities_in[nodes.x].xyz, velocities_in[nodes.y].xyz, velocities_in[nodes.z].xyz, velocities_in[nodes.w].xyz);
}

fn rates_of(low: Rates, high: Rates) -> Corners {
    return Corners(low.a, low.b, low.c, low.d, high.a, high.b, high.c, high.d);
}

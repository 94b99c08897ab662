// Positions in the work group's memory.

// Corners of a face.
struct Face { a: vec3r, b: vec3r, c: vec3r, d: vec3r }

fn held_position(n: u32) -> vec3r {
    return vec3r(held_positions[3u * n], held_positions[3u * n + 1u], held_positions[3u * n + 2u]);
}

fn hold_position(n: u32, x: vec3r) {
    held_positions[3u * n] = x.x;
    held_positions[3u * n + 1u] = x.y;
    held_positions[3u * n + 2u] = x.z;
}

// Position, and mass from memory.
fn load_node(n: u32) -> vec4r {
    return vec4r(held_position(n), positions[of_nodes(n)].w);
}

fn store_position(n: u32, moved: Moved, rim: bool, mass: real) {
    hold_position(n, moved.x);
}

// A node comes from memory, without a force, and goes back.
fn enter(n: u32) {
    hold_position(n, positions[of_nodes(n)].xyz);
    held_forces[3u * n] = 0.0;
    held_forces[3u * n + 1u] = 0.0;
    held_forces[3u * n + 2u] = 0.0;
}

fn leave(n: u32) {
    positions[of_nodes(n)] = load_node(n);
}

fn load_face(nodes: vec4u) -> Face {
    return Face(held_position(nodes.x), held_position(nodes.y), held_position(nodes.z), held_position(nodes.w));
}

fn edges_of(low: Face, high: Face) -> Columns {
    return edges(Corners(low.a, low.b, low.c, low.d, high.a, high.b, high.c, high.d));
}

// Differences to corner 0.
fn offsets_of(low: Face, high: Face) -> Corners {
    return Corners(
        vec3r(0.0), low.b - low.a, low.c - low.a, low.d - low.a,
        high.a - low.a, high.b - low.a, high.c - low.a, high.d - low.a);
}

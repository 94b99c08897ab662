// Positions and forces of all nodes in the work group's memory, three numbers a node.

@group(0) @binding(10) var<storage, read_write> positions: array<vec4r>;
@group(0) @binding(11) var<storage, read_write> velocities: array<vec4r>;
@group(0) @binding(13) var<storage, read_write> done: array<u32>;

override words: u32;
var<workgroup> held_positions: array<real, words>;
var<workgroup> held_forces: array<real, words>;

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

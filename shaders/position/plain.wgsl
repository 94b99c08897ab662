// Positions in single precision, relative to a frame that follows the axle.

// Corners of a face.
struct Face { a: vec3r, b: vec3r, c: vec3r, d: vec3r }

fn load_face(nodes: vec4u) -> Face {
    return Face(
        positions[nodes.x].xyz, positions[nodes.y].xyz, positions[nodes.z].xyz, positions[nodes.w].xyz);
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

// Position, and mass.
fn load_node(n: u32) -> vec4r {
    return positions[n];
}

fn store_position(n: u32, moved: Moved, rim: bool, mass: real) {
    positions[n] = vec4r(moved.x, mass);
}

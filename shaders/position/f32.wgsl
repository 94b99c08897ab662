// Positions in single precision, relative to a frame that follows the axle.

@group(0) @binding(10) var<storage, read> positions_in: array<vec4f>;

fn load_positions(h: Hex) -> Corners {
    return Corners(
        positions_in[h.n0].xyz, positions_in[h.n1].xyz, positions_in[h.n2].xyz, positions_in[h.n3].xyz,
        positions_in[h.n4].xyz, positions_in[h.n5].xyz, positions_in[h.n6].xyz, positions_in[h.n7].xyz);
}

fn load_half_edges(h: Hex) -> Columns {
    return half_edges(load_positions(h));
}

// Differences to corner 0.
fn load_offsets(h: Hex) -> Corners {
    let x = load_positions(h);
    return Corners(
        vec3f(0.0), x.a1 - x.a0, x.a2 - x.a0, x.a3 - x.a0, x.a4 - x.a0, x.a5 - x.a0, x.a6 - x.a0, x.a7 - x.a0);
}

// The internal force of a node of any mesh; twin of src/cpu/nodes.rs.

// Internal force: the corners in fixed order, so that a rerun has the same bits.
fn gather(n: u32) -> vec3r {
    var f = vec3r(0.0);
    for (var i = corner_start[n]; i < corner_start[n + 1u]; i++) {
        f += slots[corners[i]].xyz;
    }
    return f;
}

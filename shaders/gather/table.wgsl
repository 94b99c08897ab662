// The internal force of a node of any mesh; twin of src/cpu/nodes.rs.

// Corner slots of a node: corners[corner_start[n]] .. corners[corner_start[n + 1]].
@group(0) @binding(0) var<storage, read> corner_start: array<u32>;
@group(0) @binding(1) var<storage, read> corners: array<u32>;
@group(0) @binding(2) var<storage, read> slots: array<vec4r>;

// Internal force: the corners in fixed order, so that a rerun has the same bits.
fn gather(n: u32) -> vec3r {
    var f = vec3r(0.0);
    for (var i = corner_start[n]; i < corner_start[n + 1u]; i++) {
        f += slots[corners[i]].xyz;
    }
    return f;
}

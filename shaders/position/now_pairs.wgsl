@group(0) @binding(10) var<storage, read> positions: array<vec4r>;
@group(0) @binding(12) var<storage, read> positions_lo: array<vec4r>;

// Position, and what stands beside it.
fn load_node(n: u32) -> vec4r {
    return positions[n] + vec4r(positions_lo[n].xyz, 0.0);
}

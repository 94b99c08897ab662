@group(0) @binding(10) var<storage, read> positions: array<vec4f>;
@group(0) @binding(12) var<storage, read> positions_lo: array<vec4f>;

// Position, and what stands beside it.
fn load_node(n: u32) -> vec4f {
    return positions[n] + vec4f(positions_lo[n].xyz, 0.0);
}

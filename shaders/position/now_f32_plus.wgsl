@group(0) @binding(10) var<storage, read> positions: array<vec4f>;
@group(0) @binding(12) var<storage, read> positions_lo: array<vec4f>;

fn load_position(n: u32) -> vec3f {
    return positions[n].xyz + positions_lo[n].xyz;
}

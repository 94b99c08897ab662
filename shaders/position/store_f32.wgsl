@group(0) @binding(10) var<storage, read_write> positions: array<vec4f>;
@group(0) @binding(11) var<storage, read_write> velocities: array<vec4f>;
@group(0) @binding(13) var<storage, read_write> done: array<u32>;

fn load_position(n: u32) -> vec3f {
    return positions[n].xyz;
}

fn store_position(n: u32, moved: Moved, rim: bool) {
    positions[n] = vec4f(moved.x, 0.0);
}

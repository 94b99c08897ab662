@group(0) @binding(10) var<storage, read_write> positions: array<vec4f>;
@group(0) @binding(11) var<storage, read_write> velocities: array<vec4f>;
@group(0) @binding(13) var<storage, read_write> done: array<u32>;

// Position, and mass.
fn load_node(n: u32) -> vec4f {
    return positions[n];
}

fn store_position(n: u32, moved: Moved, rim: bool, mass: f32) {
    positions[n] = vec4f(moved.x, mass);
}

@group(0) @binding(10) var<storage, read_write> positions: array<vec4r>;
@group(0) @binding(11) var<storage, read_write> velocities: array<vec4r>;
@group(0) @binding(13) var<storage, read_write> done: array<u32>;

// Position, and mass.
fn load_node(n: u32) -> vec4r {
    return positions[n];
}

fn store_position(n: u32, moved: Moved, rim: bool, mass: real) {
    positions[n] = vec4r(moved.x, mass);
}

@group(0) @binding(10) var<storage, read_write> positions: array<vec4f>;
@group(0) @binding(11) var<storage, read_write> velocities: array<vec4f>;
@group(0) @binding(12) var<storage, read_write> positions_lo: array<vec4f>;
@group(0) @binding(13) var<storage, read_write> done: array<u32>;

// Position, and mass.
fn load_node(n: u32) -> vec4f {
    return positions[n] + vec4f(positions_lo[n].xyz, 0.0);
}

// hi + lo + dt v in full precision, then the landing on the road, so that hi is the rounded sum. A rim node is where
// the rim says, in single precision relative to the frame.
fn store_position(n: u32, moved: Moved, rim: bool, mass: f32) {
    if rim {
        positions[n] = vec4f(moved.x, mass);
        positions_lo[n] = vec4f(0.0);
        return;
    }
    let flown = two_sum(positions[n].xyz, positions_lo[n].xyz + step.dt * moved.v, step.pad);
    let landed = two_sum(flown.hi, flown.lo + landing(flown, moved.touches), step.pad);
    positions[n] = vec4f(landed.hi, mass);
    positions_lo[n] = vec4f(landed.lo, 0.0);
}

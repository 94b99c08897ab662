@group(0) @binding(10) var<storage, read_write> positions: array<vec4r>;
@group(0) @binding(11) var<storage, read_write> velocities: array<vec4r>;
@group(0) @binding(12) var<storage, read_write> positions_lo: array<vec4r>;
@group(0) @binding(13) var<storage, read_write> done: array<u32>;

// Position, and mass.
fn load_node(n: u32) -> vec4r {
    return positions[n] + vec4r(positions_lo[n].xyz, 0.0);
}

// hi + lo + dt v in full precision, then the landing on the road, so that hi is the rounded sum. A rim node is where
// the rim says, in single precision relative to the frame.
fn store_position(n: u32, moved: Moved, rim: bool, mass: real) {
    if rim {
        positions[n] = vec4r(moved.x, mass);
        positions_lo[n] = vec4r(0.0);
        return;
    }
    let flown = two_sum(positions[n].xyz, positions_lo[n].xyz + step.dt * moved.v, step.zero);
    let landed = two_sum(flown.hi, flown.lo + landing(flown, moved.touches), step.zero);
    positions[n] = vec4r(landed.hi, mass);
    positions_lo[n] = vec4r(landed.lo, 0.0);
}

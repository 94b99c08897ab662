// Positions as unevaluated sums hi + lo of two single-precision numbers: differences are taken hi - hi + lo - lo.

// Corners of a face, in single precision.
struct Part { a: vec3r, b: vec3r, c: vec3r, d: vec3r }

struct Face { hi: Part, lo: Part }

fn load_face(nodes: vec4u) -> Face {
    let a = nodes.x;
    let b = nodes.y;
    let c = nodes.z;
    let d = nodes.w;
    return Face(
        Part(positions[a].xyz, positions[b].xyz, positions[c].xyz, positions[d].xyz),
        Part(positions_lo[a].xyz, positions_lo[b].xyz, positions_lo[c].xyz, positions_lo[d].xyz));
}

fn sum_pair(a: Four, b: Four) -> Four {
    return Four(a.a + b.a, a.b + b.b, a.c + b.c, a.d + b.d);
}

fn corners_of(low: Part, high: Part) -> Corners {
    return Corners(low.a, low.b, low.c, low.d, high.a, high.b, high.c, high.d);
}

fn edges_of(low: Face, high: Face) -> Columns {
    let hi = edges(corners_of(low.hi, high.hi));
    let lo = edges(corners_of(low.lo, high.lo));
    return Columns(sum_pair(hi.xi, lo.xi), sum_pair(hi.eta, lo.eta), sum_pair(hi.zeta, lo.zeta));
}

// Differences to corner 0.
fn offsets_of(low: Face, high: Face) -> Corners {
    let x = corners_of(low.hi, high.hi);
    let y = corners_of(low.lo, high.lo);
    return Corners(
        vec3r(0.0), (x.a1 - x.a0) + (y.a1 - y.a0), (x.a2 - x.a0) + (y.a2 - y.a0), (x.a3 - x.a0) + (y.a3 - y.a0),
        (x.a4 - x.a0) + (y.a4 - y.a0), (x.a5 - x.a0) + (y.a5 - y.a0), (x.a6 - x.a0) + (y.a6 - y.a0),
        (x.a7 - x.a0) + (y.a7 - y.a0));
}

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

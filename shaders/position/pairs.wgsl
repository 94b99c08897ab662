// Positions as unevaluated sums hi + lo of two single-precision numbers: differences are taken hi - hi + lo - lo.

@group(0) @binding(10) var<storage, read> positions_in: array<vec4r>;
@group(0) @binding(12) var<storage, read> positions_lo_in: array<vec4r>;

// Corners of a face, in single precision.
struct Part { a: vec3r, b: vec3r, c: vec3r, d: vec3r }

struct Face { hi: Part, lo: Part }

fn load_face(nodes: vec4u) -> Face {
    let a = nodes.x;
    let b = nodes.y;
    let c = nodes.z;
    let d = nodes.w;
    return Face(
        Part(positions_in[a].xyz, positions_in[b].xyz, positions_in[c].xyz, positions_in[d].xyz),
        Part(positions_lo_in[a].xyz, positions_lo_in[b].xyz, positions_lo_in[c].xyz, positions_lo_in[d].xyz));
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

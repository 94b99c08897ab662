// Positions as unevaluated sums hi + lo of two single-precision numbers: differences are taken hi - hi + lo - lo.

@group(0) @binding(10) var<storage, read> positions_in: array<vec4f>;
@group(0) @binding(12) var<storage, read> positions_lo_in: array<vec4f>;

fn load_hi(h: Hex) -> Corners {
    return Corners(
        positions_in[h.n0].xyz, positions_in[h.n1].xyz, positions_in[h.n2].xyz, positions_in[h.n3].xyz,
        positions_in[h.n4].xyz, positions_in[h.n5].xyz, positions_in[h.n6].xyz, positions_in[h.n7].xyz);
}

fn load_lo(h: Hex) -> Corners {
    return Corners(
        positions_lo_in[h.n0].xyz, positions_lo_in[h.n1].xyz, positions_lo_in[h.n2].xyz, positions_lo_in[h.n3].xyz,
        positions_lo_in[h.n4].xyz, positions_lo_in[h.n5].xyz, positions_lo_in[h.n6].xyz, positions_lo_in[h.n7].xyz);
}

fn sum_pair(a: Four, b: Four) -> Four {
    return Four(a.a + b.a, a.b + b.b, a.c + b.c, a.d + b.d);
}

fn load_half_edges(h: Hex) -> Columns {
    let hi = half_edges(load_hi(h));
    let lo = half_edges(load_lo(h));
    return Columns(sum_pair(hi.xi, lo.xi), sum_pair(hi.eta, lo.eta), sum_pair(hi.zeta, lo.zeta));
}

// Differences to corner 0.
fn load_offsets(h: Hex) -> Corners {
    let x = load_hi(h);
    let y = load_lo(h);
    return Corners(
        vec3f(0.0), (x.a1 - x.a0) + (y.a1 - y.a0), (x.a2 - x.a0) + (y.a2 - y.a0), (x.a3 - x.a0) + (y.a3 - y.a0),
        (x.a4 - x.a0) + (y.a4 - y.a0), (x.a5 - x.a0) + (y.a5 - y.a0), (x.a6 - x.a0) + (y.a6 - y.a0),
        (x.a7 - x.a0) + (y.a7 - y.a0));
}

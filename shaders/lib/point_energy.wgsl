// Stored energy of the 2x2x2 points of `q1p0` and `full`.

// (pointwise energy, smallest det F), volumetric energy by the element's own rule.
fn point_energy(a: mat3x3r, shape: u32, q: u32) -> vec2r {
    let geometry = classes[shape].points[q];
    let j = determinant(a) * geometry.inverse_det_j0;
    let k = invariants(Sym(geometry.metric, geometry.metric_off), gram(a));
    return vec2r(geometry.volume * (psi(k.i1, k.i2, j) + point_U(j)), j);
}

fn element_energy(lower: Face, upper: Face, shape: u32) -> vec3r {
    let c = gradients(edges_of(lower, upper));
    let e0 = point_energy(mat3x3r(c.xi.a, c.eta.a, c.zeta.a), shape, 0u);
    let e1 = point_energy(mat3x3r(c.xi.a, c.eta.b, c.zeta.b), shape, 1u);
    let e2 = point_energy(mat3x3r(c.xi.b, c.eta.a, c.zeta.c), shape, 2u);
    let e3 = point_energy(mat3x3r(c.xi.b, c.eta.b, c.zeta.d), shape, 3u);
    let e4 = point_energy(mat3x3r(c.xi.c, c.eta.c, c.zeta.a), shape, 4u);
    let e5 = point_energy(mat3x3r(c.xi.c, c.eta.d, c.zeta.b), shape, 5u);
    let e6 = point_energy(mat3x3r(c.xi.d, c.eta.c, c.zeta.c), shape, 6u);
    let e7 = point_energy(mat3x3r(c.xi.d, c.eta.d, c.zeta.d), shape, 7u);
    let low = min(min(e0.y, e1.y), min(e2.y, e3.y));
    let high = min(min(e4.y, e5.y), min(e6.y, e7.y));
    let sum = e0.x + e1.x + e2.x + e3.x + e4.x + e5.x + e6.x + e7.x;
    return vec3r(sum + mean_U(c, shape), 0.0, min(low, high));
}

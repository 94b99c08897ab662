// The 2x2x2 points of `q1p0` and `full`: force matrices summed on the Gauss lines.

struct PointForce { g: mat3x3r, min_j: real }

fn point(a: mat3x3r, shape: u32, q: u32, mean_pressure: real) -> PointForce {
    let geometry = classes[shape].points[q];
    let cof = cofactor(a);
    let j = dot(a[0], cof[0]) * geometry.inverse_det_j0;
    let k = kinematics(a, geometry.metric, geometry.metric_off);
    let d = first_piola(k.i1, k.i2, j);
    let p = point_pressure(mean_pressure, j);
    return PointForce(force_matrix(a, k, d, p, cof, geometry.det_j0), j);
}

// Forces on the lines and the smallest det F.
struct LineForces { lines: Columns, min_j: real }

fn internal_forces(c: Columns, shape: u32) -> LineForces {
    let p = mean_pressure(c, shape);
    let q0 = point(mat3x3r(c.xi.a, c.eta.a, c.zeta.a), shape, 0u, p);
    let q1 = point(mat3x3r(c.xi.a, c.eta.b, c.zeta.b), shape, 1u, p);
    let q2 = point(mat3x3r(c.xi.b, c.eta.a, c.zeta.c), shape, 2u, p);
    let q3 = point(mat3x3r(c.xi.b, c.eta.b, c.zeta.d), shape, 3u, p);
    let q4 = point(mat3x3r(c.xi.c, c.eta.c, c.zeta.a), shape, 4u, p);
    let q5 = point(mat3x3r(c.xi.c, c.eta.d, c.zeta.b), shape, 5u, p);
    let q6 = point(mat3x3r(c.xi.d, c.eta.c, c.zeta.c), shape, 6u, p);
    let q7 = point(mat3x3r(c.xi.d, c.eta.d, c.zeta.d), shape, 7u, p);
    let lines = Columns(
        Four(q0.g[0] + q1.g[0], q2.g[0] + q3.g[0], q4.g[0] + q5.g[0], q6.g[0] + q7.g[0]),
        Four(q0.g[1] + q2.g[1], q1.g[1] + q3.g[1], q4.g[1] + q6.g[1], q5.g[1] + q7.g[1]),
        Four(q0.g[2] + q4.g[2], q1.g[2] + q5.g[2], q2.g[2] + q6.g[2], q3.g[2] + q7.g[2]));
    let low = min(min(q0.min_j, q1.min_j), min(q2.min_j, q3.min_j));
    let high = min(min(q4.min_j, q5.min_j), min(q6.min_j, q7.min_j));
    return LineForces(lines, min(low, high));
}

fn volume(c: Columns) -> real {
    return determinant(mat3x3r(c.xi.a, c.eta.a, c.zeta.a)) + determinant(mat3x3r(c.xi.a, c.eta.b, c.zeta.b))
        + determinant(mat3x3r(c.xi.b, c.eta.a, c.zeta.c)) + determinant(mat3x3r(c.xi.b, c.eta.b, c.zeta.d))
        + determinant(mat3x3r(c.xi.c, c.eta.c, c.zeta.a)) + determinant(mat3x3r(c.xi.c, c.eta.d, c.zeta.b))
        + determinant(mat3x3r(c.xi.d, c.eta.c, c.zeta.c)) + determinant(mat3x3r(c.xi.d, c.eta.d, c.zeta.d));
}

// (pointwise energy, smallest det F), volumetric energy by the element's own rule.
fn point_energy(a: mat3x3r, shape: u32, q: u32) -> vec2r {
    let geometry = classes[shape].points[q];
    let j = determinant(a) * geometry.inverse_det_j0;
    let k = kinematics(a, geometry.metric, geometry.metric_off);
    return vec2r(geometry.det_j0 * (psi(k.i1, k.i2, j) + point_U(j)), j);
}

fn element_energy(lower: Face, upper: Face, shape: u32) -> vec3r {
    let c = gradients(half_edges_of(lower, upper));
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

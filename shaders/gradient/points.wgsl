// The 2x2x2 points of `q1p0` and `full`; twin of src/physics/element/q1p0.rs.

alias Class = PointClass;

// A at a point, its cofactor, det A, det F, A^T A, the rate of A; its number, and its volume.
struct Deformed {
    a: mat3x3r, cof: mat3x3r, det_a: real, j: real, gram: Sym, rate: mat3x3r, q: u32, volume: real
}

// A at a point, its cofactor, what multiplies that, and S.
struct Point { a: mat3x3r, cof: mat3x3r, p: Pressure, s: Sym, j: real }

fn point(a: mat3x3r, squares: vec3r, shape: u32, q: u32, mean: real, rate: mat3x3r) -> Point {
    let geometry = classes[shape].points[q];
    let m = Sym(geometry.metric, geometry.metric_off);
    let cof = cofactor(a);
    let det_a = dot(a[0], cof[0]);
    let j = det_a * geometry.inverse_det_j0;
    let g = Sym(squares, vec3r(dot(a[0], a[1]), dot(a[0], a[2]), dot(a[1], a[2])));
    let k = invariants(m, g);
    let d = derivatives(k.i1, k.i2, j);
    let at = Deformed(a, cof, det_a, j, g, rate, q, geometry.volume);
    let p = pressed((d.z + point_pressure(mean, j)) * WEIGHT, at, k, d, m);
    return Point(a, cof, p, second_piola(k, d, m, geometry.volume), j);
}

// Forces on the lines, the smallest det F, and the viscous power.
struct LineForces { lines: Columns, min_j: real, power: real }

fn squares_of(lines: Four) -> vec4r {
    return vec4r(dot(lines.a, lines.a), dot(lines.b, lines.b), dot(lines.c, lines.c), dot(lines.d, lines.d));
}

// Force on a line from its two points, whose column of A is the same.
fn on_xi(p: Point, q: Point) -> vec3r {
    let first = coupled_xi(pressing(p.p, p.cof[0]), p.a, p.s);
    return coupled_xi(pressing_on(first, q.p, q.cof[0]), q.a, q.s) + q.a[0] * (p.s.d.x + q.s.d.x);
}

fn on_eta(p: Point, q: Point) -> vec3r {
    let first = coupled_eta(pressing(p.p, p.cof[1]), p.a, p.s);
    return coupled_eta(pressing_on(first, q.p, q.cof[1]), q.a, q.s) + q.a[1] * (p.s.d.y + q.s.d.y);
}

fn on_zeta(p: Point, q: Point) -> vec3r {
    let first = coupled_zeta(pressing(p.p, p.cof[2]), p.a, p.s);
    return coupled_zeta(pressing_on(first, q.p, q.cof[2]), q.a, q.s) + q.a[2] * (p.s.d.z + q.s.d.z);
}

// From the columns of A and of its rate, which without viscosity is not read.
fn internal_forces(c: Columns, shape: u32, mean: real, r: Columns) -> LineForces {
    let x = squares_of(c.xi);
    let y = squares_of(c.eta);
    let z = squares_of(c.zeta);
    let q0 = point(
        mat3x3r(c.xi.a, c.eta.a, c.zeta.a), vec3r(x.x, y.x, z.x), shape, 0u, mean,
        mat3x3r(r.xi.a, r.eta.a, r.zeta.a));
    let q1 = point(
        mat3x3r(c.xi.a, c.eta.b, c.zeta.b), vec3r(x.x, y.y, z.y), shape, 1u, mean,
        mat3x3r(r.xi.a, r.eta.b, r.zeta.b));
    let q2 = point(
        mat3x3r(c.xi.b, c.eta.a, c.zeta.c), vec3r(x.y, y.x, z.z), shape, 2u, mean,
        mat3x3r(r.xi.b, r.eta.a, r.zeta.c));
    let q3 = point(
        mat3x3r(c.xi.b, c.eta.b, c.zeta.d), vec3r(x.y, y.y, z.w), shape, 3u, mean,
        mat3x3r(r.xi.b, r.eta.b, r.zeta.d));
    let q4 = point(
        mat3x3r(c.xi.c, c.eta.c, c.zeta.a), vec3r(x.z, y.z, z.x), shape, 4u, mean,
        mat3x3r(r.xi.c, r.eta.c, r.zeta.a));
    let q5 = point(
        mat3x3r(c.xi.c, c.eta.d, c.zeta.b), vec3r(x.z, y.w, z.y), shape, 5u, mean,
        mat3x3r(r.xi.c, r.eta.d, r.zeta.b));
    let q6 = point(
        mat3x3r(c.xi.d, c.eta.c, c.zeta.c), vec3r(x.w, y.z, z.z), shape, 6u, mean,
        mat3x3r(r.xi.d, r.eta.c, r.zeta.c));
    let q7 = point(
        mat3x3r(c.xi.d, c.eta.d, c.zeta.d), vec3r(x.w, y.w, z.w), shape, 7u, mean,
        mat3x3r(r.xi.d, r.eta.d, r.zeta.d));
    let lines = Columns(
        Four(on_xi(q0, q1), on_xi(q2, q3), on_xi(q4, q5), on_xi(q6, q7)),
        Four(on_eta(q0, q2), on_eta(q1, q3), on_eta(q4, q6), on_eta(q5, q7)),
        Four(on_zeta(q0, q4), on_zeta(q1, q5), on_zeta(q2, q6), on_zeta(q3, q7)));
    let low = min(min(q0.j, q1.j), min(q2.j, q3.j));
    let high = min(min(q4.j, q5.j), min(q6.j, q7.j));
    let power = power_of(q0.p) + power_of(q1.p) + power_of(q2.p) + power_of(q3.p)
        + power_of(q4.p) + power_of(q5.p) + power_of(q6.p) + power_of(q7.p);
    return LineForces(lines, min(low, high), power);
}

// (pointwise energy, integral of J - 1, det F), volumetric energy by the element's own rule. The metric is the inverse of
// what A^T A is in the reference shape.
fn point_energy(a: mat3x3r, shape: u32, q: u32) -> vec3r {
    let geometry = classes[shape].points[q];
    let metric = full(Sym(geometry.metric, geometry.metric_off));
    let s = strain_of(metric * (full(gram(a)) - inverse_of(metric)));
    let energy = psi(s) + point_U(s.dilatation);
    return vec3r(geometry.volume * vec2r(energy, s.dilatation), determinant(a) * geometry.inverse_det_j0);
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
    let low = min(min(e0.z, e1.z), min(e2.z, e3.z));
    let high = min(min(e4.z, e5.z), min(e6.z, e7.z));
    let sum = e0.xy + e1.xy + e2.xy + e3.xy + e4.xy + e5.xy + e6.xy + e7.xy;
    return vec3r(sum.x + mean_U(sum.y, shape), 0.0, min(low, high));
}

// Element force with viscosity: sigma_v cof(A) added on the Gauss lines.

struct ElementForce { f: Corners, min_j: real, viscous_power: real }

struct ViscousLines { lines: Columns, power: real }

fn viscous_forces(c: Columns, r: Columns) -> ViscousLines {
    let q0 = viscous_stress(mat3x3r(c.xi.a, c.eta.a, c.zeta.a), mat3x3r(r.xi.a, r.eta.a, r.zeta.a));
    let q1 = viscous_stress(mat3x3r(c.xi.a, c.eta.b, c.zeta.b), mat3x3r(r.xi.a, r.eta.b, r.zeta.b));
    let q2 = viscous_stress(mat3x3r(c.xi.b, c.eta.a, c.zeta.c), mat3x3r(r.xi.b, r.eta.a, r.zeta.c));
    let q3 = viscous_stress(mat3x3r(c.xi.b, c.eta.b, c.zeta.d), mat3x3r(r.xi.b, r.eta.b, r.zeta.d));
    let q4 = viscous_stress(mat3x3r(c.xi.c, c.eta.c, c.zeta.a), mat3x3r(r.xi.c, r.eta.c, r.zeta.a));
    let q5 = viscous_stress(mat3x3r(c.xi.c, c.eta.d, c.zeta.b), mat3x3r(r.xi.c, r.eta.d, r.zeta.b));
    let q6 = viscous_stress(mat3x3r(c.xi.d, c.eta.c, c.zeta.c), mat3x3r(r.xi.d, r.eta.c, r.zeta.c));
    let q7 = viscous_stress(mat3x3r(c.xi.d, c.eta.d, c.zeta.d), mat3x3r(r.xi.d, r.eta.d, r.zeta.d));
    let lines = Columns(
        Four(q0.g[0] + q1.g[0], q2.g[0] + q3.g[0], q4.g[0] + q5.g[0], q6.g[0] + q7.g[0]),
        Four(q0.g[1] + q2.g[1], q1.g[1] + q3.g[1], q4.g[1] + q6.g[1], q5.g[1] + q7.g[1]),
        Four(q0.g[2] + q4.g[2], q1.g[2] + q5.g[2], q2.g[2] + q6.g[2], q3.g[2] + q7.g[2]));
    let power = q0.power + q1.power + q2.power + q3.power + q4.power + q5.power + q6.power + q7.power;
    return ViscousLines(lines, power);
}

fn sum_four(a: Four, b: Four) -> Four {
    return Four(a.a + b.a, a.b + b.b, a.c + b.c, a.d + b.d);
}

// What a thread carries from one element of a chain to the next.
struct End { x: Face, v: Rates }

fn load_end(nodes: vec4u) -> End {
    return End(load_face(nodes), load_rates(nodes));
}

fn element_force(low: End, high: End, shape: u32) -> ElementForce {
    let columns = gradients(half_edges_of(low.x, high.x));
    let elastic = internal_forces(columns, shape);
    let viscous = viscous_forces(columns, gradients(half_edges(rates_of(low.v, high.v))));
    let lines = Columns(
        sum_four(elastic.lines.xi, viscous.lines.xi),
        sum_four(elastic.lines.eta, viscous.lines.eta),
        sum_four(elastic.lines.zeta, viscous.lines.zeta));
    return ElementForce(scatter(lines), elastic.min_j, viscous.power);
}

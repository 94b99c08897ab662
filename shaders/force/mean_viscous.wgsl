// Uniform-gradient element force with viscosity, also on the hourglass modes.

struct ElementForce { f: Corners, min_j: real, viscous_power: real }

fn rate_offsets(v: Corners) -> Corners {
    return Corners(
        vec3r(0.0), v.a1 - v.a0, v.a2 - v.a0, v.a3 - v.a0, v.a4 - v.a0, v.a5 - v.a0, v.a6 - v.a0, v.a7 - v.a0);
}

// What a thread carries from one element of a chain to the next.
struct End { x: Face, v: Rates }

fn load_end(nodes: vec4u) -> End {
    return End(load_face(nodes), load_rates(nodes));
}

fn element_force(low: End, high: End, shape: u32) -> ElementForce {
    let m = modes(offsets_of(low.x, high.x), shape);
    let d = modes(rate_offsets(rates_of(low.v, high.v)), shape);
    let s = mean_stress(m.f);
    let v = viscous_stress(d.f, s.cof, s.j, 1.0);
    let k = classes[shape].hourglass_stiffness;
    let c = classes[shape].hourglass_viscosity;
    let r = Modes(m.f, k * m.h0 + c * d.h0, k * m.h1 + c * d.h1, k * m.h2 + c * d.h2, k * m.h3 + c * d.h3);
    let q2 = dot(d.h0, d.h0) + dot(d.h1, d.h1) + dot(d.h2, d.h2) + dot(d.h3, d.h3);
    let power = v.power * classes[shape].volume + c * q2;
    return ElementForce(corner_forces(s.p + v.stress * s.cof, r, shape), s.j, power);
}

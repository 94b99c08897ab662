// Uniform-gradient element force with viscosity, also on the hourglass modes, and a Prony series.

struct ElementForce { f: Corners, min_j: real, viscous_power: real }

fn rate_offsets(v: Corners) -> Corners {
    return Corners(
        vec3r(0.0), v.a1 - v.a0, v.a2 - v.a0, v.a3 - v.a0, v.a4 - v.a0, v.a5 - v.a0, v.a6 - v.a0, v.a7 - v.a0);
}

// u v^T
fn outer(u: vec3r, v: vec3r) -> mat3x3r {
    return mat3x3r(u * v.x, u * v.y, u * v.z);
}

// The mean gradient, its cofactor and det F twice, F^T F, the rate of F; the number of the point, and the element's volume.
struct Deformed {
    a: mat3x3r, cof: mat3x3r, det_a: real, j: real, gram: Sym, rate: mat3x3r, q: u32, volume: real
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
    let l = d.f * transpose(s.cof);
    let v = viscous_stress(l, s.j, 1.0);
    let g = gram(m.f);
    let i = invariants(identity(), g);
    let w = derivatives(i.i1, i.i2, s.j);
    let volume = classes[shape].volume;
    let at = Deformed(m.f, s.cof, s.j, s.j, g, d.f, 0u, volume);
    let over = overstress(at, second_piola(i, w, identity(), 1.0), w.z, volume);
    let lasting = s.p + m.f * full(over.stress) + s.cof * (over.pressure / s.j);
    let k = classes[shape].hourglass_stiffness;
    let c = classes[shape].hourglass_viscosity;
    let t0 = turning(l, s.j, m.h0, d.h0);
    let t1 = turning(l, s.j, m.h1, d.h1);
    let t2 = turning(l, s.j, m.h2, d.h2);
    let t3 = turning(l, s.j, m.h3, d.h3);
    let r = Modes(m.f, k * m.h0 + c * t0, k * m.h1 + c * t1, k * m.h2 + c * t2, k * m.h3 + c * t3);
    // Without this part of the stress, q x dq/dt would be a moment on the whole element.
    let couple = outer(m.h0, t0) + outer(m.h1, t1) + outer(m.h2, t2) + outer(m.h3, t3);
    let stress = v.stress + couple * (c / (classes[shape].volume * s.j));
    let modes_power = dot(t0, d.h0) + dot(t1, d.h1) + dot(t2, d.h2) + dot(t3, d.h3);
    let couple_power = (dot(couple[0], l[0]) + dot(couple[1], l[1]) + dot(couple[2], l[2])) * (1.0 / s.j);
    let power = v.power * classes[shape].volume + c * (modes_power + couple_power);
    return ElementForce(corner_forces(lasting + stress * s.cof, r, shape), s.j, power);
}

// Element force with viscosity and a Prony series: their stresses times cof(A) added on the Gauss lines.

struct ElementForce { f: Corners, min_j: real, viscous_power: real }

// What a thread carries from one element of a chain to the next.
struct End { x: Face, v: Rates }

fn load_end(nodes: vec4u) -> End {
    return End(load_face(nodes), load_rates(nodes));
}

// What multiplies a point's cofactor: pressure, viscous stress and overstress.
struct Pressure { stress: mat3x3r, power: real }

fn pressed(p: real, at: Deformed, k: Invariants, d: vec3r, m: Sym) -> Pressure {
    let viscous = viscous_stress(at.rate * transpose(at.cof), at.det_a, WEIGHT);
    // A S dv is A S A^T / det A dv times the cofactor.
    let over = overstress(at, second_piola(k, d, m, 1.0), d.z, at.volume);
    let pull = at.a * full(over.stress);
    var stress = viscous.stress + (pull * transpose(at.a)) * (at.volume / at.det_a);
    let pressure = p + over.pressure * (WEIGHT / at.j);
    stress[0][0] += pressure;
    stress[1][1] += pressure;
    stress[2][2] += pressure;
    return Pressure(stress, viscous.power);
}

fn pressing(p: Pressure, cof: vec3r) -> vec3r {
    return p.stress[0] * cof.x + p.stress[1] * cof.y + p.stress[2] * cof.z;
}

fn pressing_on(sum: vec3r, p: Pressure, cof: vec3r) -> vec3r {
    return sum + p.stress[0] * cof.x + p.stress[1] * cof.y + p.stress[2] * cof.z;
}

fn power_of(p: Pressure) -> real {
    return p.power;
}

fn element_force(low: End, high: End, shape: u32) -> ElementForce {
    let c = gradients(edges_of(low.x, high.x));
    let rates = gradients(edges(rates_of(low.v, high.v)));
    let forces = internal_forces(c, shape, mean_pressure(c, shape), rates);
    return ElementForce(scatter(forces.lines), forces.min_j, forces.power);
}

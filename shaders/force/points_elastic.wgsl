// Element force without viscosity.

struct ElementForce { f: Corners, min_j: real }

// What a thread carries from one element of a chain to the next.
struct End { x: Face }

fn load_end(nodes: vec4u) -> End {
    return End(load_face(nodes));
}

// What multiplies a point's cofactor.
struct Pressure { p: real }

fn pressed(p: real, at: Deformed, k: Invariants, d: vec3r, m: Sym) -> Pressure {
    return Pressure(p);
}

fn pressing(p: Pressure, cof: vec3r) -> vec3r {
    return cof * p.p;
}

fn pressing_on(sum: vec3r, p: Pressure, cof: vec3r) -> vec3r {
    return sum + cof * p.p;
}

fn power_of(p: Pressure) -> real {
    return 0.0;
}

fn element_force(low: End, high: End, shape: u32) -> ElementForce {
    let c = gradients(edges_of(low.x, high.x));
    let forces = internal_forces(c, shape, mean_pressure(c, shape), c);
    return ElementForce(scatter(forces.lines), forces.min_j);
}

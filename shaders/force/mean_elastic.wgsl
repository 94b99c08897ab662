// Uniform-gradient element force without viscosity.

struct ElementForce { f: Corners, min_j: real }

// What a thread carries from one element of a chain to the next.
struct End { x: Face }

fn load_end(nodes: vec4u) -> End {
    return End(load_face(nodes));
}

fn element_force(low: End, high: End, shape: u32) -> ElementForce {
    let m = modes(offsets_of(low.x, high.x), shape);
    let s = mean_stress(m.f);
    let k = classes[shape].hourglass_stiffness;
    let r = Modes(m.f, k * m.h0, k * m.h1, k * m.h2, k * m.h3);
    return ElementForce(corner_forces(s.p, r, shape), s.j);
}

// Uniform-gradient element force without viscosity.

struct ElementForce { f: Corners, min_j: f32 }

fn element_force(nodes: Hex, shape: u32) -> ElementForce {
    let m = modes(load_offsets(nodes), shape);
    let s = mean_stress(m.f);
    let k = classes[shape].hourglass_stiffness;
    let r = Modes(m.f, k * m.h0, k * m.h1, k * m.h2, k * m.h3);
    return ElementForce(corner_forces(s.p, r, shape), s.j);
}

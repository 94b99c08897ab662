// Uniform-gradient element force without viscosity.

struct ElementForce { f: Corners, min_j: f32 }

fn element_force(nodes: Hex, class: u32) -> ElementForce {
    let m = modes(load_offsets(nodes), class);
    let s = mean_stress(m.f);
    let k = classes[class].hourglass_stiffness;
    let r = Modes(m.f, k * m.h0, k * m.h1, k * m.h2, k * m.h3);
    return ElementForce(corner_forces(s.p, r, class), s.j);
}

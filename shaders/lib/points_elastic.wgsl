// Element force without viscosity.

struct ElementForce { f: Corners, min_j: f32 }

fn element_force(nodes: Hex, shape: u32) -> ElementForce {
    let forces = internal_forces(gradients(load_half_edges(nodes)), shape);
    return ElementForce(scatter(forces.lines), forces.min_j);
}

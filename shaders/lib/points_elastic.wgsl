// Element force without viscosity.

struct ElementForce { f: Corners, min_j: real }

// What a thread carries from one element of a chain to the next.
struct End { x: Face }

fn load_end(nodes: vec4u) -> End {
    return End(load_face(nodes));
}

fn element_force(low: End, high: End, shape: u32) -> ElementForce {
    let forces = internal_forces(gradients(half_edges_of(low.x, high.x)), shape);
    return ElementForce(scatter(forces.lines), forces.min_j);
}

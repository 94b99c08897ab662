// Impulse, works and state of a surface node.

@group(0) @binding(7) var<storage, read_write> surface_sums: array<SurfaceRecord>;

fn book_contact(role: u32, moved: Moved, way: vec3f) {
    if role == INTERIOR {
        return;
    }
    surface_sums[role].state = moved.touches;
    if moved.touches == 0u {
        return;
    }
    surface_sums[role].impulse += vec4f(step.dtm * (moved.normal_force + moved.tangential_force), 0.0);
    surface_sums[role].normal_work += dot(moved.normal_force, way);
    surface_sums[role].friction_work += dot(moved.tangential_force, way);
    surface_sums[role].touching += 1u;
    surface_sums[role].sticking += select(0u, 1u, moved.touches == 2u);
}

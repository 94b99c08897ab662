// Impulse, works and state of a surface node.

@group(0) @binding(7) var<storage, read_write> surface_sums: array<SurfaceRecord>;
@group(0) @binding(15) var<storage, read_write> contact_states: array<u32>;

// Gives back what the step's sum over the body needs: force, and touching + 4096 (another state than the step before).
fn book_contact(role: u32, moved: Moved, way: vec3r) -> vec4r {
    let k = of_surface(role);
    let before = contact_states[k];
    if before == 0u && moved.touches == 0u {
        return vec4r(0.0);
    }
    contact_states[k] = moved.touches;
    let changed = select(real(4096.0), real(0.0), before == moved.touches);
    if moved.touches == 0u {
        return vec4r(vec3r(0.0), changed);
    }
    let force = moved.normal_force + moved.tangential_force;
    surface_sums[k].impulse += step.dtm * vec4r(force, road_work(force, moved.x));
    surface_sums[k].normal_work += dot(moved.normal_force, way);
    surface_sums[k].friction_work += dot(moved.tangential_force, way);
    surface_sums[k].touching += 1u;
    surface_sums[k].sticking += select(0u, 1u, moved.touches == 2u);
    return vec4r(force, changed + 1.0);
}

// Contact that is always satisfied; twin of src/physics/contact.rs.

fn touched(node: Node, x: vec3r, v: vec3r, v_star: vec3r) -> Moved {
    if node.role == INTERIOR {
        return unconstrained(x, v_star);
    }
    let x_star = x + step.dt * v_star;
    let gap = road_gap(x_star);
    if !(gap < 0.0) {
        return Moved(x_star, v_star, vec3r(0.0), vec3r(0.0), 0u);
    }
    let n = road_normal(x_star);
    let push = -gap / step.dt;
    let per_step = inertia(node.mass) / step.dtm;
    let pressed = v_star + push * n;
    let rubbed = rub(node.role, x_star, v, n, push, per_step, pressed);
    let x_free = x + step.dt * rubbed.v;
    let x_new = x_free - road_gap(x_free) * n;
    return Moved(x_new, rubbed.v, per_step * push * n, per_step * (rubbed.v - pressed), rubbed.touches);
}

// Velocity after friction, and 1 (slides) or 2 (sticks).
struct Rubbed { v: vec3r, touches: u32 }

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

// What puts a touching node on the surface to the last digit of the pair.
fn landing(x: Pair, touches: u32) -> vec3r {
    let n = road_normal(x.hi);
    return select(vec3r(0.0), -(road_gap(x.hi) + dot(n, x.lo)) * n, touches != 0u);
}

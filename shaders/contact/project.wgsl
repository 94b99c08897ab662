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

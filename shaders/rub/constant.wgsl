// Friction with a constant coefficient.

// With the road if the force that needs is within the cone, else slowed by mu fN.
fn rub(role: u32, x: vec3r, v: vec3r, n: vec3r, push: real, per_step: real, pressed: vec3r) -> Rubbed {
    let surface = road_velocity(x);
    let relative = pressed - surface;
    let normal_speed = dot(relative, n);
    let slip = relative - normal_speed * n;
    let speed = sqrt(dot(slip, slip));
    let most = friction_coefficient(per_step * push, speed) * push;
    if speed <= most {
        return Rubbed(surface + normal_speed * n, 2u);
    }
    return Rubbed(pressed - (most / speed) * slip, 1u);
}

// Power that the road's motion puts into a node at x [W].
fn road_work(force: vec3r, x: vec3r) -> real {
    return dot(force, road_velocity(x));
}

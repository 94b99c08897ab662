// Friction whose coefficient depends on pressure and speed; twin of `tangential` and `slowed_by` in
// src/physics/contact.rs: a fixed-point pass and a secant find the speed that remains.
fn rub(role: u32, x: vec3r, v: vec3r, n: vec3r, push: real, per_step: real, pressed: vec3r) -> Rubbed {
    let surface = road_velocity(x);
    let relative = pressed - surface;
    let normal_speed = dot(relative, n);
    let slip = relative - normal_speed * n;
    let speed = sqrt(dot(slip, slip));
    let pressure = per_step * push * inverse_area(role);
    let held = friction_coefficient(pressure, 0.0) * push;
    let v_before = v - surface;
    let slip_before = v_before - dot(v_before, n) * n;
    let square = dot(slip_before, slip_before);
    // What rounding leaves of a node that stuck is no slip, nor what the road turns in a step.
    let seen = square > road_told_squared() * (dot(v, v) + dot(surface, surface));
    let before = select(real(0.0), sqrt(square), seen);
    let sliding = friction_coefficient(pressure, before) * push;
    if speed <= held && speed <= sliding {
        return Rubbed(surface + normal_speed * n, 2u);
    }
    let first = clamp(speed - sliding, 0.0, speed);
    let there = friction_coefficient(pressure, first) * push;
    let way = first - before;
    let slope = way + there - sliding;
    var remains = first;
    if slope * way > 0.0 {
        remains = clamp(first - (first + there - speed) * way / slope, 0.0, speed);
    }
    let slowed = min(friction_coefficient(pressure, remains) * push, speed);
    return Rubbed(pressed - (slowed / speed) * slip, 1u);
}

// Power that the road's motion puts into a node at x [W].
fn road_work(force: vec3r, x: vec3r) -> real {
    return dot(force, road_velocity(x));
}

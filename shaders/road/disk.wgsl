// A plane that turns about its own normal; twin of src/physics/road/disk.rs.

override road_normal_x: real;
override road_normal_y: real;
override road_normal_z: real;
override road_offset: real;

fn road_normal(x: vec3r) -> vec3r {
    return vec3r(road_normal_x, road_normal_y, road_normal_z);
}

fn road_gap(x: vec3r) -> real {
    return dot(road_normal(x), x) - road_offset;
}

override road_point_x: real;
override road_point_y: real;
override road_point_z: real;
// At the point.
override road_velocity_x: real;
override road_velocity_y: real;
override road_velocity_z: real;
override road_spin: real;

// Mean velocity over a step of what ends the step at x: that of half a step back. With the one at its end a node that sticks
// would come nearer to the centre with every step.
fn road_velocity(x: vec3r) -> vec3r {
    let n = road_normal(x);
    let from_point = x - vec3r(road_point_x, road_point_y, road_point_z);
    let v = vec3r(road_velocity_x, road_velocity_y, road_velocity_z) + road_spin * cross(n, from_point);
    return v - (0.5 * road_spin * step.dt) * cross(n, v);
}

// What a velocity turns in a step is not told from slip.
fn road_told_squared() -> real {
    let angle = road_spin * step.dt;
    return rounding_squared() + angle * angle;
}

// A half-space below a moving plane; twin of src/physics/road/plane.rs.

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

override road_velocity_x: real;
override road_velocity_y: real;
override road_velocity_z: real;

fn road_velocity(x: vec3r) -> vec3r {
    return vec3r(road_velocity_x, road_velocity_y, road_velocity_z);
}

// Rounding alone hides slip.
fn road_told_squared() -> real {
    return rounding_squared();
}

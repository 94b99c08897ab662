// A half-space below a moving plane; twin of src/physics/road/plane.rs.

override normal_x: f32;
override normal_y: f32;
override normal_z: f32;
override road_offset: f32;

fn road_normal(x: vec3f) -> vec3f {
    return vec3f(normal_x, normal_y, normal_z);
}

fn road_gap(x: vec3f) -> f32 {
    return dot(road_normal(x), x) - road_offset;
}

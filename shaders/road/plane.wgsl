// A half-space below a moving plane; twin of src/physics/road/plane.rs.

override normal_x: real;
override normal_y: real;
override normal_z: real;
override road_offset: real;

fn road_normal(x: vec3r) -> vec3r {
    return vec3r(normal_x, normal_y, normal_z);
}

fn road_gap(x: vec3r) -> real {
    return dot(road_normal(x), x) - road_offset;
}

override road_velocity_x: real;
override road_velocity_y: real;
override road_velocity_z: real;

fn road_velocity(x: vec3r) -> vec3r {
    return vec3r(road_velocity_x, road_velocity_y, road_velocity_z);
}

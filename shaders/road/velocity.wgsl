fn road_velocity(x: vec3f) -> vec3f {
    return vec3f(road_velocity_x, road_velocity_y, road_velocity_z);
}

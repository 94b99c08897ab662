override road_velocity_x: f32;
override road_velocity_y: f32;
override road_velocity_z: f32;

fn road_velocity(x: vec3f) -> vec3f {
    return vec3f(road_velocity_x, road_velocity_y, road_velocity_z);
}

override gravity_x: f32;
override gravity_y: f32;
override gravity_z: f32;

fn gravity() -> vec3f {
    return vec3f(gravity_x, gravity_y, gravity_z);
}

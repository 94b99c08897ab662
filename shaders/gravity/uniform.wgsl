override gravity_x: real;
override gravity_y: real;
override gravity_z: real;

fn gravity() -> vec3r {
    return vec3r(gravity_x, gravity_y, gravity_z);
}

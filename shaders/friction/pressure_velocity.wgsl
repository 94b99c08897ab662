// mu = a + b exp(-p/p0) + c exp(-v/v0); twin of src/physics/friction/pressure_velocity.rs.

override friction_a: f32;
override friction_b: f32;
override friction_inverse_pressure: f32;
override friction_c: f32;
override friction_inverse_speed: f32;

fn friction_coefficient(pressure: f32, speed: f32) -> f32 {
    return friction_a + friction_b * exp(-pressure * friction_inverse_pressure)
        + friction_c * exp(-speed * friction_inverse_speed);
}

// mu = a + b exp(-p/p0) + c exp(-v/v0); twin of src/physics/friction/pressure_velocity.rs.

override friction_a: real;
override friction_b: real;
override friction_pressure: real;
override friction_c: real;
override friction_speed: real;

fn friction_coefficient(pressure: real, speed: real) -> real {
    return friction_a + friction_b * exponential(-pressure / friction_pressure)
        + friction_c * exponential(-speed / friction_speed);
}

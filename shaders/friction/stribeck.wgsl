// mu = kinetic + (still - kinetic) exp(-(v/speed)^2) + slope v; twin of src/physics/friction/stribeck.rs.

override friction_still: real;
override friction_kinetic: real;
override friction_speed: real;
override friction_slope: real;

fn friction_coefficient(pressure: real, speed: real) -> real {
    let s = speed / friction_speed;
    return friction_kinetic + (friction_still - friction_kinetic) * exponential(-s * s) + friction_slope * speed;
}

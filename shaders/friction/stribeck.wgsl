// mu = kinetic + (still - kinetic) exp(-(v/speed)^2) + slope v; twin of src/physics/friction/stribeck.rs.

override friction_still: f32;
override friction_kinetic: f32;
override friction_inverse_speed: f32;
override friction_slope: f32;

fn friction_coefficient(pressure: f32, speed: f32) -> f32 {
    let s = speed * friction_inverse_speed;
    return friction_kinetic + (friction_still - friction_kinetic) * exp(-s * s) + friction_slope * speed;
}

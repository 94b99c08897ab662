// mu = slope v; twin of src/physics/friction/viscous.rs.

override friction_slope: f32;

fn friction_coefficient(pressure: f32, speed: f32) -> f32 {
    return friction_slope * speed;
}

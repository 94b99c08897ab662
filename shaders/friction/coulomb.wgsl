// |fT| <= mu |fN| (eq. 10); twin of src/physics/friction/coulomb.rs.

override mu: f32;

fn friction_coefficient(normal_force: f32, slip_speed: f32) -> f32 {
    return mu;
}

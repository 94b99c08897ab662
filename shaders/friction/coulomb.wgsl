// |fT| <= mu |fN| (eq. 10); twin of src/physics/friction/coulomb.rs.

override mu: real;

fn friction_coefficient(normal_force: real, slip_speed: real) -> real {
    return mu;
}

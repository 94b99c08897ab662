// |fT| <= mu |fN| (eq. 10); twin of src/physics/friction/coulomb.rs.

override friction_mu: real;

fn friction_coefficient(pressure: real, slip_speed: real) -> real {
    return friction_mu;
}

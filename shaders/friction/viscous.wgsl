// mu = slope v; twin of src/physics/friction/viscous.rs.

override friction_slope: real;

fn friction_coefficient(pressure: real, speed: real) -> real {
    return friction_slope * speed;
}

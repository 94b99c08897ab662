// mu at rest and mu of what slides; twin of src/physics/friction/static_kinetic.rs.

override friction_still: real;
override friction_kinetic: real;

fn friction_coefficient(pressure: real, slip_speed: real) -> real {
    return select(friction_still, friction_kinetic, slip_speed > 0.0);
}

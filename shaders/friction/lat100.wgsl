// mu = a + b exp(-1/(alpha p)) + c exp(-1/(beta v)); twin of src/physics/friction/lat100.rs.

override friction_a: real;
override friction_b: real;
override friction_alpha: real;
override friction_c: real;
override friction_beta: real;

// exp(-1/x), and its limit at 0.
fn friction_growth(x: real) -> real {
    if !(x > 0.0) {
        return 0.0;
    }
    // Below this the exponential is none, and 1/x may be too large for a number.
    return exponential(-1.0 / max(x, 1e-20));
}

fn friction_coefficient(pressure: real, speed: real) -> real {
    return friction_a + friction_b * friction_growth(friction_alpha * pressure)
        + friction_c * friction_growth(friction_beta * speed);
}

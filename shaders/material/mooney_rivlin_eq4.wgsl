// W = g1/2 (I1 - 3 - 2 ln J) + g2/2 (I2/J^2 - 3 + 2 ln J), U = g0 (J - 1 - ln J) (eq. 4);
// twin of src/physics/material/mooney_rivlin_eq4.rs.

override g0: real;
override g1: real;
override g2: real;

fn psi(i1: real, i2: real, j: real) -> real {
    return g1 * (0.5 * (i1 - 3.0) - logarithm(j)) + g2 * (0.5 * (i2 / (j * j) - 3.0) + logarithm(j));
}

// (dW/dI1, dW/dI2, dW/dJ)
fn derivatives(i1: real, i2: real, j: real) -> vec3r {
    let r = 1.0 / j;
    let w2 = 0.5 * g2 * r * r;
    return vec3r(0.5 * g1, w2, r * (g2 - g1 - 2.0 * w2 * i2));
}

fn U(j: real) -> real {
    return g0 * (j - 1.0 - logarithm(j));
}

fn dU(j: real) -> real {
    return g0 * (1.0 - 1.0 / j);
}

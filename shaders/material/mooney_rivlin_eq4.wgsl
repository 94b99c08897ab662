// W = g1/2 (I1 - 3 - 2 ln J) + g2/2 (I2/J^2 - 3 + 2 ln J), U = g0 (J - 1 - ln J) (eq. 4);
// twin of src/physics/material/mooney_rivlin_eq4.rs.

override g0: real;
override g1: real;
override g2: real;

// With b = 1 / (a (1 - q)): I1 - 3 - 2 ln J = 3 (m - ln(1 + m)) - ln(1 - q), m the mean, and
// I2/J^2 - 3 + 2 ln J = 3 (b - 1 - ln b) - 2 ln(1 - q) - p b.
fn psi(s: Strain) -> real {
    // -ln(1 - q)
    let l = s.q + less_logarithm(-s.q);
    let a = 1.0 + s.mean;
    let b = 1.0 / (a * (1.0 - s.q));
    let first = 3.0 * less_logarithm(s.mean) + l;
    let second = 3.0 * less_logarithm((a * s.q - s.mean) * b) + 2.0 * l - s.p * b;
    return 0.5 * g1 * first + 0.5 * g2 * second;
}

// (dW/dI1, dW/dI2, dW/dJ)
fn derivatives(i1: real, i2: real, j: real) -> vec3r {
    let r = 1.0 / j;
    let w2 = 0.5 * g2 * r * r;
    return vec3r(0.5 * g1, w2, r * (g2 - g1 - 2.0 * w2 * i2));
}

fn U(dilatation: real) -> real {
    return g0 * less_logarithm(dilatation);
}

fn dU(j: real) -> real {
    return g0 * (1.0 - 1.0 / j);
}

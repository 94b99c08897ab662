// W = g1/2 (J^-2/3 I1 - 3) + g2/2 (J^-4/3 I2 - 3), U = g0/2 (J - 1)^2 (eq. 5);
// twin of src/physics/material/mooney_rivlin.rs.

override g0: real;
override g1: real;
override g2: real;

fn psi(s: Strain) -> real {
    return 0.5 * g1 * isochoric_i1(s) + 0.5 * g2 * isochoric_i2(s);
}

// (dW/dI1, dW/dI2, dW/dJ)
fn derivatives(i1: real, i2: real, j: real) -> vec3r {
    let r = recip_cbrt(j);
    let r2 = r * r;
    let w1 = 0.5 * g1 * r2;
    let w2 = 0.5 * g2 * r2 * r2;
    return vec3r(w1, w2, -(w1 * i1 + 2.0 * w2 * i2) * 0.6666666666666667 * (r2 * r));
}

fn U(dilatation: real) -> real {
    return 0.5 * g0 * dilatation * dilatation;
}

fn dU(j: real) -> real {
    return g0 * (j - 1.0);
}

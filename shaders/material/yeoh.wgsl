// W = C10 (I - 3) + C20 (I - 3)^2 + C30 (I - 3)^3 with I = J^-2/3 I1, U = kappa/2 (J - 1)^2;
// twin of src/physics/material/yeoh.rs.

override c10: real;
override c20: real;
override c30: real;
override bulk_modulus: real;

fn psi(s: Strain) -> real {
    let e = isochoric_i1(s);
    return ((c30 * e + c20) * e + c10) * e;
}

// (dW/dI1, dW/dI2, dW/dJ)
fn derivatives(i1: real, i2: real, j: real) -> vec3r {
    let r = recip_cbrt(j);
    let r2 = r * r;
    let e = r2 * i1 - 3.0;
    let w1 = ((3.0 * c30 * e + 2.0 * c20) * e + c10) * r2;
    return vec3r(w1, 0.0, w1 * i1 * (r2 * r) * -0.6666666666666667);
}

fn U(dilatation: real) -> real {
    return 0.5 * bulk_modulus * dilatation * dilatation;
}

fn dU(j: real) -> real {
    return bulk_modulus * (j - 1.0);
}

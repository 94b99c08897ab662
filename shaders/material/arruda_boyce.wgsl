// W = mu sum c_i lambda_m^(2-2i) (I^i - 3^i) with I = J^-2/3 I1 and five terms, U = kappa/2 ((J^2 - 1)/2 - ln J);
// twin of src/physics/material/arruda_boyce.rs.

override mu: real;
override lambda_m: real;
override bulk_modulus: real;

// lambda_m^-2
fn limit() -> real {
    return 1.0 / (lambda_m * lambda_m);
}

// I^i - 3^i = (I - 3) h_i with h_1 = 1, h_(i+1) = I h_i + 3^i.
fn psi(s: Strain) -> real {
    let b = limit();
    let e = isochoric_i1(s);
    let i = 3.0 + e;
    let h2 = 3.0 + i;
    let h3 = 9.0 + i * h2;
    let h4 = 27.0 + i * h3;
    let h5 = 81.0 + i * h4;
    let high = 0.010476190476190476 * h3 + b * (0.0027142857142857143 * h4 + b * 0.0007703153988868275 * h5);
    return mu * e * (0.5 + b * (0.05 * h2 + b * high));
}

// (dW/dI1, dW/dI2, dW/dJ)
fn derivatives(i1: real, i2: real, j: real) -> vec3r {
    let r = recip_cbrt(j);
    let r2 = r * r;
    let x = r2 * i1 * limit();
    let high = 0.03142857142857143 + x * (0.010857142857142857 + x * 0.0038515769944341374);
    let w1 = mu * (0.5 + x * (0.1 + x * high)) * r2;
    return vec3r(w1, 0.0, w1 * i1 * (r2 * r) * -0.6666666666666667);
}

fn U(dilatation: real) -> real {
    return 0.5 * bulk_modulus * (0.5 * dilatation * dilatation + less_logarithm(dilatation));
}

fn dU(j: real) -> real {
    return 0.5 * bulk_modulus * (j - 1.0) * (j + 1.0) / j;
}

// W = sum 2 mu_k / alpha_k^2 (l_1^alpha_k + l_2^alpha_k + l_3^alpha_k - 3) of the stretches over J^1/3, U = kappa/2 (J - 1)^2;
// twin of src/physics/material/ogden.rs.

override mu1: real;
override alpha1: real;
override mu2: real;
override alpha2: real;
override mu3: real;
override alpha3: real;
override bulk_modulus: real;

fn stored(x: Deviator, mu: real, alpha: real) -> real {
    if mu == 0.0 {
        return 0.0;
    }
    return 2.0 * mu / (alpha * alpha) * power_trace(x, stretch_power(x, alpha));
}

// Two steps: small strains ask for digits that the principal stretches have lost.
fn psi(s: Strain) -> real {
    let i1 = isochoric_i1(s);
    let i2 = isochoric_i2(s);
    let x = nearer_deviator(nearer_deviator(rough_deviator(i1, i2), i1, i2), i1, i2);
    return stored(x, mu1, alpha1) + stored(x, mu2, alpha2) + stored(x, mu3, alpha3);
}

// What a term adds to the slopes along P and Q.
fn slopes(x: Deviator, mu: real, alpha: real) -> vec2r {
    if mu == 0.0 {
        return vec2r(0.0, 0.0);
    }
    return 2.0 * mu / alpha * stretch_power(x, alpha).yz;
}

// (dW/dI1, dW/dI2, dW/dJ)
fn derivatives(i1: real, i2: real, j: real) -> vec3r {
    let r = recip_cbrt(j);
    let r2 = r * r;
    let e1 = r2 * i1 - 3.0;
    let e2 = (r2 * r2) * i2 - 3.0;
    let x = nearer_deviator(rough_deviator(e1, e2), e1, e2);
    let by = slopes(x, mu1, alpha1) + slopes(x, mu2, alpha2) + slopes(x, mu3, alpha3);
    let w = by_invariants(x, by);
    let w1 = w.x * r2;
    let w2 = w.y * (r2 * r2);
    return vec3r(w1, w2, -(w1 * i1 + 2.0 * w2 * i2) * 0.6666666666666667 * (r2 * r));
}

fn U(dilatation: real) -> real {
    return 0.5 * bulk_modulus * dilatation * dilatation;
}

fn dU(j: real) -> real {
    return bulk_modulus * (j - 1.0);
}

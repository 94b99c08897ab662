// W = g1/2 (J^-2/3 I1 - 3), U = g0/2 (J - 1)^2; twin of src/physics/material/neo_hookean.rs.

override g0: f32;
override g1: f32;

fn psi(i1: f32, i2: f32, j: f32) -> f32 {
    let r = recip_cbrt(j);
    return 0.5 * g1 * (r * r * i1 - 3.0);
}

// (dW/dI1, dW/dI2, dW/dJ)
fn first_piola(i1: f32, i2: f32, j: f32) -> vec3f {
    let r = recip_cbrt(j);
    let w1 = 0.5 * g1 * r * r;
    return vec3f(w1, 0.0, -(w1 * i1 * (r * r * r)) * 0.6666667);
}

fn U(j: f32) -> f32 {
    return 0.5 * g0 * (j - 1.0) * (j - 1.0);
}

fn dU(j: f32) -> f32 {
    return g0 * (j - 1.0);
}

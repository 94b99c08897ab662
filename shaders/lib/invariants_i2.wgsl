// Force matrix of a law that depends on I1, I2 and J.

struct Kinematics { am: mat3x3f, gram_m: mat3x3f, i1: f32, i2: f32 }

// m = diagonal, o = (xy, xz, yz) of M.
fn kinematics(a: mat3x3f, m: vec3f, o: vec3f) -> Kinematics {
    let am = mat3x3f(
        a[0] * m.x + a[1] * o.x + a[2] * o.y,
        a[0] * o.x + a[1] * m.y + a[2] * o.z,
        a[0] * o.y + a[1] * o.z + a[2] * m.z);
    let n = transpose(a) * am;
    let i1 = n[0][0] + n[1][1] + n[2][2];
    let trace_c2 = n[0][0] * n[0][0] + n[1][1] * n[1][1] + n[2][2] * n[2][2]
        + 2.0 * (n[0][1] * n[1][0] + n[0][2] * n[2][0] + n[1][2] * n[2][1]);
    return Kinematics(am, n, i1, 0.5 * (i1 * i1 - trace_c2));
}

// d = (W1, W2, WJ) of the law.
fn force_matrix(a: mat3x3f, k: Kinematics, d: vec3f, pressure: f32, cof: mat3x3f, det_j0: f32) -> mat3x3f {
    let c2 = 2.0 * det_j0 * d.y;
    let c1 = 2.0 * det_j0 * d.x + c2 * k.i1;
    return k.am * c1 - (k.am * k.gram_m) * c2 + cof * (d.z + pressure);
}

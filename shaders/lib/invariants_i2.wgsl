// Force matrix of a law that depends on I1, I2 and J.

struct Kinematics { am: mat3x3r, gram_m: mat3x3r, i1: real, i2: real }

// m = diagonal, o = (xy, xz, yz) of M.
fn kinematics(a: mat3x3r, m: vec3r, o: vec3r) -> Kinematics {
    let am = mat3x3r(
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
fn force_matrix(a: mat3x3r, k: Kinematics, d: vec3r, pressure: real, cof: mat3x3r, det_j0: real) -> mat3x3r {
    let c2 = 2.0 * det_j0 * d.y;
    let c1 = 2.0 * det_j0 * d.x + c2 * k.i1;
    return k.am * c1 - (k.am * k.gram_m) * c2 + cof * (d.z + pressure);
}

// Force matrix of a law that depends on I1 and J only.

struct Kinematics { am: mat3x3r, i1: real, i2: real }

// m = diagonal, o = (xy, xz, yz) of M.
fn kinematics(a: mat3x3r, m: vec3r, o: vec3r) -> Kinematics {
    let am = mat3x3r(
        a[0] * m.x + a[1] * o.x + a[2] * o.y,
        a[0] * o.x + a[1] * m.y + a[2] * o.z,
        a[0] * o.y + a[1] * o.z + a[2] * m.z);
    return Kinematics(am, dot(a[0], am[0]) + dot(a[1], am[1]) + dot(a[2], am[2]), 0.0);
}

// d = (W1, W2, WJ) of the law.
fn force_matrix(a: mat3x3r, k: Kinematics, d: vec3r, pressure: real, cof: mat3x3r, det_j0: real) -> mat3x3r {
    return k.am * (2.0 * det_j0 * d.x) + cof * (d.z + pressure);
}

// Force matrix of a law that depends on I1 and J only.

struct Kinematics { am: mat3x3f, i1: f32, i2: f32 }

// m = diagonal, o = (xy, xz, yz) of M.
fn kinematics(a: mat3x3f, m: vec3f, o: vec3f) -> Kinematics {
    let am = mat3x3f(
        a[0] * m.x + a[1] * o.x + a[2] * o.y,
        a[0] * o.x + a[1] * m.y + a[2] * o.z,
        a[0] * o.y + a[1] * o.z + a[2] * m.z);
    return Kinematics(am, dot(a[0], am[0]) + dot(a[1], am[1]) + dot(a[2], am[2]), 0.0);
}

// d = (W1, W2, WJ) of the law.
fn force_matrix(a: mat3x3f, k: Kinematics, d: vec3f, pressure: f32, cof: mat3x3f, det_j0: f32) -> mat3x3f {
    return k.am * (2.0 * det_j0 * d.x) + cof * (d.z + pressure);
}

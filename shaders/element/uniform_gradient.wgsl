// Volume-averaged gradients and hourglass stiffness; twin of src/physics/element/uniform_gradient.rs.

fn outer_sum(f: mat3x3r, u: vec3r, b: vec4r) -> mat3x3r {
    return mat3x3r(f[0] + u * b.x, f[1] + u * b.y, f[2] + u * b.z);
}

// Mean gradient and hourglass modes of a field from its differences u_a = x_a - x_0, a = 1..7 (u.a0 is not read).
fn modes(u: Corners, shape: u32) -> Modes {
    var f = mat3x3r(u.a1 * classes[shape].gradient[1].x, u.a1 * classes[shape].gradient[1].y, u.a1 * classes[shape].gradient[1].z);
    f = outer_sum(f, u.a2, classes[shape].gradient[2]);
    f = outer_sum(f, u.a3, classes[shape].gradient[3]);
    f = outer_sum(f, u.a4, classes[shape].gradient[4]);
    f = outer_sum(f, u.a5, classes[shape].gradient[5]);
    f = outer_sum(f, u.a6, classes[shape].gradient[6]);
    f = outer_sum(f, u.a7, classes[shape].gradient[7]);
    return Modes(
        f,
        u.a1 - u.a2 - u.a3 - u.a4 - u.a5 + u.a6 + u.a7 - f * classes[shape].gamma_x[0].xyz,
        -u.a1 - u.a2 + u.a3 - u.a4 + u.a5 + u.a6 - u.a7 - f * classes[shape].gamma_x[1].xyz,
        -u.a1 + u.a2 - u.a3 + u.a4 - u.a5 + u.a6 - u.a7 - f * classes[shape].gamma_x[2].xyz,
        u.a1 - u.a2 + u.a3 + u.a4 - u.a5 + u.a6 - u.a7 - f * classes[shape].gamma_x[3].xyz);
}

fn less_outer(p: mat3x3r, r: vec3r, g: vec4r) -> mat3x3r {
    return mat3x3r(p[0] - r * g.x, p[1] - r * g.y, p[2] - r * g.z);
}

// f_a = (V P - sum_h r_h (x) Gamma_h . X) b_a + sum_h r_h Gamma_h,a
fn corner_forces(stress: mat3x3r, r: Modes, shape: u32) -> Corners {
    var p = stress * classes[shape].volume;
    p = less_outer(p, r.h0, classes[shape].gamma_x[0]);
    p = less_outer(p, r.h1, classes[shape].gamma_x[1]);
    p = less_outer(p, r.h2, classes[shape].gamma_x[2]);
    p = less_outer(p, r.h3, classes[shape].gamma_x[3]);
    return Corners(
        p * classes[shape].gradient[0].xyz + (r.h0 + r.h1 + r.h2 - r.h3),
        p * classes[shape].gradient[1].xyz + (r.h0 - r.h1 - r.h2 + r.h3),
        p * classes[shape].gradient[2].xyz + (-r.h0 - r.h1 + r.h2 - r.h3),
        p * classes[shape].gradient[3].xyz + (-r.h0 + r.h1 - r.h2 + r.h3),
        p * classes[shape].gradient[4].xyz + (-r.h0 - r.h1 + r.h2 + r.h3),
        p * classes[shape].gradient[5].xyz + (-r.h0 + r.h1 - r.h2 - r.h3),
        p * classes[shape].gradient[6].xyz + (r.h0 + r.h1 + r.h2 + r.h3),
        p * classes[shape].gradient[7].xyz + (r.h0 - r.h1 - r.h2 - r.h3));
}

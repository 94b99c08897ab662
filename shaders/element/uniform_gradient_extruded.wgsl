// Mean gradient and hourglass modes of plane figures extruded along eta, in the patterns of the corners' signs; twin of
// ExtrudedUniformGradient in src/physics/element/uniform_gradient.rs.

// Mean gradient along the element's own axes and hourglass modes of a field from its differences u_a = x_a - x_0, a = 1..7.
fn modes(u: Corners, shape: u32) -> Modes {
    let in_plane = classes[shape].in_plane;
    let along = classes[shape].along;
    let bend = classes[shape].bend;
    // Edges along xi at the four signs of (eta, zeta).
    let e0 = u.a1;
    let e1 = u.a2 - u.a3;
    let e2 = u.a5 - u.a4;
    let e3 = u.a6 - u.a7;
    let sum_low = e0 + e1;
    let sum_high = e2 + e3;
    let turn_low = e1 - e0;
    let turn_high = e3 - e2;
    let xi = sum_low + sum_high;
    let xi_zeta = sum_high - sum_low;
    let xi_eta = turn_low + turn_high;
    let xi_eta_zeta = turn_high - turn_low;
    // The other edge along eta follows from the two along xi beside it.
    let eta_low = 2.0 * u.a3 + turn_low;
    let eta_high = 2.0 * (u.a7 - u.a4) + turn_high;
    let eta = eta_low + eta_high;
    let eta_zeta = eta_high - eta_low;
    let zeta_low = 2.0 * u.a4 + (e2 - e0);
    let zeta = 2.0 * zeta_low + eta_zeta;
    let f = mat3x3r(
        zeta * in_plane.z + xi * in_plane.x,
        eta_zeta * along.z + xi_eta * along.y + eta * along.x,
        zeta * in_plane.w + xi * in_plane.y);
    return Modes(f, eta_zeta, xi_zeta - f[2] * bend.y - f[0] * bend.x, xi_eta, xi_eta_zeta);
}

// Corner forces from the mean first Piola stress and the hourglass forces.
fn corner_forces(stress: mat3x3r, r: Modes, shape: u32) -> Corners {
    let in_plane = classes[shape].in_plane;
    let along = classes[shape].along;
    let bend = classes[shape].bend;
    let volume = classes[shape].volume;
    let p0 = stress[0] * volume - r.h1 * bend.x;
    let p1 = stress[1] * volume;
    let p2 = stress[2] * volume - r.h1 * bend.y;
    // Forces by pattern; even and odd in eta.
    let xi = p2 * in_plane.y + p0 * in_plane.x;
    let zeta = p2 * in_plane.w + p0 * in_plane.z;
    let eta = p1 * along.x;
    let xi_eta = p1 * along.y + r.h2;
    let eta_zeta = p1 * along.z + r.h0;
    let sum = xi + zeta;
    let difference = xi - zeta;
    let even0 = r.h1 - sum;
    let even1 = difference - r.h1;
    let even2 = sum + r.h1;
    let even3 = -difference - r.h1;
    let a = eta - eta_zeta;
    let b = eta + eta_zeta;
    let s = xi_eta - r.h3;
    let t = xi_eta + r.h3;
    let odd0 = a - s;
    let odd1 = a + s;
    let odd2 = b + t;
    let odd3 = b - t;
    return Corners(
        even0 - odd0, even1 - odd1, even1 + odd1, even0 + odd0, even3 - odd3, even2 - odd2, even2 + odd2, even3 + odd3);
}

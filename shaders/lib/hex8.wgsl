// Gradients at the 2x2x2 Gauss points by sum factorisation; twin of src/physics/element/hex8.rs.
// Everything is named and passed by value: arrays indexed in a loop would live in memory.

const NEAR: real = 0.7886751345948129; // (1 + 1/sqrt 3)/2
const FAR: real = 0.2113248654051871;

// Values on the four edges, or the four Gauss lines, of one direction; index = sign bits of the other two.
struct Four { a: vec3r, b: vec3r, c: vec3r, d: vec3r }

// One Four for each of xi, eta, zeta.
struct Columns { xi: Four, eta: Four, zeta: Four }

struct Corners { a0: vec3r, a1: vec3r, a2: vec3r, a3: vec3r, a4: vec3r, a5: vec3r, a6: vec3r, a7: vec3r }

fn interpolate(e: Four) -> Four {
    let a0 = e.a * NEAR + e.b * FAR;
    let a1 = e.b * NEAR + e.a * FAR;
    let b0 = e.c * NEAR + e.d * FAR;
    let b1 = e.d * NEAR + e.c * FAR;
    return Four(a0 * NEAR + b0 * FAR, a1 * NEAR + b1 * FAR, b0 * NEAR + a0 * FAR, b1 * NEAR + a1 * FAR);
}

// Half edge differences to A on the Gauss lines.
fn gradients(edges: Columns) -> Columns {
    return Columns(interpolate(edges.xi), interpolate(edges.eta), interpolate(edges.zeta));
}

// Half edge differences of a field given at the corners.
fn half_edges(x: Corners) -> Columns {
    return Columns(
        Four(0.5 * (x.a1 - x.a0), 0.5 * (x.a2 - x.a3), 0.5 * (x.a5 - x.a4), 0.5 * (x.a6 - x.a7)),
        Four(0.5 * (x.a3 - x.a0), 0.5 * (x.a2 - x.a1), 0.5 * (x.a7 - x.a4), 0.5 * (x.a6 - x.a5)),
        Four(0.5 * (x.a4 - x.a0), 0.5 * (x.a5 - x.a1), 0.5 * (x.a7 - x.a3), 0.5 * (x.a6 - x.a2)));
}

fn cofactor(a: mat3x3r) -> mat3x3r {
    return mat3x3r(cross(a[1], a[2]), cross(a[2], a[0]), cross(a[0], a[1]));
}

// Corner forces from the force matrices summed on the Gauss lines.
fn scatter(lines: Columns) -> Corners {
    let x = interpolate(lines.xi);
    let y = interpolate(lines.eta);
    let z = interpolate(lines.zeta);
    return Corners(
        0.5 * (-x.a - y.a - z.a), 0.5 * (x.a - y.b - z.b), 0.5 * (x.b + y.b - z.d), 0.5 * (-x.b + y.a - z.c),
        0.5 * (-x.c - y.c + z.a), 0.5 * (x.c - y.d + z.b), 0.5 * (x.d + y.d + z.d), 0.5 * (-x.d + y.c + z.c));
}

// Gradients at the 2x2x2 Gauss points by sum factorisation; twin of src/physics/element/hex8.rs, whose element coordinates
// these are. Everything is named and passed by value: arrays indexed in a loop would live in memory.

// What the far edge counts at a Gauss line over what the near one does: 2 - sqrt 3.
const FAR: real = 0.2679491924311228;
// The volume that a Gauss point stands for in element coordinates.
const WEIGHT: real = 0.030081459556442793;

// Values on the four edges, or the four Gauss lines, of one direction; index = sign bits of the other two.
struct Four { a: vec3r, b: vec3r, c: vec3r, d: vec3r }

// One Four for each of xi, eta, zeta.
struct Columns { xi: Four, eta: Four, zeta: Four }

struct Corners { a0: vec3r, a1: vec3r, a2: vec3r, a3: vec3r, a4: vec3r, a5: vec3r, a6: vec3r, a7: vec3r }

// (1 + FAR)^2 times the values on four Gauss lines from values on four edges.
fn interpolate(e: Four) -> Four {
    let a0 = e.a + e.b * FAR;
    let a1 = e.b + e.a * FAR;
    let b0 = e.c + e.d * FAR;
    let b1 = e.d + e.c * FAR;
    return Four(a0 + b0 * FAR, a1 + b1 * FAR, b0 + a0 * FAR, b1 + a1 * FAR);
}

// Edge differences to A on the Gauss lines.
fn gradients(edges: Columns) -> Columns {
    return Columns(interpolate(edges.xi), interpolate(edges.eta), interpolate(edges.zeta));
}

// Edge differences of a field given at the corners.
fn edges(x: Corners) -> Columns {
    return Columns(
        Four(x.a1 - x.a0, x.a2 - x.a3, x.a5 - x.a4, x.a6 - x.a7),
        Four(x.a3 - x.a0, x.a2 - x.a1, x.a7 - x.a4, x.a6 - x.a5),
        Four(x.a4 - x.a0, x.a5 - x.a1, x.a7 - x.a3, x.a6 - x.a2));
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
        -x.a - y.a - z.a, x.a - y.b - z.b, x.b + y.b - z.d, -x.b + y.a - z.c,
        -x.c - y.c + z.a, x.c - y.d + z.b, x.d + y.d + z.d, -x.d + y.c + z.c);
}

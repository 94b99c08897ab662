// Symmetric matrices.

// Diagonal, and xy, xz, yz.
struct Sym { d: vec3r, o: vec3r }

fn full(s: Sym) -> mat3x3r {
    return mat3x3r(vec3r(s.d.x, s.o.x, s.o.y), vec3r(s.o.x, s.d.y, s.o.z), vec3r(s.o.y, s.o.z, s.d.z));
}

// A^T A
fn gram(a: mat3x3r) -> Sym {
    return Sym(
        vec3r(dot(a[0], a[0]), dot(a[1], a[1]), dot(a[2], a[2])),
        vec3r(dot(a[0], a[1]), dot(a[0], a[2]), dot(a[1], a[2])));
}

// Inverse of a symmetric positive matrix, scaled so that no product of its entries overflows.
fn inverse_of(m: mat3x3r) -> mat3x3r {
    let scale = 1.0 / (m[0][0] + m[1][1] + m[2][2]);
    let scaled = m * scale;
    let c = cofactor(scaled);
    return c * (scale / dot(scaled[0], c[0]));
}

// Second Piola stress of a law that depends on I1 and J only; twin of src/physics/element/hex8.rs.

struct Invariants { i1: real, i2: real }

fn invariants(m: Sym, g: Sym) -> Invariants {
    return Invariants(contracted(m, g), 0.0);
}

// 2 dv W1 M; d = (W1, W2, WJ) of the law.
fn second_piola(k: Invariants, d: vec3r, m: Sym, dv: real) -> Sym {
    let c = 2.0 * dv * d.x;
    return Sym(m.d * c, m.o * c);
}

// F S where M is the identity.
fn times(f: mat3x3r, s: Sym) -> mat3x3r {
    return mat3x3r(f[0] * s.d.x, f[1] * s.d.y, f[2] * s.d.z);
}

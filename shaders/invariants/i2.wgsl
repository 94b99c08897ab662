// Second Piola stress of a law that depends on I1, I2 and J; twin of src/physics/element/hex8.rs.

struct Invariants { i1: real, i2: real, square: Sym }

// tr C^2 = G : M G M
fn invariants(m: Sym, g: Sym) -> Invariants {
    let i1 = contracted(m, g);
    let square = around(m, g);
    let trace_c2 = dot(square.d, g.d) + 2.0 * dot(square.o, g.o);
    return Invariants(i1, 0.5 * (i1 * i1 - trace_c2), square);
}

// dv (2 W1 M + 2 W2 (I1 M - M G M)); d = (W1, W2, WJ) of the law.
fn second_piola(k: Invariants, d: vec3r, m: Sym, dv: real) -> Sym {
    let c2 = 2.0 * dv * d.y;
    let c1 = 2.0 * dv * d.x + c2 * k.i1;
    return Sym(m.d * c1 - k.square.d * c2, m.o * c1 - k.square.o * c2);
}

// F S
fn times(f: mat3x3r, s: Sym) -> mat3x3r {
    return f * full(s);
}

// Any metric M, its entries off the diagonal in the order xy, xz, yz.

// M : G
fn contracted(m: Sym, g: Sym) -> real {
    return dot(m.d, g.d) + 2.0 * dot(m.o, g.o);
}

// M G M
fn around(m: Sym, g: Sym) -> Sym {
    let k = full(m);
    let n = full(g) * k;
    return Sym(vec3r(dot(k[0], n[0]), dot(k[1], n[1]), dot(k[2], n[2])), vec3r(dot(k[0], n[1]), dot(k[0], n[2]), dot(k[1], n[2])));
}

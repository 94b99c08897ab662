// A metric M that couples eta with neither xi nor zeta: its xy and yz are not read.

// M : G
fn contracted(m: Sym, g: Sym) -> real {
    return dot(m.d, g.d) + 2.0 * (m.o.y * g.o.y);
}

// M G M
fn around(m: Sym, g: Sym) -> Sym {
    let to_xi = vec2r(m.d.x, m.o.y);
    let to_zeta = vec2r(m.o.y, m.d.z);
    let x = vec2r(g.d.x, g.o.y);
    let y = vec2r(g.o.x, g.o.z);
    let z = vec2r(g.o.y, g.d.z);
    // Columns xi and zeta of G M.
    let xi = vec2r(dot(x, to_xi), dot(z, to_xi));
    let zeta = vec2r(dot(x, to_zeta), dot(z, to_zeta));
    return Sym(
        vec3r(dot(to_xi, xi), m.d.y * m.d.y * g.d.y, dot(to_zeta, zeta)),
        vec3r(m.d.y * dot(y, to_xi), dot(to_xi, zeta), m.d.y * dot(y, to_zeta)));
}

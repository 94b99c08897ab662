// What S adds to a Gauss line from the other columns of A.

fn coupled_xi(sum: vec3r, a: mat3x3r, s: Sym) -> vec3r {
    return sum + a[1] * s.o.x + a[2] * s.o.y;
}

fn coupled_eta(sum: vec3r, a: mat3x3r, s: Sym) -> vec3r {
    return sum + a[0] * s.o.x + a[2] * s.o.z;
}

fn coupled_zeta(sum: vec3r, a: mat3x3r, s: Sym) -> vec3r {
    return sum + a[0] * s.o.y + a[1] * s.o.z;
}

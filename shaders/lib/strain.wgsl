// What stored energies need of C = F^T F, with the digits that C itself and its invariants do not have where strains are small:
// everything follows from T = C - I without cancellation.

// With a = 1 + mean and the deviator D of T: det C = a^3 (1 - q).
struct Strain {
    // tr T / 3
    mean: real,
    // tr D^2 / (2 a^2)
    p: real,
    // p - det D / a^3
    q: real,
    // J - 1
    dilatation: real,
}

fn strain_of(t: mat3x3r) -> Strain {
    let mean = 0.3333333333333333 * (t[0][0] + t[1][1] + t[2][2]);
    let a = 1.0 + mean;
    let d = mat3x3r(t[0] - vec3r(mean, 0.0, 0.0), t[1] - vec3r(0.0, mean, 0.0), t[2] - vec3r(0.0, 0.0, mean));
    let square = d[0][0] * d[0][0] + d[1][1] * d[1][1] + d[2][2] * d[2][2]
        + 2.0 * (d[0][1] * d[1][0] + d[0][2] * d[2][0] + d[1][2] * d[2][1]);
    let p = 0.5 * square / (a * a);
    let cube = a * a * a;
    let q = p - determinant(d) / cube;
    // det C - 1
    let more = 3.0 * mean * (1.0 + mean + 0.3333333333333333 * mean * mean) - cube * q;
    return Strain(mean, p, q, more / (1.0 + sqrt(1.0 + more)));
}

// J^-2/3 I1 - 3 = 3 ((1 - q)^-1/3 - 1)
fn isochoric_i1(s: Strain) -> real {
    let r = recip_cbrt(1.0 - s.q);
    return 3.0 * s.q / ((1.0 - s.q) * (r * r + r + 1.0));
}

// J^-4/3 I2 - 3 = (3 - p) (1 - q)^-2/3 - 3
fn isochoric_i2(s: Strain) -> real {
    let r = recip_cbrt(1.0 - s.q);
    return isochoric_i1(s) * (r + 1.0) - s.p * (r * r);
}

// x - ln(1 + x), for small x by the series of 2 artanh(x / (2 + x)), whose first six terms leave 1e-16 of x^2.
fn less_logarithm(x: real) -> real {
    if abs(x) > 0.1 {
        return x - logarithm(1.0 + x);
    }
    let s = x / (2.0 + x);
    let s2 = s * s;
    let series = 0.3333333333333333 + s2 * (0.2 + s2 * (0.14285714285714285 + s2 * (0.1111111111111111
        + s2 * (0.09090909090909091 + s2 * 0.07692307692307693))));
    return s * (x - 2.0 * s2 * series);
}

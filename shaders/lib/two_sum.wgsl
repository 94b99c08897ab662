struct Pair { hi: vec3f, lo: vec3f }

// The same number, behind a door that no compiler can see through: `zero` is 0, but only at run time.
fn opaque(x: vec3f, zero: u32) -> vec3f {
    return bitcast<vec3f>(bitcast<vec3u>(x) ^ vec3u(zero));
}

// a + b as rounded sum and its error (Knuth). WGSL allows (a + b) - a = b, and software adapters do it; hence the
// doors. Whether the rest is rounded as it must be is checked on the adapter at the start.
fn two_sum(a: vec3f, b: vec3f, zero: u32) -> Pair {
    let s = opaque(a + b, zero);
    let t = opaque(s - a, zero);
    let u = opaque(s - t, zero);
    return Pair(s, (a - u) + (b - t));
}

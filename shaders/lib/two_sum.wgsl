struct Pair { hi: vec3f, lo: vec3f }

// a + b as rounded sum and its error (Knuth): an error-free transform where the adapter rounds correctly, which is
// checked at the start.
fn two_sum(a: vec3f, b: vec3f) -> Pair {
    let s = a + b;
    let t = s - a;
    return Pair(s, (a - (s - t)) + (b - t));
}

// What an element pass says of elements that fail, and what it hands from one element of a chain to the next.

// First failing step, then the smallest failing element of that step (doubled, odd: not finite).
// Steps come in order, so whoever finds an earlier step there leaves it alone.
fn report(element: u32, finite: bool) {
    let first = of_flags();
    let before = atomicMin(&failure[first], step.index);
    if before >= step.index {
        atomicMin(&failure[first + 1u], 2u * element + select(1u, 0u, finite));
    }
}

// WGSL may assume there are no NaNs, and min() may drop one: the bits decide.
fn is_sound(result: ElementForce) -> bool {
    let f = result.f;
    let sum = f.a0 + f.a1 + f.a2 + f.a3 + f.a4 + f.a5 + f.a6;
    return is_finite(dot(sum, vec3r(1.0))) && is_finite(result.min_j);
}

// Forces on the face between two elements.
struct Shared { a: vec3r, b: vec3r, c: vec3r, d: vec3r }

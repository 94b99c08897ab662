// Works of the window beside the internal one: body force, damping [J]. The next window begins with none.

@group(0) @binding(9) var<storage, read_write> works: array<vec2r>;

fn take_others(n: u32) -> vec2r {
    let sum = works[n];
    works[n] = vec2r(0.0);
    return sum;
}

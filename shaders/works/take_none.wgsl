fn take_others(n: u32) -> vec2r {
    return vec2r(0.0);
}

fn take_others(n: u32) -> vec2f {
    return vec2f(0.0);
}

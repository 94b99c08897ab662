fn landing(x: Pair, touches: u32) -> vec3r {
    return vec3r(0.0);
}

fn landing(x: Pair, touches: u32) -> vec3f {
    return vec3f(0.0);
}

fn moving(n: u32, f: vec3f) -> vec3f {
    return f;
}

// Every component is free.

fn moving(n: u32, f: vec3r) -> vec3r {
    return f;
}

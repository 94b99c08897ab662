// No work but the internal one.

fn book_others(n: u32, node: Node, v: vec3r, after: vec3r, way: vec3r, rim: bool) {}

fn take_others(n: u32) -> vec2r {
    return vec2r(0.0);
}

// No road to touch.

fn touched(node: Node, x: vec3r, v: vec3r, v_star: vec3r) -> Moved {
    return unconstrained(x, v_star);
}

fn book_contact(role: u32, moved: Moved, way: vec3r) -> vec4r {
    return vec4r(0.0);
}

fn landing(x: Pair, touches: u32) -> vec3r {
    return vec3r(0.0);
}

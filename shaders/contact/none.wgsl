fn touched(node: Node, x: vec3r, v: vec3r, v_star: vec3r) -> Moved {
    return unconstrained(x, v_star);
}

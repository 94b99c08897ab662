fn touched(node: Node, x: vec3f, v: vec3f, v_star: vec3f) -> Moved {
    return unconstrained(x, v_star);
}

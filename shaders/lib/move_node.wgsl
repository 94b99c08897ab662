// One node, one step: where it goes, and which forces took it there.

struct Moved {
    x: vec3f,
    v: vec3f,
    // Road's force [N]: along the normal, in the plane; touches: 0 free, 1 slides, 2 sticks.
    normal_force: vec3f,
    tangential_force: vec3f,
    touches: u32,
}

fn unconstrained(x: vec3f, v: vec3f) -> Moved {
    return Moved(x + step.dt * v, v, vec3f(0.0), vec3f(0.0), 0u);
}

fn move_node(node: Node, f_int: vec3f, x: vec3f, v: vec3f) -> Moved {
    if is_rim(node.role) {
        return carried(node.role & 0x7fffffffu);
    }
    return touched(node, x, v, predict(node.mass, f_int, v));
}

// One node, one step: where it goes, and which forces took it there.

struct Moved {
    x: vec3r,
    v: vec3r,
    // Road's force [N]: along the normal, in the plane; touches: 0 free, 1 slides, 2 sticks.
    normal_force: vec3r,
    tangential_force: vec3r,
    touches: u32,
}

fn unconstrained(x: vec3r, v: vec3r) -> Moved {
    return Moved(x + step.dt * v, v, vec3r(0.0), vec3r(0.0), 0u);
}

// Whatever holds a component takes gravity along it too.
fn move_node(n: u32, node: Node, f_int: vec3r, x: vec3r, v: vec3r) -> Moved {
    if is_rim(node.role) {
        return carried(node.role & 0x7fffffffu);
    }
    return touched(node, x, v, moving(n, predict(node.mass, f_int, v)));
}

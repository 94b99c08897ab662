// One node, one step; its contact.
fn take_step(n: u32) -> vec4r {
    if is_left_out(n) {
        return vec4r(0.0);
    }
    let here = load_node(n);
    let node = node_of(n, here.w);
    let f_int = moving(n, gather(n));
    let x = here.xyz;
    // With the work of the internal force in this window.
    let before = velocities[of_nodes(n)];
    let v = before.xyz;
    let moved = move_node(n, node, f_int, x, v);
    let way = step.weight_before * v + step.weight_after * moved.v;
    let rim = is_rim(node.role);
    book_others(n, node, v, moved.v, way, rim);
    store_position(n, moved, rim, here.w);
    velocities[of_nodes(n)] = vec4r(moved.v, before.w - dot(f_int, way));
    if rim {
        book_rim(node, f_int, x, v, moved, way);
        return vec4r(0.0);
    }
    return book_contact(node.role, moved, way);
}

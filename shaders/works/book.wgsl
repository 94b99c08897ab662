// Works beside the internal one, by node: body force, damping [J].

fn book_others(n: u32, node: Node, v: vec3r, after: vec3r, way: vec3r, rim: bool) {
    let damping = damping_work(node.mass, v, after, way);
    works[of_nodes(n)] += vec2r(node.mass * dot(gravity(), way), select(damping, real(0.0), rim));
}

// Those of the window; the next one begins with none.
fn take_others(n: u32) -> vec2r {
    let sum = works[n];
    works[n] = vec2r(0.0);
    return sum;
}

// Works beside the internal one, by node: body force, damping [J].

@group(0) @binding(9) var<storage, read_write> works: array<vec2f>;

fn book_others(n: u32, node: Node, v: vec3f, after: vec3f, way: vec3f, rim: bool) {
    let damping = damping_work(node.mass, v, after, way);
    works[of_nodes(n)] += vec2f(node.mass * dot(gravity(), way), select(damping, 0.0, rim));
}

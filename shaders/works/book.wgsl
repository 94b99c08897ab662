// Works beside the internal one, by node: body force, damping [J].

@group(0) @binding(9) var<storage, read_write> works: array<vec2r>;

fn book_others(n: u32, node: Node, v: vec3r, after: vec3r, way: vec3r, rim: bool) {
    let damping = damping_work(node.mass, v, after, way);
    works[of_nodes(n)] += vec2r(node.mass * dot(gravity(), way), select(damping, real(0.0), rim));
}

// Impulse of the rim on the rubber, its moment about the axle, and the rim's work (its nodes' inertia included).

@group(0) @binding(6) var<storage, read_write> rim_sums: array<RimSum>;

fn rim_work(node: Node, f_int: vec3f, v: vec3f, moved: Moved, way: vec3f) -> f32 {
    let net = (node.mass / step.dtm) * (moved.v - v);
    return dot(net + f_int - node.mass * gravity(), way);
}

fn book_rim(node: Node, f_int: vec3f, x: vec3f, v: vec3f, moved: Moved, way: vec3f) {
    let k = of_rim(node.role & 0x7fffffffu);
    let impulse = step.dtm * f_int;
    rim_sums[k].impulse += vec4f(impulse, rim_work(node, f_int, v, moved, way));
    rim_sums[k].moment += vec4f(cross(x - rim_pose().before, impulse), 0.0);
}

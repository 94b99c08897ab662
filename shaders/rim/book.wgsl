// Impulse of the rim on the rubber, its moment about the axle, and the rim's work (its nodes' inertia included).

@group(0) @binding(6) var<storage, read_write> rim_sums: array<RimSum>;

fn rim_work(node: Node, f_int: vec3r, v: vec3r, moved: Moved, way: vec3r) -> real {
    let net = (node.mass / step.dtm) * (moved.v - v);
    return dot(net + f_int - node.mass * gravity(), way);
}

fn book_rim(node: Node, f_int: vec3r, x: vec3r, v: vec3r, moved: Moved, way: vec3r) {
    let k = of_rim(node.role & 0x7fffffffu);
    let impulse = step.dtm * f_int;
    rim_sums[k].impulse += vec4r(impulse, rim_work(node, f_int, v, moved, way));
    rim_sums[k].moment += vec4r(cross(x - rim_pose().before, impulse), 0.0);
}

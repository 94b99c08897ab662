// Rim nodes go where the rim puts them.

fn is_rim(role: u32) -> bool {
    return role != INTERIOR && (role & RIM) != 0u;
}

fn carried(k: u32) -> Moved {
    let arm = rim_arms[k].xyz;
    let pose = rim_pose();
    let x = pose.axle + pose.rotation * arm;
    let v = pose.velocity + pose.rate * arm;
    return Moved(x, v, vec3r(0.0), vec3r(0.0), 0u);
}

fn rim_work(node: Node, f_int: vec3r, v: vec3r, moved: Moved, way: vec3r) -> real {
    let net = (node.mass / step.dtm) * (moved.v - v);
    return dot(net + f_int - node.mass * gravity(), way);
}

// Impulse of the rim on the rubber, its moment about the axle, and the rim's work (its nodes' inertia included).
fn book_rim(node: Node, f_int: vec3r, x: vec3r, v: vec3r, moved: Moved, way: vec3r) {
    let k = of_rim(node.role & 0x7fffffffu);
    let impulse = step.dtm * f_int;
    rim_sums[k].impulse += vec4r(impulse, rim_work(node, f_int, v, moved, way));
    rim_sums[k].moment += vec4r(cross(x - rim_pose().before, impulse), 0.0);
}

// Rim nodes go where the rim puts them.

@group(0) @binding(4) var<storage, read> rim_arms: array<vec4r>;

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

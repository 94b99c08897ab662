// The step after a window, computed but not taken: what the stored energy pairs with.

@group(0) @binding(5) var<uniform> step: Step;
@group(0) @binding(9) var<storage, read_write> probes: array<ProbeRecord>;
@group(0) @binding(11) var<storage, read> velocities_now: array<vec4f>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let n = thread_index(group, groups, lane);
    if n >= arrayLength(&nodes) {
        return;
    }
    let node = nodes[n];
    let whole = gather(n);
    let f_int = moving(n, whole);
    let x = load_position(n);
    let v = velocities_now[n].xyz;
    let moved = move_node(node, f_int, x, v);
    // Works over the half step before.
    let way = step.weight_before * v;
    let net = (node.mass / step.dtm) * (moved.v - v);
    let rim = is_rim(node.role);
    let own = select(1.0, 0.0, rim);
    probes[n].energies = vec4f(
        0.5 * node.mass * dot(v, moved.v), 0.5 * node.mass * dot(v, v), own * dot(net, net), own * dot(whole, whole));
    probes[n].works = vec4f(
        -dot(f_int, way), node.mass * dot(gravity(), way), own * damping_work(node.mass, v, moved.v, way),
        (1.0 - own) * dot(net + f_int - node.mass * gravity(), way));
    probes[n].contact = vec4f(dot(moved.normal_force, way), dot(moved.tangential_force, way), 0.0, 0.0);
}

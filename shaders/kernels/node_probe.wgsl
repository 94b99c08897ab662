// The step after a window, computed but not taken: what the stored energy pairs with; and the window's works, which
// begin anew. Sums by work group: four records each.

// Energies (mixed kinetic, kinetic, net force^2, internal force^2); half works (internal, body force, damping, rim);
// half works of contact (normal, friction); works of the window (internal, body force, damping).
struct Probed { energies: vec4r, works: vec4r, contact: vec4r, window: vec4r }

fn probe(n: u32) -> Probed {
    let here = load_node(n);
    let node = node_of(n, here.w);
    let whole = gather(n);
    let f_int = moving(n, whole);
    let x = here.xyz;
    let before = velocities[n];
    let v = before.xyz;
    velocities[n] = vec4r(v, 0.0);
    let moved = move_node(n, node, f_int, x, v);
    // Works over the half step before.
    let way = step.weight_before * v;
    let net = (node.mass / step.dtm) * (moved.v - v);
    let rim = is_rim(node.role);
    let own = select(real(1.0), real(0.0), rim);
    let energies = vec4r(
        0.5 * node.mass * dot(v, moved.v), 0.5 * node.mass * dot(v, v), own * dot(net, net), own * dot(whole, whole));
    let works = vec4r(
        -dot(f_int, way), node.mass * dot(gravity(), way), own * damping_work(node.mass, v, moved.v, way),
        (1.0 - own) * dot(net + f_int - node.mass * gravity(), way));
    let contact = vec4r(dot(moved.normal_force, way), dot(moved.tangential_force, way), 0.0, 0.0);
    return Probed(energies, works, contact, vec4r(before.w, take_others(n), 0.0));
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let thread = thread_index(group, groups, lane);
    var probed = Probed();
    if thread < arrayLength(&roles) {
        probed = probe(thread);
    }
    let energies = group_sum(lane, probed.energies);
    let works = group_sum(lane, probed.works);
    let contact = group_sum(lane, probed.contact);
    let window = group_sum(lane, probed.window);
    let first = 4u * (thread / 64u);
    if lane == 0u && thread < arrayLength(&roles) {
        probes[first] = energies;
        probes[first + 1u] = works;
        probes[first + 2u] = contact;
        probes[first + 3u] = window;
    }
}

// Positions and velocities of the surface nodes, packed for reading back.

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let k = thread_index(group, groups, lane);
    if k >= arrayLength(&surface_nodes) {
        return;
    }
    surface_states[2u * k] = load_node(surface_nodes[k]);
    surface_states[2u * k + 1u] = velocities[surface_nodes[k]];
}

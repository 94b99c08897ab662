// State of the watched nodes after a step: position, velocity, and the road's impulse since the last sample.

// Node, and its number among those of the surface or, where it is none of them, a number that none has.
var<storage, read_write> watched_nodes: array<vec2u>;
// By step of a submission, then by watched node.
var<storage, read_write> watched_states: array<vec4r>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let k = thread_index(group, groups, lane);
    let count = arrayLength(&watched_nodes);
    if k >= count {
        return;
    }
    let watched = watched_nodes[k];
    let place = 3u * (step.slot * count + k);
    watched_states[place] = load_node(watched.x);
    watched_states[place + 1u] = velocities[watched.x];
    var impulse = vec4r(0.0);
    if watched.y < arrayLength(&surface_sums) {
        impulse = surface_sums[watched.y].impulse;
    }
    watched_states[place + 2u] = impulse;
}

// Gather, acceleration, contact projection, integration and book-keeping of nodes: the interior ones, or the rest.

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let thread = thread_index(group, groups, lane);
    var contact = vec4r(0.0);
    if thread < node_threads() {
        contact = take_step(node_at(thread));
    }
    sum_step(thread / 64u, lane, contact);
    // The last thing a submission does: the host looks for it.
    if thread == 0u {
        done[0] = step.index;
    }
}

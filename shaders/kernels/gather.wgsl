// Internal force of every node, for reading back.

var<storage, read_write> forces: array<vec4r>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let n = thread_index(group, groups, lane);
    if n >= arrayLength(&forces) {
        return;
    }
    forces[n] = vec4r(gather(n), 0.0);
}

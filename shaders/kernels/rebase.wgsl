// Moves the origin of the frame: positions less a shift that is a multiple of a power of two.

var<uniform> shift: Shift;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let n = thread_index(group, groups, lane);
    if n < arrayLength(&positions) {
        positions[n] -= shift.by;
    }
}

// Moves the origin of the frame of hi + lo positions.

var<uniform> shift: Shift;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let n = thread_index(group, groups, lane);
    if n >= arrayLength(&positions) {
        return;
    }
    let moved = two_sum(positions[n].xyz, -shift.by.xyz, bitcast<u32>(shift.by.w));
    let sum = two_sum(moved.hi, moved.lo + positions_lo[n].xyz, bitcast<u32>(shift.by.w));
    positions[n] = vec4r(sum.hi, positions[n].w);
    positions_lo[n] = vec4r(sum.lo, 0.0);
}

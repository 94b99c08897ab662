// Moves the origin of the frame: positions less a shift that is a multiple of a power of two.

@group(0) @binding(5) var<uniform> shift: Shift;
@group(0) @binding(10) var<storage, read_write> positions: array<vec4r>;

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

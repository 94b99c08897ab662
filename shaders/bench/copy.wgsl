// Memory bandwidth: every vec4f read once and written once, coalesced.

var<storage, read_write> from_buffer: array<vec4f>;
var<storage, read_write> to_buffer: array<vec4f>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let i = (group.y * groups.x + group.x) * 64u + lane;
    if i < arrayLength(&to_buffer) {
        to_buffer[i] = from_buffer[i];
    }
}

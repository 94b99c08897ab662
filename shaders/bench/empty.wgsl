// The least a dispatch can do: one word, so that each dispatch waits for the one before.

var<storage, read_write> to_buffer: array<vec4f>;

@compute @workgroup_size(64)
fn main(@builtin(local_invocation_index) lane: u32) {
    if lane == 0u {
        to_buffer[0].x += 1.0;
    }
}

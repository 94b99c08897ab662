// Stored energies of every element: (strain, hourglass, 0, smallest det F).

@group(0) @binding(3) var<storage, read_write> energies: array<vec4f>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let element = thread_index(group, groups, lane);
    if element >= arrayLength(&hexes) {
        return;
    }
    let e = element_energy(hexes[element], class_of[element]);
    energies[element] = vec4f(e.x, e.y, 0.0, e.z);
}

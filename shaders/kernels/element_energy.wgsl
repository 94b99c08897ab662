// Stored energies along every chain: (strain, hourglass, 0, smallest det F).

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let thread = thread_index(group, groups, lane);
    if thread / 64u >= arrayLength(&chain_groups) {
        return;
    }
    let chains = chain_groups[thread / 64u];
    var sum = vec4r(0.0, 0.0, 0.0, 3.0e38);
    if lane < chains.w {
        let chain = Chain(thread / 64u, lane, chains.x + lane);
        var at = chain.at;
        var nodes = first_face(chain);
        var low = load_face(nodes);
        for (var level = 0u; level < chains.z; level++) {
            nodes = next_face(at + face_slots, nodes);
            let high = load_face(nodes);
            let e = element_energy(low, high, class_at(chains, level, at));
            sum = vec4r(sum.xy + e.xy, 0.0, min(sum.w, e.z));
            low = high;
            at += face_slots;
        }
    }
    energies[thread] = sum;
}

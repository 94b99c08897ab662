// Internal force of every element, summed along its chain into the slots of the faces.

const NONE: u32 = 0xffffffffu;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let number = group_index(group, groups);
    if number >= arrayLength(&chain_groups) {
        return;
    }
    let chains = chain_groups[number];
    let there = lane < chains.w;
    if may_leave(there) {
        return;
    }
    // Lanes without a chain that have to stay go along the last one and keep nothing.
    let place = min(lane, chains.w - 1u);
    let chain = Chain(number, place, chains.x + place);
    var at = chain.at;
    var nodes = first_face(chain);
    var low = load_end(nodes);
    var held = Shared();
    var power: real = 0.0;
    var failed = NONE;
    var finite = true;
    for (var level = 0u; level < chains.z; level++) {
        nodes = next_face(at + face_slots, nodes);
        let high = load_end(nodes);
        recall(chain, level, there);
        let result = element_force(low, high, class_at(chains, level, at));
        let f = result.f;
        store(at, chain, lane, chains.w, level, Shared(held.a + f.a0, held.b + f.a1, held.c + f.a2, held.d + f.a3));
        held = Shared(f.a4, f.a5, f.a6, f.a7);
        power += viscous_power(result);
        lose(viscous_power(result));
        let sound = is_sound(result);
        if failed == NONE && (!sound || !(result.min_j > 0.0)) {
            failed = level;
            finite = sound;
        }
        low = high;
        at += face_slots;
    }
    store(at, chain, lane, chains.w, chains.z, held);
    if !there {
        return;
    }
    book_viscous(number * 64u + lane, power);
    book_memory(number * 64u + lane);
    if failed != NONE {
        report(element_at(chain, failed), finite);
    }
}

// Internal force of every element, summed along its chain into the slots of the faces.

@group(0) @binding(3) var<storage, read_write> slots: array<vec4r>;
@group(0) @binding(5) var<uniform> step: Step;

const NONE: u32 = 0xffffffffu;

fn store(at: u32, f: Shared) {
    slots[at] = vec4r(f.a, 0.0);
    slots[at + CORNER] = vec4r(f.b, 0.0);
    slots[at + 2u * CORNER] = vec4r(f.c, 0.0);
    slots[at + 3u * CORNER] = vec4r(f.d, 0.0);
}

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
    if lane >= chains.w {
        return;
    }
    let chain = Chain(thread / 64u, lane, chains.x + lane);
    var at = chain.at;
    var nodes = first_face(chain);
    var low = load_end(nodes);
    var held = Shared();
    var power: real = 0.0;
    var failed = NONE;
    var finite = true;
    for (var level = 0u; level < chains.z; level++) {
        nodes = next_face(at + FACE, nodes);
        let high = load_end(nodes);
        let result = element_force(low, high, class_at(chains, level, at));
        let f = result.f;
        store(at, Shared(held.a + f.a0, held.b + f.a1, held.c + f.a2, held.d + f.a3));
        held = Shared(f.a4, f.a5, f.a6, f.a7);
        power += viscous_power(result);
        let sound = is_sound(result);
        if failed == NONE && (!sound || !(result.min_j > 0.0)) {
            failed = level;
            finite = sound;
        }
        low = high;
        at += FACE;
    }
    store(at, held);
    book_viscous(thread, power);
    if failed != NONE {
        report(element_at(chain, failed), finite);
    }
}

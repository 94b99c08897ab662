// Many steps of a small mesh by one work group a body: positions and forces stay in its memory, and between two passes there
// is a barrier instead of a dispatch. Twin of element_force and node, with the same parts.

override threads: u32;
// Rounds of `threads` chains, and faces of the longest chain.
override rounds: u32;
override faces: u32;

// Adds the forces on one face of each chain to the nodes, corner by corner: chains side by side share no corner of the
// same number, so no two threads meet, and the order is always the same.
fn add_face(nodes: vec4u, there: bool, f: Shared) {
    if there {
        add_force(nodes.x, f.a);
    }
    workgroupBarrier();
    if there {
        add_force(nodes.y, f.b);
    }
    workgroupBarrier();
    if there {
        add_force(nodes.z, f.c);
    }
    workgroupBarrier();
    if there {
        add_force(nodes.w, f.d);
    }
    workgroupBarrier();
}

// Forces of one chain a thread.
fn assemble(number: u32) {
    var length = 0u;
    var chains = vec4u(0u);
    if number / 64u < arrayLength(&chain_groups) {
        chains = chain_groups[number / 64u];
        length = select(0u, chains.z, number % 64u < chains.w);
    }
    let chain = Chain(number / 64u, number % 64u, chains.x + number % 64u);
    var at = chain.at;
    var nodes = vec4u(0u);
    var low = End();
    if length > 0u {
        nodes = first_face(chain);
        low = load_end(nodes);
    }
    var held = Shared();
    var power: real = 0.0;
    for (var level = 0u; level < faces; level++) {
        var sum = held;
        let face = nodes;
        if level < length {
            nodes = next_face(at + face_slots, nodes);
            let high = load_end(nodes);
            let result = element_force(low, high, class_at(chains, level, at));
            let f = result.f;
            sum = Shared(held.a + f.a0, held.b + f.a1, held.c + f.a2, held.d + f.a3);
            held = Shared(f.a4, f.a5, f.a6, f.a7);
            power += viscous_power(result);
            let sound = is_sound(result);
            if !sound || !(result.min_j > 0.0) {
                report(element_at(chain, level), sound);
            }
            low = high;
        }
        add_face(face, length > 0u && level <= length, sum);
        at += face_slots;
    }
    if length > 0u {
        book_viscous(number, power);
    }
}

@compute @workgroup_size(threads)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    own = members[group.x];
    let steps = members[group.x].steps;
    for (var n = lane; n < arrayLength(&roles); n += threads) {
        enter(n);
    }
    for (var k = 0u; k < steps; k++) {
        if lane == 0u {
            step = plan[of_steps(k)];
        }
        workgroupBarrier();
        for (var round = 0u; round < rounds; round++) {
            assemble(round * threads + lane);
        }
        var contact = vec4r(0.0);
        for (var n = lane; n < arrayLength(&roles); n += threads) {
            contact += take_step(n);
        }
        sum_step(0u, lane, contact);
        // Velocities are seen by all threads, and the step is done with.
        storageBarrier();
        workgroupBarrier();
    }
    for (var n = lane; n < arrayLength(&roles); n += threads) {
        leave(n);
    }
    if lane == 0u {
        done[of_flags()] = step.index;
    }
}

// Contact over the body in this step, summed in the memory of the forces, which the nodes have read: 32 threads add up
// those of all, four threads those of the 32. Always in the same order.

fn sum_step(group: u32, lane: u32, contact: vec4r) {
    workgroupBarrier();
    held_forces[4u * lane] = contact.x;
    held_forces[4u * lane + 1u] = contact.y;
    held_forces[4u * lane + 2u] = contact.z;
    held_forces[4u * lane + 3u] = contact.w;
    workgroupBarrier();
    if lane < 128u {
        // Component lane % 4 of every 32nd thread; only this thread reads or writes these words.
        var sum = held_forces[lane];
        for (var k = lane + 128u; k < 4u * threads; k += 128u) {
            sum += held_forces[k];
        }
        held_forces[lane] = sum;
    }
    workgroupBarrier();
    if lane < 4u {
        var sum: real = 0.0;
        for (var k = lane; k < 128u; k += 4u) {
            sum += held_forces[k];
        }
        contact_steps[of_contact(step.slot)][lane] = sum;
    }
    workgroupBarrier();
    for (var k = lane; k < 4u * threads; k += threads) {
        held_forces[k] = 0.0;
    }
}

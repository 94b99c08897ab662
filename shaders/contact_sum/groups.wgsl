// Contact over the body in this step, by work groups of 64 surface nodes.

fn sum_step(group: u32, lane: u32, contact: vec4r) {
    let sum = group_sum(lane, contact);
    let groups = (arrayLength(&contact_states) + 63u) / 64u;
    if lane == 0u && group < groups {
        contact_steps[step.slot * groups + group] = sum;
    }
}

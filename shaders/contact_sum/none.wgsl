// No contact to add up.

fn sum_step(group: u32, lane: u32, contact: vec4r) {}

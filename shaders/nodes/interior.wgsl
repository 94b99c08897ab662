// Every node that can neither touch the road nor belongs to the rim.

fn node_threads() -> u32 {
    return arrayLength(&nodes);
}

fn node_at(thread: u32) -> u32 {
    return thread;
}

fn is_left_out(role: u32) -> bool {
    return role != INTERIOR;
}

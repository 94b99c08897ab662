// Every node that can neither touch the road nor belongs to the rim.

fn node_threads() -> u32 {
    return arrayLength(&positions);
}

fn node_at(thread: u32) -> u32 {
    return thread;
}

fn is_left_out(mass: real) -> bool {
    return mass < 0.0;
}

fn node_of(n: u32, mass: real) -> Node {
    return Node(mass, INTERIOR);
}

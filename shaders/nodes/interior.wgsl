// Every node that can neither touch the road nor belongs to the rim.

fn node_threads() -> u32 {
    return arrayLength(&positions);
}

fn node_at(thread: u32) -> u32 {
    return thread;
}

fn is_left_out(n: u32) -> bool {
    return ((boundary_bits[n / 32u] >> (n % 32u)) & 1u) != 0u;
}

fn node_of(n: u32, mass: real) -> Node {
    return Node(mass, INTERIOR);
}

// The nodes that can touch the road, then those of the rim.

fn node_threads() -> u32 {
    return arrayLength(&boundary);
}

fn node_at(thread: u32) -> u32 {
    return boundary[thread];
}

fn is_left_out(n: u32) -> bool {
    return false;
}

fn node_of(n: u32, mass: real) -> Node {
    return Node(mass, roles[n]);
}

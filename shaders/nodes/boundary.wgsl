// The nodes that can touch the road, then those of the rim.

@group(0) @binding(14) var<storage, read> boundary: array<u32>;

fn node_threads() -> u32 {
    return arrayLength(&boundary);
}

fn node_at(thread: u32) -> u32 {
    return boundary[thread];
}

fn is_left_out(mass: real) -> bool {
    return false;
}

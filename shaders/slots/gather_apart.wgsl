// Every column stores all of its corners, one after the other.

// No column has the forces of the one on its left.
fn is_joined(i: u32, lane: u32) -> bool {
    return false;
}

// Slots of a column's corners within its group's face.
fn slot_b(column: u32) -> u32 {
    return CHAINS + column % CHAINS;
}

fn slot_c(column: u32) -> u32 {
    return 2u * CHAINS + column % CHAINS;
}

fn slot_d(column: u32) -> u32 {
    return 3u * CHAINS + column % CHAINS;
}

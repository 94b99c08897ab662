// Every chain stores all corners of its faces.

fn may_leave(there: bool) -> bool {
    return !there;
}

fn store(at: u32, chain: Chain, lane: u32, chains: u32, level: u32, f: Shared) {
    slots[at] = vec4r(f.a, 0.0);
    slots[at + CHAINS] = vec4r(f.b, 0.0);
    slots[at + 2u * CHAINS] = vec4r(f.c, 0.0);
    slots[at + 3u * CHAINS] = vec4r(f.d, 0.0);
}

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

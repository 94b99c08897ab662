// Elements in chains: the upper face of one is the lower face of the next, so that a thread that goes along a chain
// loads and stores every face once. A work group has CHAINS chains of one length, side by side.

// A chain's group, its place among the group's chains, and its first slot.
struct Chain { group: u32, lane: u32, at: u32 }

// Where a table by element has the element whose lower face begins at slot `at`.
fn element_entry(at: u32) -> u32 {
    return (at / face_slots) * CHAINS + at % face_slots;
}

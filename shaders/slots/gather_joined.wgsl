// Every column stores its corners a and d; b and c only where a row or a work group ends.

// Whether column i of a row has the forces of the one on its left: both are in one work group, where it is number `lane`.
fn is_joined(i: u32, lane: u32) -> bool {
    return i > 0u && lane % CHAINS > 0u;
}

// Which of its group's ends a column is: a group has at most one in each row it touches.
fn end_of(column: u32) -> u32 {
    return column / lattice_columns - (column - column % CHAINS) / lattice_columns;
}

// Slots of a column's corners within its group's face: 64 a, 64 d, the ends' b, the ends' c.
fn slot_b(column: u32) -> u32 {
    return 2u * CHAINS + end_of(column);
}

fn slot_c(column: u32) -> u32 {
    return CHAINS + face_slots / 2u + end_of(column);
}

fn slot_d(column: u32) -> u32 {
    return CHAINS + column % CHAINS;
}

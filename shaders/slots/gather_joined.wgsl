// Whether column i of a row has the forces of the one on its left: both are in one work group, where it is number `lane`.
fn is_joined(i: u32, lane: u32) -> bool {
    return i > 0u && lane % 64u > 0u;
}

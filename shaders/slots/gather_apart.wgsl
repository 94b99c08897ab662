// No column has the forces of the one on its left.
fn is_joined(i: u32, lane: u32) -> bool {
    return false;
}

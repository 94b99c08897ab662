// Every node, by one thread after the other.

fn is_left_out(mass: f32) -> bool {
    return false;
}

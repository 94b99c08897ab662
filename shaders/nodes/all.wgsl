// Every node, by one thread after the other.

fn is_left_out(mass: real) -> bool {
    return false;
}

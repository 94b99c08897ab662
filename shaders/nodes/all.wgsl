// Every node, by one thread after the other.

fn is_left_out(mass: real) -> bool {
    return false;
}

fn node_of(n: u32, mass: real) -> Node {
    return Node(abs(mass), roles[n]);
}

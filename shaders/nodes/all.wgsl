// Every node, by one thread after the other.

fn is_left_out(n: u32) -> bool {
    return false;
}

fn node_of(n: u32, mass: real) -> Node {
    return Node(mass, roles[n]);
}

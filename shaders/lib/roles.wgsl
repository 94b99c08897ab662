// Role of each node: INTERIOR, RIM and its number among the rim's nodes, or its number among those of the surface.

@group(0) @binding(3) var<storage, read> roles: array<u32>;

fn node_of(n: u32, mass: real) -> Node {
    return Node(abs(mass), roles[n]);
}

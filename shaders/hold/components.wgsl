// Held components of nodes: their force is taken by whatever holds them, and they have no velocity. Bit d of a node's word: component d.

fn moving(n: u32, f: vec3r) -> vec3r {
    let bits = held[n];
    return select(f, vec3r(0.0), vec3<bool>((bits & 1u) != 0u, (bits & 2u) != 0u, (bits & 4u) != 0u));
}

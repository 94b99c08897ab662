// Nodes and elements of chains from tables: any mesh.

fn face_at(at: u32) -> vec4u {
    return vec4u(
        chain_nodes[at], chain_nodes[at + CHAINS], chain_nodes[at + 2u * CHAINS], chain_nodes[at + 3u * CHAINS]);
}

// Corners 0..3 of the first element.
fn first_face(chain: Chain) -> vec4u {
    return face_at(chain.at);
}

// Corners 4..7 of the element between two faces, whose upper one begins at slot `at`.
fn next_face(at: u32, before: vec4u) -> vec4u {
    return face_at(at);
}

// The element number `level` of a chain.
fn element_at(chain: Chain, level: u32) -> u32 {
    return chain_elements[element_entry(chain.at + level * face_slots)];
}

// Nodes and elements of chains from their numbers: a generator's mesh, which needs no tables.

fn column_of(chain: Chain) -> u32 {
    return (chain.group % lattice_groups) * CHAINS + chain.lane;
}

// Corners 0..3 of the first element.
fn first_face(chain: Chain) -> vec4u {
    let column = column_of(chain);
    let i = column % lattice_columns;
    let beside = (i + 1u) % lattice_row;
    let k = (chain.group / lattice_groups) * lattice_length;
    let low = (k * lattice_rows + column / lattice_columns) * lattice_row;
    let high = low + lattice_row;
    return vec4u(low + i, low + beside, high + beside, high + i);
}

// Corners 4..7 of the element on `before`.
fn next_face(at: u32, before: vec4u) -> vec4u {
    return before + lattice_rows * lattice_row;
}

// The element number `level` of a chain.
fn element_at(chain: Chain, level: u32) -> u32 {
    let k = (chain.group / lattice_groups) * lattice_length + level;
    return k * lattice_columns * (lattice_rows - 1u) + column_of(chain);
}

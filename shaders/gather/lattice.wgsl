// The internal force of a node of a generator's mesh: its slots follow from its number.

@group(0) @binding(2) var<storage, read> slots: array<vec4r>;

// Layers of chains, and elements of a chain of the last one.
override lattice_layers: u32;
override lattice_last: u32;

// The force that a column gives to one of its corners; `first`: the corner's slot in the first column, `stride`: slots
// of a work group.
fn of_column(there: bool, i: u32, j: u32, first: u32, stride: u32) -> vec3r {
    let column = j * lattice_columns + i;
    let slot = first + (column / 64u) * stride + column % 64u;
    return select(vec3r(0.0), slots[select(0u, slot, there)].xyz, there);
}

// Sum over the four columns about node (i, j), in fixed order.
fn of_face(i: u32, j: u32, first: u32, stride: u32) -> vec3r {
    let closed = lattice_row == lattice_columns;
    let left = select(i - 1u, lattice_columns - 1u, i == 0u);
    let has_left = closed || i > 0u;
    let has_right = i < lattice_columns;
    let has_low = j > 0u;
    let has_high = j + 1u < lattice_rows;
    // What the left columns have not passed on.
    let high_left = has_left && !(has_right && is_joined(i, j * lattice_columns + i));
    let low_left = has_left && !(has_right && is_joined(i, (j - 1u) * lattice_columns + i));
    return of_column(has_right && has_high, i, j, first, stride)
        + of_column(high_left && has_high, left, j, first + 64u, stride)
        + of_column(low_left && has_low, left, j - 1u, first + 128u, stride)
        + of_column(has_right && has_low, i, j - 1u, first + 192u, stride);
}

fn gather(n: u32) -> vec3r {
    let i = n % lattice_row;
    let line = n / lattice_row;
    let j = line % lattice_rows;
    let k = line / lattice_rows;
    let layer = min(k / lattice_length, lattice_layers - 1u);
    let level = k - layer * lattice_length;
    let whole = 256u * (lattice_length + 1u);
    let first = layer * lattice_groups * whole;
    let stride = select(whole, 256u * (lattice_last + 1u), layer + 1u == lattice_layers);
    var f = of_face(i, j, first + 256u * level, stride);
    if lattice_layers > 1u && layer > 0u && level == 0u {
        f += of_face(i, j, first - lattice_groups * whole + 256u * lattice_length, whole);
    }
    return f;
}

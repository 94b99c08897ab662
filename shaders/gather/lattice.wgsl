// The internal force of a node of a generator's mesh: its slots follow from its number.

// Layers of chains, and elements of a chain of the last one.
override lattice_layers: u32;
override lattice_last: u32;

// The force of column `column`, if it is there; `at`: the corner's slot in a work group, `stride`: slots of one.
fn of_column(there: bool, column: u32, at: u32, stride: u32) -> vec3r {
    let slot = at + (column / CHAINS) * stride;
    return select(vec3r(0.0), slots[select(0u, slot, there)].xyz, there);
}

// Sum over the four columns about node (i, j), in fixed order; `first`: where the face begins in the first work group.
fn of_face(i: u32, j: u32, first: u32, stride: u32) -> vec3r {
    let closed = lattice_row == lattice_columns;
    let left = select(i - 1u, lattice_columns - 1u, i == 0u);
    let has_left = closed || i > 0u;
    let has_right = i < lattice_columns;
    let has_low = j > 0u;
    let has_high = j + 1u < lattice_rows;
    let high = j * lattice_columns;
    let low = high - lattice_columns;
    // What the left columns have not passed on.
    let high_left = has_left && !(has_right && is_joined(i, high + i));
    let low_left = has_left && !(has_right && is_joined(i, low + i));
    return of_column(has_right && has_high, high + i, first + (high + i) % CHAINS, stride)
        + of_column(high_left && has_high, high + left, first + slot_b(high + left), stride)
        + of_column(low_left && has_low, low + left, first + slot_c(low + left), stride)
        + of_column(has_right && has_low, low + i, first + slot_d(low + i), stride);
}

fn gather(n: u32) -> vec3r {
    let i = n % lattice_row;
    let line = n / lattice_row;
    let j = line % lattice_rows;
    let k = line / lattice_rows;
    let layer = min(k / lattice_length, lattice_layers - 1u);
    let level = k - layer * lattice_length;
    let whole = face_slots * (lattice_length + 1u);
    let first = layer * lattice_groups * whole;
    let stride = select(whole, face_slots * (lattice_last + 1u), layer + 1u == lattice_layers);
    var f = of_face(i, j, first + face_slots * level, stride);
    if lattice_layers > 1u && layer > 0u && level == 0u {
        f += of_face(i, j, first - lattice_groups * whole + face_slots * lattice_length, whole);
    }
    return f;
}

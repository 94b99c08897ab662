// A generator's mesh: node (i, j, k) is number (k rows + j) row + i, and its elements stand on one another along k.
// Chains lie side by side along i, then j; chains that end in the middle of a column are continued by those of the
// next layer.

// Nodes along i and j; elements along i: as many as nodes where rows close on themselves, else one less.
override lattice_row: u32;
override lattice_rows: u32;
override lattice_columns: u32;
// Work groups of a layer of chains; elements of a chain.
override lattice_groups: u32;
override lattice_length: u32;

// Chains side by side share two corners of each face: the right one's corners a and d are the left one's b and c, whose forces
// it gets through the work group's memory. Half of the slots are then neither stored nor loaded, and have no place.

// Forces on b and c, number by number, of two levels in turn, so that one barrier a level is enough.
var<workgroup> passed: array<real, 768>;

// All lanes meet at the barriers.
fn may_leave(there: bool) -> bool {
    return false;
}

fn store(at: u32, chain: Chain, lane: u32, chains: u32, level: u32, f: Shared) {
    let page = (level & 1u) * 384u;
    let own = page + lane;
    passed[own] = f.b.x;
    passed[own + 64u] = f.b.y;
    passed[own + 128u] = f.b.z;
    passed[own + 192u] = f.c.x;
    passed[own + 256u] = f.c.y;
    passed[own + 320u] = f.c.z;
    workgroupBarrier();
    if lane >= chains {
        return;
    }
    let column = column_of(chain);
    let left = page + max(lane, 1u) - 1u;
    let has_left = is_joined(column % lattice_columns, lane);
    let b = vec3r(passed[left], passed[left + 64u], passed[left + 128u]);
    let c = vec3r(passed[left + 192u], passed[left + 256u], passed[left + 320u]);
    let face = at - chain.lane;
    slots[at] = vec4r(f.a + select(vec3r(0.0), b, has_left), 0.0);
    slots[face + slot_d(column)] = vec4r(f.d + select(vec3r(0.0), c, has_left), 0.0);
    if !is_joined((column + 1u) % lattice_columns, lane + 1u) {
        slots[face + slot_b(column)] = vec4r(f.b, 0.0);
        slots[face + slot_c(column)] = vec4r(f.c, 0.0);
    }
}

// Whether column i of a row has the forces of the one on its left: both are in one work group, where it is number `lane`.
fn is_joined(i: u32, lane: u32) -> bool {
    return i > 0u && lane % CHAINS > 0u;
}

// Which of its group's ends a column is: a group has at most one in each row it touches.
fn end_of(column: u32) -> u32 {
    return column / lattice_columns - (column - column % CHAINS) / lattice_columns;
}

// Slots of a column's corners within its group's face: 64 a, 64 d, the ends' b, the ends' c.
fn slot_b(column: u32) -> u32 {
    return 2u * CHAINS + end_of(column);
}

fn slot_c(column: u32) -> u32 {
    return CHAINS + face_slots / 2u + end_of(column);
}

fn slot_d(column: u32) -> u32 {
    return CHAINS + column % CHAINS;
}

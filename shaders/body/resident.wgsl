// One body of several in the same arrays, a work group each: where its entries begin; its step, and
// positions and forces of its nodes, in the memory of the work group, three numbers a node.

var<uniform> members: array<Member, 512>;

var<private> own: Member;

var<workgroup> step: Step;

override words: u32;
var<workgroup> held_positions: array<real, words>;
var<workgroup> held_forces: array<real, words>;

fn of_nodes(n: u32) -> u32 {
    return own.nodes + n;
}

fn of_surface(k: u32) -> u32 {
    return own.surface + k;
}

fn of_rim(k: u32) -> u32 {
    return own.rim + k;
}

fn of_chains(number: u32) -> u32 {
    return own.chains + number;
}

fn of_steps(k: u32) -> u32 {
    return own.plan + k;
}

fn of_contact(slot: u32) -> u32 {
    return own.contact + slot;
}

fn of_flags() -> u32 {
    return own.flags;
}

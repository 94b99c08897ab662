// One body on the device: its arrays begin at their first entry. Its step stands in the plan, at the offset of the dispatch.

var<uniform> step: Step;

fn of_nodes(n: u32) -> u32 {
    return n;
}

fn of_surface(k: u32) -> u32 {
    return k;
}

fn of_rim(k: u32) -> u32 {
    return k;
}

fn of_chains(number: u32) -> u32 {
    return number;
}

fn of_flags() -> u32 {
    return 0u;
}

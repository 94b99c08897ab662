// A few shape classes, and the same ones along all chains of a work group.

var<uniform> classes: array<Class, 48>;

fn class_at(chains: vec4u, level: u32, at: u32) -> u32 {
    return chain_classes[chains.y + level];
}

// Many shape classes: every element names its own.

var<storage, read_write> classes: array<Class>;

fn class_at(chains: vec4u, level: u32, at: u32) -> u32 {
    return chain_classes[element_entry(at)];
}

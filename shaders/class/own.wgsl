// Many shape classes: every element names its own.

@group(0) @binding(2) var<storage, read> classes: array<Class>;

fn class_at(chains: vec4u, level: u32, at: u32) -> u32 {
    return chain_classes[element_entry(at)];
}

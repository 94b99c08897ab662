// What a node is.

const INTERIOR: u32 = 0xffffffffu;
const RIM: u32 = 0x80000000u;

@group(0) @binding(3) var<storage, read> nodes: array<Node>;

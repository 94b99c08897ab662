// What a node is. Its mass stands beside its position, negative if the node can touch the road or belongs to the rim.

const INTERIOR: u32 = 0xffffffffu;
const RIM: u32 = 0x80000000u;

struct Node { mass: real, role: u32 }

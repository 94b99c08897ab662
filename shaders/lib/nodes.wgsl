// What a node is: its mass, which stands beside its position, and its role.

const INTERIOR: u32 = 0xffffffffu;
const RIM: u32 = 0x80000000u;

struct Node { mass: real, role: u32 }

// Chains of a work group, and slots from one face of theirs to the next.
const CHAINS: u32 = 64u;
override face_slots: u32;

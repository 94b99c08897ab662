// What every element pass reads: connectivity, and which shape class an element has.

struct Hex { n0: u32, n1: u32, n2: u32, n3: u32, n4: u32, n5: u32, n6: u32, n7: u32 }

@group(0) @binding(0) var<storage, read> hexes: array<Hex>;
@group(0) @binding(1) var<storage, read> class_of: array<u32>;

// Every buffer that parts share. A program binds those it reaches, numbered by the composer, and those it does not write for
// reading only. Vectors stand alone in four numbers.

// By node: position and mass; what hi + lo positions have beside it; velocity and the work of the internal force in this
// window. The mass and the work stand in fourth components that are loaded and stored anyway: an array for the work would
// add 8 bytes to the 163 that a step moves for an element, 237 where slots are not joined (docs/gpu-design.md).
var<storage, read_write> positions: array<vec4r>;
var<storage, read_write> positions_lo: array<vec4r>;
var<storage, read_write> velocities: array<vec4r>;
// Works of the window beside the internal one: body force, damping [J].
var<storage, read_write> works: array<vec2r>;
// Bit d: component d is held.
var<storage, read_write> held: array<u32>;
// INTERIOR, RIM and the node's number among the rim's nodes, or its number among those of the surface.
var<storage, read_write> roles: array<u32>;

// The nodes that can touch the road, then those of the rim; and the same as bits: bit n % 32 of word n / 32.
var<storage, read_write> boundary: array<u32>;
var<storage, read_write> boundary_bits: array<u32>;
var<storage, read_write> surface_nodes: array<u32>;
var<storage, read_write> rim_nodes: array<u32>;
// From the axle to each rim node in the reference shape.
var<storage, read_write> rim_arms: array<vec4r>;

// Of a work group of chains: its first slot, its first class, elements a chain, chains.
var<storage, read_write> chain_groups: array<vec4u>;
var<storage, read_write> chain_classes: array<u32>;
// The nodes of a face: corners 0..3 of 64 chains each.
var<storage, read_write> chain_nodes: array<u32>;
var<storage, read_write> chain_elements: array<u32>;

// Forces of chains on the corners of their faces, and where each node finds its own:
// corners[corner_start[n]] .. corners[corner_start[n + 1]].
var<storage, read_write> slots: array<vec4r>;
var<storage, read_write> corner_start: array<u32>;
var<storage, read_write> corners: array<u32>;

// Sums of the window by rim node, by surface node, and by chain: viscous work [J].
var<storage, read_write> rim_sums: array<RimSum>;
var<storage, read_write> surface_sums: array<SurfaceRecord>;
var<storage, read_write> viscous_work: array<real>;
// By surface node: contact in the last step (0 free, 1 slides, 2 sticks); one over the area [1/m2], as of the last sample.
var<storage, read_write> contact_states: array<u32>;
var<storage, read_write> inverse_areas: array<real>;
// Contact of each step, by work group.
var<storage, read_write> contact_steps: array<vec4r>;

// What a sample reads: energies by chain, the probe by work group, position and velocity of each surface node.
var<storage, read_write> energies: array<vec4r>;
var<storage, read_write> probes: array<vec4r>;
var<storage, read_write> surface_states: array<vec4r>;

// A road with an array: heights four by four, row by row; or lines, arcs and corners, two vectors each, and for equal shares of a
// profile's length the first piece and one past the last.
var<storage, read_write> road_shape: array<vec4r>;

// A rim with free components.
var<storage, read_write> rim_state: RimState;

// Steps of a resident kernel.
var<storage, read_write> plan: array<Step>;

// First failing step with its element, and the last step taken.
var<storage, read_write> failure: array<atomic<u32>>;
var<storage, read_write> done: array<u32>;

// Internal force of every element into its eight corner slots.

@group(0) @binding(3) var<storage, read_write> slots: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> failure: array<atomic<u32>, 4>;
@group(0) @binding(5) var<uniform> step: Step;

// First failing step, then the smallest failing element of that step (doubled, odd: not finite).
// Steps come in order, so whoever finds an earlier step there leaves it alone.
fn report(element: u32, finite: bool) {
    let before = atomicMin(&failure[0], step.index);
    if before >= step.index {
        atomicMin(&failure[1], 2u * element + select(1u, 0u, finite));
    }
}

fn store(element: u32, f: Corners) {
    let s = 8u * element;
    slots[s] = vec4f(f.a0, 0.0);
    slots[s + 1u] = vec4f(f.a1, 0.0);
    slots[s + 2u] = vec4f(f.a2, 0.0);
    slots[s + 3u] = vec4f(f.a3, 0.0);
    slots[s + 4u] = vec4f(f.a4, 0.0);
    slots[s + 5u] = vec4f(f.a5, 0.0);
    slots[s + 6u] = vec4f(f.a6, 0.0);
    slots[s + 7u] = vec4f(f.a7, 0.0);
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let element = thread_index(group, groups, lane);
    if element >= arrayLength(&hexes) {
        return;
    }
    let result = element_force(hexes[element], class_of[element]);
    store(element, result.f);
    book_viscous(element, result);
    // WGSL may assume there are no NaNs, and min() may drop one: the bits decide.
    let f = result.f;
    let sum = f.a0 + f.a1 + f.a2 + f.a3 + f.a4 + f.a5 + f.a6;
    let finite = is_finite(dot(sum, vec3f(1.0))) && is_finite(result.min_j);
    if !finite || !(result.min_j > 0.0) {
        report(element, finite);
    }
}

// Compensated sums of given pairs: does the adapter round as they need, or does its compiler reassociate?

var<storage, read_write> pairs: array<vec4f>;
var<storage, read_write> results: array<vec4f>;

@compute @workgroup_size(64)
fn main(@builtin(local_invocation_index) lane: u32) {
    let zero = bitcast<u32>(pairs[2u * lane].w);
    let p = two_sum(pairs[2u * lane].xyz, pairs[2u * lane + 1u].xyz, zero);
    results[2u * lane] = vec4f(p.hi, 0.0);
    results[2u * lane + 1u] = vec4f(p.lo, 0.0);
}

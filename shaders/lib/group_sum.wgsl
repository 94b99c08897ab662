// Sum over a work group, by halves, so always in the same order. All of its threads call it.

var<workgroup> shared_sums: array<vec4f, 64>;

fn group_sum(lane: u32, value: vec4f) -> vec4f {
    shared_sums[lane] = value;
    workgroupBarrier();
    for (var half = 32u; half > 0u; half /= 2u) {
        if lane < half {
            shared_sums[lane] += shared_sums[lane + half];
        }
        workgroupBarrier();
    }
    let sum = shared_sums[0];
    workgroupBarrier();
    return sum;
}

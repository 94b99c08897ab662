// Sum over a work group, for its thread 0, always in the same order. All of its threads call it.

var<workgroup> shared_sums: array<vec4r, 64>;

fn group_sum(lane: u32, value: vec4r) -> vec4r {
    // The sum before this one has been read.
    workgroupBarrier();
    shared_sums[lane] = value;
    workgroupBarrier();
    if lane < 8u {
        for (var k = lane + 8u; k < 64u; k += 8u) {
            shared_sums[lane] += shared_sums[k];
        }
    }
    workgroupBarrier();
    var sum = vec4r(0.0);
    if lane == 0u {
        for (var k = 0u; k < 8u; k++) {
            sum += shared_sums[k];
        }
    }
    return sum;
}

// Sums of records of `width` vec4r, in fixed order: group g of column k adds its share into partials[k * groups + g].
// With least_w the fourth component is a minimum instead.

override width: u32;
override least_w: bool;

var<storage, read_write> records: array<vec4r>;
var<storage, read_write> partials: array<vec4r>;

var<workgroup> group_sums: array<vec4r, 64>;

fn combine(a: vec4r, b: vec4r) -> vec4r {
    return vec4r(a.xyz + b.xyz, select(a.w + b.w, min(a.w, b.w), least_w));
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let count = arrayLength(&records) / width;
    var sum = vec4r(0.0, 0.0, 0.0, select(real(0.0), real(3.0e38), least_w));
    for (var i = group.x * 64u + lane; i < count; i += groups.x * 64u) {
        sum = combine(sum, records[i * width + group.y]);
    }
    group_sums[lane] = sum;
    workgroupBarrier();
    for (var half = 32u; half > 0u; half /= 2u) {
        if lane < half {
            group_sums[lane] = combine(group_sums[lane], group_sums[lane + half]);
        }
        workgroupBarrier();
    }
    if lane == 0u {
        partials[group.y * groups.x + group.x] = group_sums[0];
    }
}

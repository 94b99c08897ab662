// Arithmetic: eight independent chains of vec4r multiply-adds in registers, 64 scalar ones a turn.

var<storage, read_write> from_buffer: array<vec4r>;
var<storage, read_write> to_buffer: array<vec4r>;

override turns: u32;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let i = group.x * 64u + lane;
    // Of values that the compiler does not know; the factor is below one, so that nothing overflows.
    let m = from_buffer[0];
    let s = from_buffer[1];
    var a = vec4r(real(i)) * s;
    var b = a + s;
    var c = b + s;
    var d = c + s;
    var e = d + s;
    var f = e + s;
    var g = f + s;
    var h = g + s;
    for (var turn = 0u; turn < turns; turn++) {
        a = fma(a, m, s);
        b = fma(b, m, s);
        c = fma(c, m, s);
        d = fma(d, m, s);
        e = fma(e, m, s);
        f = fma(f, m, s);
        g = fma(g, m, s);
        h = fma(h, m, s);
        a = fma(a, m, s);
        b = fma(b, m, s);
        c = fma(c, m, s);
        d = fma(d, m, s);
        e = fma(e, m, s);
        f = fma(f, m, s);
        g = fma(g, m, s);
        h = fma(h, m, s);
    }
    to_buffer[i] = a + b + c + d + e + f + g + h;
}

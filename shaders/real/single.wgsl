// Single precision: what `real` is in all other parts.

alias real = f32;
alias vec2r = vec2<f32>;
alias vec3r = vec3<f32>;
alias vec4r = vec4<f32>;
alias mat3x3r = mat3x3<f32>;

fn is_finite(x: real) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}

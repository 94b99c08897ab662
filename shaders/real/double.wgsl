// Double precision, where the adapter has it: what `real` is in all other parts. Numbers that a part writes without a type
// become what they meet; `let x = 0.0` would be single.

alias real = f64;
alias vec2r = vec2<f64>;
alias vec3r = vec3<f64>;
alias vec4r = vec4<f64>;
alias mat3x3r = mat3x3<f64>;

// What single precision cannot hold is no sound force either.
fn is_finite(x: real) -> bool {
    return (bitcast<u32>(f32(x)) & 0x7f800000u) != 0x7f800000u;
}

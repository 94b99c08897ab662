// Single precision: what `real` is in all other parts.

alias real = f32;
alias vec2r = vec2<f32>;
alias vec3r = vec3<f32>;
alias vec4r = vec4<f32>;
alias mat3x3r = mat3x3<f32>;

fn is_finite(x: real) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}

// Square of what a dozen roundings leave of a number, over the square of that number.
fn rounding_squared() -> real {
    return 3.637979e-12;
}

fn exponential(x: real) -> real {
    return exp(x);
}

fn logarithm(x: real) -> real {
    return log(x);
}

// x^(-1/3) for x > 0: a first guess y from the exponent, within 4 %; with r = 1 - x y^3, y (1 - r)^(-1/3) by its series to r^3,
// which leaves 35/243 r^4, 3.5e-5; then to r, which leaves 2/9 r^2, 2.5e-9. The built-in pow may be off by thousands of units in
// the last place.
fn recip_cbrt(x: real) -> real {
    var y = bitcast<f32>(0x54a21d2au - bitcast<u32>(x) / 3u);
    var r = 1.0 - (x * y) * (y * y);
    y = y + (y * r) * (0.33333334 + r * (0.22222222 + r * 0.17283951));
    r = 1.0 - (x * y) * (y * y);
    return y + (y * r) * 0.33333334;
}

// Sine and cosine.
struct Turn { s: real, c: real }

fn turn(angle: real) -> Turn {
    return Turn(sin(angle), cos(angle));
}

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

// Square of what a dozen roundings leave of a number, over the square of that number.
fn rounding_squared() -> real {
    return 1.262177448353619e-29;
}

// e^x to a few units in the last place, which the built-in function is not for doubles: x = k ln 2 + r, the series of e^r up
// to r^13 (what is left out is below 5e-18), and 2^k from its bits. Beyond +-87 it is that of +-87.
fn exponential(x: real) -> real {
    let within = clamp(x, -87.0, 87.0);
    let k = floor(within * 1.4426950408889634 + 0.5);
    // ln 2 in two parts; a product of k and the first has no rounding error.
    let r = (within - k * 0.6931471803691238) - k * 1.9082149292705877e-10;
    var sum: real = 1.0 / 6227020800.0;
    sum = sum * r + 1.0 / 479001600.0;
    sum = sum * r + 1.0 / 39916800.0;
    sum = sum * r + 1.0 / 3628800.0;
    sum = sum * r + 1.0 / 362880.0;
    sum = sum * r + 1.0 / 40320.0;
    sum = sum * r + 1.0 / 5040.0;
    sum = sum * r + 1.0 / 720.0;
    sum = sum * r + 1.0 / 120.0;
    sum = sum * r + 1.0 / 24.0;
    sum = sum * r + 1.0 / 6.0;
    sum = sum * r + 0.5;
    sum = sum * r + 1.0;
    sum = sum * r + 1.0;
    return sum * real(bitcast<f32>(u32(i32(k) + 127) << 23u));
}

// ln x for x > 0: that of single precision (error below 1e-6), and one step of Halley's method on e^y = x, which leaves a
// twelfth of the cube of the error.
fn logarithm(x: real) -> real {
    let y = real(log(f32(x)));
    let e = exponential(y);
    return y + 2.0 * (x - e) / (x + e);
}

// x^(-1/3) for x > 0: a first guess from the exponent, then Newton steps y (4 - x y^3)/3, each doubling the digits
// (relative error 4e-2, 3e-3, 2e-5 in single precision, 1e-9, 1e-16 in double).
fn recip_cbrt(x: real) -> real {
    let low = f32(x);
    var guess = bitcast<f32>(0x54a21d2au - bitcast<u32>(low) / 3u);
    guess = guess * (1.3333334 - 0.33333334 * low * guess * guess * guess);
    guess = guess * (1.3333334 - 0.33333334 * low * guess * guess * guess);
    var y = real(guess);
    y = y + y * ((1.0 - x * y * y * y) / 3.0);
    y = y + y * ((1.0 - x * y * y * y) / 3.0);
    return y;
}

// Sine and cosine, which WGSL does not have for doubles: of the distance r to the nearest quarter turn, by their series up to
// r^17 (what is left out is below 2e-18), then turned by the quarters.
struct Turn { s: real, c: real }

fn turn(angle: real) -> Turn {
    let k = floor(angle * 0.6366197723675814 + 0.5);
    // A quarter turn in two parts; a product of k and the first has no rounding error.
    let r = (angle - k * 1.5707963267341256) - k * 6.077100506506192e-11;
    let q = r * r;
    var s: real = 1.0 / 355687428096000.0;
    s = s * q - 1.0 / 1307674368000.0;
    s = s * q + 1.0 / 6227020800.0;
    s = s * q - 1.0 / 39916800.0;
    s = s * q + 1.0 / 362880.0;
    s = s * q - 1.0 / 5040.0;
    s = s * q + 1.0 / 120.0;
    s = s * q - 1.0 / 6.0;
    s = r + r * q * s;
    var c: real = 1.0 / 20922789888000.0;
    c = c * q - 1.0 / 87178291200.0;
    c = c * q + 1.0 / 479001600.0;
    c = c * q - 1.0 / 3628800.0;
    c = c * q + 1.0 / 40320.0;
    c = c * q - 1.0 / 720.0;
    c = c * q + 1.0 / 24.0;
    c = c * q - 0.5;
    c = 1.0 + q * c;
    switch i32(k) & 3 {
        case 1: { return Turn(c, -s); }
        case 2: { return Turn(-s, -c); }
        case 3: { return Turn(-c, s); }
        default: { return Turn(s, c); }
    }
}

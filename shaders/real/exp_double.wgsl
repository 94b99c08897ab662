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

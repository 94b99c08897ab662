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

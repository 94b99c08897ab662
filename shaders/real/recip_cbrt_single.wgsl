// x^(-1/3) for x > 0: a first guess from the exponent, then Newton steps y (4 - x y^3)/3, each doubling the digits
// (relative error 4e-2, 3e-3, 2e-5, 1e-9). The built-in pow may be off by thousands of units in the last place.
fn recip_cbrt(x: real) -> real {
    var y = bitcast<f32>(0x54a21d2au - bitcast<u32>(x) / 3u);
    y = y * (1.3333334 - 0.33333334 * x * y * y * y);
    y = y * (1.3333334 - 0.33333334 * x * y * y * y);
    y = y + y * (0.33333334 * (1.0 - x * y * y * y));
    return y;
}

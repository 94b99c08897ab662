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

// Powers of the principal stretches as functions of invariants; the derivation is in its twin, src/physics/material/hencky.rs.

// A symmetric matrix X without trace, X^3 = p X + q I.
struct Deviator { p: real, q: real }

// A product with X, over n.
fn times_deviator(v: vec3r, x: Deviator, over: real) -> vec3r {
    return over * vec3r(v.z * x.q, v.x + v.z * x.p, v.y);
}

// exp(s X) - I = d I + e1 X + e2 X^2 as (d, e1, e2).
fn stretch_power(deviator: Deviator, s: real) -> vec3r {
    var z = s;
    var halvings = 0;
    while abs(z) > 0.25 {
        z = z * 0.5;
        halvings = halvings + 1;
    }
    let x = Deviator(deviator.p * z * z, deviator.q * z * z * z);
    let one = vec3r(1.0, 0.0, 0.0);
    var e = vec3r(1.0, 0.08333333333333333, 0.00641025641025641);
    e = times_deviator(e, x, 0.09090909090909091) + one;
    e = times_deviator(e, x, 0.1) + one;
    e = times_deviator(e, x, 0.1111111111111111) + one;
    e = times_deviator(e, x, 0.125) + one;
    e = times_deviator(e, x, 0.14285714285714285) + one;
    e = times_deviator(e, x, 0.16666666666666666) + one;
    e = times_deviator(e, x, 0.2) + one;
    e = times_deviator(e, x, 0.25) + one;
    e = times_deviator(e, x, 0.3333333333333333) + one;
    e = times_deviator(e, x, 0.5) + one;
    e = times_deviator(e, x, 1.0);
    for (var n = 0; n < halvings; n = n + 1) {
        let twice = 2.0 + 2.0 * e.x;
        let cross = 2.0 * e.y * e.z;
        let high = e.z * e.z;
        e = vec3r(
            e.x * (2.0 + e.x) + cross * x.q,
            twice * e.y + (cross * x.p + high * x.q),
            twice * e.z + (high * x.p + e.y * e.y));
    }
    return vec3r(e.x, e.y * z, e.z * z * z);
}

// tr exp(s X) - 3.
fn power_trace(x: Deviator, e: vec3r) -> real {
    return 3.0 * e.x + 2.0 * x.p * e.z;
}

// Slopes along tr exp(2 X) and tr exp(-2 X) of what has the slopes `by` along p and q.
fn by_invariants(x: Deviator, by: vec2r) -> vec2r {
    let up = stretch_power(x, 2.0);
    let down = stretch_power(x, -2.0);
    let scale = 0.5 / (up.z * down.y - up.y * down.z);
    return scale * vec2r(down.y * by.y - down.z * by.x, up.y * by.y - up.z * by.x);
}

// A step of Newton's method towards the X of tr exp(2 X) - 3 = e1, tr exp(-2 X) - 3 = e2.
fn nearer_deviator(x: Deviator, e1: real, e2: real) -> Deviator {
    let up = stretch_power(x, 2.0);
    let down = stretch_power(x, -2.0);
    let scale = 0.5 / (up.z * down.y - up.y * down.z);
    let off1 = power_trace(x, up) - e1;
    let off2 = power_trace(x, down) - e2;
    return Deviator(x.p + scale * (down.z * off1 + up.z * off2), x.q - scale * (down.y * off1 + up.y * off2));
}

// That X up to what roots lose.
fn rough_deviator(e1: real, e2: real) -> Deviator {
    let a = max(e1, e2);
    let b = min(e1, e2);
    let apart = a - b;
    let turned = (e1 - e2) / max(apart, 1e-30);
    let square = max(6.0 * a + (a * a - 3.0 * b), 1e-20);
    let root = sqrt(square);
    let cubic = 27.0 * apart + a * (18.0 * a + 2.0 * a * a - 9.0 * b);
    let w = clamp(cubic / (2.0 * square * root), 0.0, 1.0);
    var t = 0.866 + w * (0.16666666666666666 - 0.0327 * w);
    t = t - (t * (4.0 * t * t - 3.0) - w) / (12.0 * t * t - 3.0);
    t = t - (t * (4.0 * t * t - 3.0) - w) / (12.0 * t * t - 3.0);
    t = t - (t * (4.0 * t * t - 3.0) - w) / (12.0 * t * t - 3.0);
    let c = 1.0 + 0.3333333333333333 * (a + 2.0 * root * t);
    let p = 1.0 / c;
    let ch = 0.5 * (3.0 + b - p) * sqrt(p);
    let sh = sqrt(max(ch * ch - 1.0, 0.0));
    let x = 0.5 * rough_logarithm(c);
    let y = 0.5 * rough_logarithm(ch + sh);
    return Deviator(0.75 * x * x + y * y, turned * x * (0.25 * x * x - y * y));
}

// ln c from c^(-1/27) by five terms of its series.
fn rough_logarithm(c: real) -> real {
    let r = recip_cbrt(recip_cbrt(recip_cbrt(c)));
    let z = (r - 1.0) / (r + 1.0);
    let zz = z * z;
    let high = 0.2 + zz * (0.14285714285714285 + zz * 0.1111111111111111);
    return -54.0 * z * (1.0 + zz * (0.3333333333333333 + zz * high));
}

// ln x for x > 0: that of single precision (error below 1e-6), and one step of Halley's method on e^y = x, which leaves a
// twelfth of the cube of the error.
fn logarithm(x: real) -> real {
    let y = real(log(f32(x)));
    let e = exponential(y);
    return y + 2.0 * (x - e) / (x + e);
}

fn exponential(x: real) -> real {
    return exp(x);
}

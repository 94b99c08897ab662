fn logarithm(x: real) -> real {
    return log(x);
}

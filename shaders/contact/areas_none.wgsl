fn inverse_area(role: u32) -> real {
    return 0.0;
}

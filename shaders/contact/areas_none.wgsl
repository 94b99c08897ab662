fn inverse_area(role: u32) -> f32 {
    return 0.0;
}

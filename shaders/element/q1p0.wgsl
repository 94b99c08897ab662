// 2x2x2 points and one mean-dilatation pressure; twin of src/physics/element/q1p0.rs.

fn mean_pressure(c: Columns, shape: u32) -> f32 {
    return dU(volume(c) * classes[shape].inverse_volume);
}

fn point_pressure(mean: f32, j: f32) -> f32 {
    return mean;
}

fn mean_U(c: Columns, shape: u32) -> f32 {
    return classes[shape].volume * U(volume(c) * classes[shape].inverse_volume);
}

fn point_U(j: f32) -> f32 {
    return 0.0;
}

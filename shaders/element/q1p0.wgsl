// 2x2x2 points and one mean-dilatation pressure; twin of src/physics/element/q1p0.rs.

fn mean_pressure(c: Columns, shape: u32) -> real {
    return dU(volume(c) * classes[shape].inverse_volume);
}

fn point_pressure(mean: real, j: real) -> real {
    return mean;
}

fn mean_U(c: Columns, shape: u32) -> real {
    return classes[shape].volume * U(volume(c) * classes[shape].inverse_volume);
}

fn point_U(j: real) -> real {
    return 0.0;
}

// 2x2x2 points for everything; twin of src/physics/element/full.rs.

fn mean_pressure(c: Columns, shape: u32) -> real {
    return 0.0;
}

fn point_pressure(mean: real, j: real) -> real {
    return dU(j);
}

fn mean_U(dilatation: real, shape: u32) -> real {
    return 0.0;
}

fn point_U(dilatation: real) -> real {
    return U(dilatation);
}

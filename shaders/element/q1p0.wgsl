// 2x2x2 points and one mean-dilatation pressure; twin of src/physics/element/q1p0.rs.

// Of A at a point, in the words of gradient/points, so that a compiler sees what it has already.
fn det_at(a: mat3x3r) -> real {
    return dot(a[0], cross(a[1], a[2]));
}

// Exact for trilinear maps.
fn volume(c: Columns) -> real {
    return WEIGHT * (det_at(mat3x3r(c.xi.a, c.eta.a, c.zeta.a)) + det_at(mat3x3r(c.xi.a, c.eta.b, c.zeta.b))
        + det_at(mat3x3r(c.xi.b, c.eta.a, c.zeta.c)) + det_at(mat3x3r(c.xi.b, c.eta.b, c.zeta.d))
        + det_at(mat3x3r(c.xi.c, c.eta.c, c.zeta.a)) + det_at(mat3x3r(c.xi.c, c.eta.d, c.zeta.b))
        + det_at(mat3x3r(c.xi.d, c.eta.c, c.zeta.c)) + det_at(mat3x3r(c.xi.d, c.eta.d, c.zeta.d)));
}

fn mean_pressure(c: Columns, shape: u32) -> real {
    return dU(volume(c) * classes[shape].inverse_volume);
}

fn point_pressure(mean: real, j: real) -> real {
    return mean;
}

// From the integral of J - 1 over the element, which is v - V.
fn mean_U(dilatation: real, shape: u32) -> real {
    return classes[shape].volume * U(dilatation * classes[shape].inverse_volume);
}

fn point_U(dilatation: real) -> real {
    return 0.0;
}

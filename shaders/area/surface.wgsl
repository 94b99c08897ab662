// One over the area of each surface node [1/m2], as of the last sample.

fn inverse_area(role: u32) -> real {
    return inverse_areas[of_surface(role)];
}

// One over the area of each surface node [1/m2], as of the last sample.
@group(0) @binding(24) var<storage, read> inverse_areas: array<real>;

fn inverse_area(role: u32) -> real {
    return inverse_areas[of_surface(role)];
}

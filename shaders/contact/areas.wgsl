// One over the area of each surface node [1/m2], as of the last sample.
@group(0) @binding(24) var<storage, read> inverse_areas: array<f32>;

fn inverse_area(role: u32) -> f32 {
    return inverse_areas[of_surface(role)];
}

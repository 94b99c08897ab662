// Viscous work of the window, by element [J].
@group(0) @binding(6) var<storage, read_write> viscous_work: array<f32>;

fn book_viscous(element: u32, result: ElementForce) {
    viscous_work[element] -= step.viscous_weight * result.viscous_power;
}

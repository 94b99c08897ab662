fn viscous_power(result: ElementForce) -> f32 {
    return 0.0;
}

fn book_viscous(chain: u32, power: f32) {}

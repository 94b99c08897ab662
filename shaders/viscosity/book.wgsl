// Viscous work of the window, by chain [J].
@group(0) @binding(20) var<storage, read_write> viscous_work: array<real>;

fn viscous_power(result: ElementForce) -> real {
    return result.viscous_power;
}

fn book_viscous(chain: u32, power: real) {
    viscous_work[of_chains(chain)] -= step.viscous_weight * power;
}

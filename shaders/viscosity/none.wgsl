// No viscosity.

fn viscous_power(result: ElementForce) -> real {
    return 0.0;
}

fn book_viscous(chain: u32, power: real) {}

// sigma_v = eta (L + L^T - 2/3 tr(L) I), L = (dA/dt) A^-1; twin of src/physics/material/viscosity.rs.

override eta: real;

// weight sigma_v and the power weight sigma_v : L det A.
struct Viscous { stress: mat3x3r, power: real }

fn viscous_stress(a_dot: mat3x3r, cof: mat3x3r, det_a: real, weight: real) -> Viscous {
    // L det A, whose factor goes to eta.
    let l = a_dot * transpose(cof);
    let factor = eta * weight / det_a;
    let trace = l[0][0] + l[1][1] + l[2][2];
    let mean = 0.6666666666666667 * trace;
    let off = vec3r(l[0][1] + l[1][0], l[0][2] + l[2][0], l[1][2] + l[2][1]);
    let s = factor * off;
    let d = factor * vec3r(2.0 * l[0][0] - mean, 2.0 * l[1][1] - mean, 2.0 * l[2][2] - mean);
    let power = d.x * l[0][0] + d.y * l[1][1] + d.z * l[2][2] + dot(s, off);
    return Viscous(mat3x3r(vec3r(d.x, s.x, s.y), vec3r(s.x, d.y, s.z), vec3r(s.y, s.z, d.z)), power);
}

// Velocities of a face's corners.
struct Rates { a: vec3r, b: vec3r, c: vec3r, d: vec3r }

fn load_rates(nodes: vec4u) -> Rates {
    return Rates(
        velocities[of_nodes(nodes.x)].xyz, velocities[of_nodes(nodes.y)].xyz, velocities[of_nodes(nodes.z)].xyz,
        velocities[of_nodes(nodes.w)].xyz);
}

fn rates_of(low: Rates, high: Rates) -> Corners {
    return Corners(low.a, low.b, low.c, low.d, high.a, high.b, high.c, high.d);
}

fn viscous_power(result: ElementForce) -> real {
    return result.viscous_power;
}

// In the viscous work of the window.
fn book_viscous(chain: u32, power: real) {
    viscous_work[of_chains(chain)] -= step.viscous_weight * power;
}

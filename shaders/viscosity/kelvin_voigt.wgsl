// sigma_v = 2 eta dev D, 2 D = L + L^T - dt L^T L, L = (dA/dt) A^-1; twin of src/physics/material/viscosity.rs.

override eta: real;

// weight sigma_v and the power weight sigma_v : L det A.
struct Viscous { stress: mat3x3r, power: real }

// From L det A, whose factor goes to eta.
fn viscous_stress(l: mat3x3r, det_a: real, weight: real) -> Viscous {
    let factor = eta * weight / det_a;
    let past = step.dt_before / det_a;
    let off = vec3r(l[0][1] + l[1][0], l[0][2] + l[2][0], l[1][2] + l[2][1]);
    let s = factor * (off - past * vec3r(dot(l[0], l[1]), dot(l[0], l[2]), dot(l[1], l[2])));
    let normal = 2.0 * vec3r(l[0][0], l[1][1], l[2][2]) - past * vec3r(dot(l[0], l[0]), dot(l[1], l[1]), dot(l[2], l[2]));
    let mean = 0.3333333333333333 * (normal.x + normal.y + normal.z);
    let d = factor * (normal - vec3r(mean));
    let power = d.x * l[0][0] + d.y * l[1][1] + d.z * l[2][2] + dot(s, off);
    return Viscous(mat3x3r(vec3r(d.x, s.x, s.y), vec3r(s.x, d.y, s.z), vec3r(s.y, s.z, d.z)), power);
}

// Rate of a vector q that turns with the body: dq/dt + L^T (q - dt dq/dt).
fn turning(l: mat3x3r, det_a: real, q: vec3r, rate: vec3r) -> vec3r {
    return rate + ((q - step.dt_before * rate) * l) * (1.0 / det_a);
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

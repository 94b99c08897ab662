// sigma_v = eta (L + L^T - 2/3 tr(L) I), L = (dA/dt) A^-1; twin of src/physics/material/viscosity.rs.

override eta: real;

// Force matrix sigma_v cof(A) and power sigma_v : L det A.
struct Viscous { g: mat3x3r, power: real }

fn viscous_stress(a: mat3x3r, a_dot: mat3x3r) -> Viscous {
    let cof = cofactor(a);
    let det_a = dot(a[0], cof[0]);
    let l = a_dot * transpose(cof) * (1.0 / det_a);
    let trace = l[0][0] + l[1][1] + l[2][2];
    let mean = 0.6666666666666667 * trace;
    var sigma = l + transpose(l);
    sigma[0][0] -= mean;
    sigma[1][1] -= mean;
    sigma[2][2] -= mean;
    sigma = sigma * eta;
    let power = dot(sigma[0], l[0]) + dot(sigma[1], l[1]) + dot(sigma[2], l[2]);
    return Viscous(sigma * cof, power * det_a);
}

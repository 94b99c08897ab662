// What both routines of the uniform gradient share; twin of src/physics/element/uniform_gradient.rs.

alias Class = MeanClass;

fn identity() -> Sym {
    return Sym(vec3r(1.0), vec3r(0.0));
}

// Mean gradient and hourglass modes of a field.
struct Modes { f: mat3x3r, h0: vec3r, h1: vec3r, h2: vec3r, h3: vec3r }

// Columns of the mean first Piola stress, the cofactor of the mean gradient and its determinant.
struct MeanStress { p: mat3x3r, cof: mat3x3r, j: real }

fn mean_stress(f: mat3x3r) -> MeanStress {
    let cof = cofactor(f);
    let j = dot(f[0], cof[0]);
    let k = invariants(identity(), gram(f));
    let d = derivatives(k.i1, k.i2, j);
    return MeanStress(times(f, second_piola(k, d, identity(), 1.0)) + cof * (d.z + dU(j)), cof, j);
}

fn element_energy(low: Face, high: Face, shape: u32) -> vec3r {
    let m = modes(offsets_of(low, high), shape);
    let g = gram(m.f);
    let s = strain_of(full(Sym(g.d - vec3r(1.0), g.o)));
    let q2 = dot(m.h0, m.h0) + dot(m.h1, m.h1) + dot(m.h2, m.h2) + dot(m.h3, m.h3);
    return vec3r(
        classes[shape].volume * (psi(s) + U(s.dilatation)),
        0.5 * classes[shape].hourglass_stiffness * q2,
        determinant(m.f));
}

// A Prony series on the isochoric stress; twin of src/physics/material/relaxation.rs.

override prony_terms: u32;
// Of the law [Pa].
override prony_modulus: real;
// Elements, and points of each.
override memory_elements: u32;
override memory_points: u32;

// By step of the submission and term: relative modulus r, what is left of a stress after half of the step before and of the step
// that follows, r / (2 G tau).
var<storage, read_write> fading: array<vec4r>;
// Stress that has relaxed [Pa]: by point, term, number of a symmetric matrix and element; then what each element has lost [J].
var<storage, read_write> memory: array<real>;
// Sums of the window by chain: energy lost [J].
var<storage, read_write> viscous_loss: array<real>;

// The element whose forces are computed, and whether what relaxes in it is kept.
var<private> present: u32;
var<private> keeping: bool;
// Work of its overstress since the positions before [J], and power that it has lost [W]; and of the chain so far [J].
var<private> present_work: real;
var<private> present_loss: real;
var<private> chain_work: real;
var<private> chain_loss: real;

// From here on forces are those of the element number `level` of a chain; `own`: no other thread's.
fn recall(chain: Chain, level: u32, own: bool) {
    present = element_at(chain, level);
    keeping = own && step.keeps != 0u;
    present_work = 0.0;
    present_loss = 0.0;
}

fn memory_at(q: u32, k: u32) -> u32 {
    return (q * prony_terms + k) * 6u * memory_elements + present;
}

fn relaxed_at(at: u32) -> Sym {
    return Sym(
        vec3r(memory[at], memory[at + memory_elements], memory[at + 2u * memory_elements]),
        vec3r(memory[at + 3u * memory_elements], memory[at + 4u * memory_elements], memory[at + 5u * memory_elements]));
}

fn keep_at(at: u32, s: Sym) {
    memory[at] = s.d.x;
    memory[at + memory_elements] = s.d.y;
    memory[at + 2u * memory_elements] = s.d.z;
    memory[at + 3u * memory_elements] = s.o.x;
    memory[at + 4u * memory_elements] = s.o.y;
    memory[at + 5u * memory_elements] = s.o.z;
}

fn sum_of(a: Sym, c: real, b: Sym) -> Sym {
    return Sym(a.d + c * b.d, a.o + c * b.o);
}

fn contraction(a: Sym, b: Sym) -> real {
    return dot(a.d, b.d) + 2.0 * dot(a.o, b.o);
}

// tr (A B A B) - 1/3 (tr A B)^2
fn deviator_squared(a: Sym, b: Sym) -> real {
    let m = full(a) * full(b);
    let trace = m[0][0] + m[1][1] + m[2][2];
    let diagonal = vec3r(m[0][0], m[1][1], m[2][2]);
    let off = m[0][1] * m[1][0] + m[0][2] * m[2][0] + m[1][2] * m[2][1];
    return dot(diagonal, diagonal) + 2.0 * off - 0.3333333333333333 * trace * trace;
}

// Half the change of A^T A since the positions before.
fn change_of(a: mat3x3r, rate: mat3x3r) -> Sym {
    let dt = step.dt_before;
    let g = transpose(a) * rate;
    let square = gram(rate);
    let diagonal = vec3r(g[0][0], g[1][1], g[2][2]) - (0.5 * dt) * square.d;
    let off = 0.5 * vec3r(g[0][1] + g[1][0], g[0][2] + g[2][0], g[1][2] + g[2][1]) - (0.5 * dt) * square.o;
    return Sym(dt * diagonal, dt * off);
}

// Second Piola stress but for what goes with cof A, and what does, times det A / det J [Pa].
struct Overstress { stress: Sym, pressure: real }

// What the terms add at a point of volume dv whose isochoric stress is `isochoric` and WJ; they go on by a step, if that is kept.
fn overstress(at: Deformed, isochoric: Sym, wj: real, dv: real) -> Overstress {
    let r = recip_cbrt(at.j);
    let of_cof = gram(at.cof);
    let scale = 1.0 / (at.det_a * at.det_a);
    let inverse = Sym(of_cof.d * scale, of_cof.o * scale);
    let pressed = sum_of(isochoric, wj * at.j, inverse);
    let up = at.j * r;
    let elastic = Sym(up * pressed.d, up * pressed.o);
    var sum = Sym(vec3r(0.0), vec3r(0.0));
    var middle = sum;
    var loss: real = 0.0;
    var stiffness: real = 0.0;
    for (var k = 0u; k < prony_terms; k++) {
        let term = fading[step.slot * prony_terms + k];
        let place = memory_at(at.q, k);
        let of_middle = sum_of(elastic, -1.0, relaxed_at(place));
        let h = Sym(term.y * of_middle.d, term.y * of_middle.o);
        if keeping {
            keep_at(place, sum_of(elastic, -term.z, h));
        }
        sum = sum_of(sum, term.x, h);
        middle = sum_of(middle, term.x, of_middle);
        loss += term.w * deviator_squared(h, at.gram);
        stiffness += term.x * prony_modulus;
    }
    let down = r * r;
    let stress = Sym(down * sum.d, down * sum.o);
    let change = change_of(at.a, at.rate);
    let turned = contraction(at.gram, middle) * contraction(inverse, change);
    let shape = contraction(middle, change) - 0.3333333333333333 * turned;
    present_work += dv * down * (shape - stiffness * deviator_squared(change, inverse));
    present_loss += dv * loss;
    return Overstress(stress, -0.3333333333333333 * contraction(at.gram, stress));
}

// Adds up what the element has done, which loses the viscous `power` too.
fn lose(power: real) {
    let loss = step.viscous_weight * (power + present_loss);
    chain_work += present_work;
    chain_loss += loss;
    if keeping {
        memory[6u * memory_points * prony_terms * memory_elements + present] += loss;
    }
}

// In the viscous work and loss of the window.
fn book_memory(chain: u32) {
    viscous_work[of_chains(chain)] -= chain_work;
    viscous_loss[of_chains(chain)] += chain_loss;
}

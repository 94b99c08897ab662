//! Homogeneous states of one element at stretches from 0.3 to 3, in every law and formulation.
//!
//! Closed forms: Cauchy stress in principal axes from the energies of eqs. 4-6, and the textbook's incompressible
//! neo-Hookean solid (Treloar, The Physics of Rubber Elasticity, ch. 4): sigma = G (l^2 - 1/l) in uniaxial,
//! G (l^2 - l^-4) in equibiaxial tension, G g in simple shear.

use crate::report::{Case, Claim};
use crate::rig::{G, KAPPA, block};
use hexroll::Result;
use hexroll::model::Model;
use hexroll::physics::element::hex8;
use hexroll::physics::material::{ArrudaBoyce, MooneyRivlin, MooneyRivlinEq4, NeoHookean, Ogden, Yeoh};
use hexroll::scene::{Element, Law};

pub const CASE: Case = Case {
    name: "constitutive",
    theorem: "every_law_has_its_closed_form_stresses_up_to_threefold_stretch",
    title: "One element stretched, sheared, compressed",
    source: "principal stresses of the energies (eqs. 4-6); Treloar's incompressible neo-Hookean solid",
    setup: "unit cube, one element, corner positions prescribed; uniaxial and equibiaxial stretch 0.3 to 3 with free \
            sides, simple shear 0.3 to 3, volume ratio 0.3 to 3; every law, three formulations",
    everyday: true,
    run,
};

/// One of each law.
fn laws() -> impl Iterator<Item = Law> {
    Law::KINDS.iter().map(|kind| (kind.example)(G, KAPPA))
}

const ELEMENTS: [Element; 3] = [Element::Q1p0, Element::Full, Element::UniformGradient { hourglass: 0.15 }];
const STRETCHES: [f64; 6] = [0.3, 0.5, 0.8, 1.25, 2.0, 3.0];

type Matrix = [[f64; 3]; 3];

/// Volume mean of the Cauchy stress of a cube deformed by F (columns).
fn cauchy(model: &Model, F: &Matrix) -> Matrix {
    let x = model.mesh.hexes[0].map(|n| {
        let X = model.mesh.nodes[n as usize];
        std::array::from_fn(|i| (0..3).map(|c| F[c][i] * X[c]).sum::<f64>())
    });
    let f = model.element_forces(0, &x, &[[0.0; 3]; 8]);
    let volume = hex8::volume(&x);
    std::array::from_fn(|j| std::array::from_fn(|i| (0..8).map(|a| f[a][i] * x[a][j]).sum::<f64>() / volume))
}

fn diagonal(l: [f64; 3]) -> Matrix {
    std::array::from_fn(|c| std::array::from_fn(|i| if i == c { l[c] } else { 0.0 }))
}

/// Principal Cauchy stresses at principal stretches, by the formulae of the energies.
fn principal(law: &Law, l: [f64; 3]) -> [f64; 3] {
    let J: f64 = l.iter().product();
    let b = l.map(|l| l * l);
    match *law {
        Law::MooneyRivlinEq4(MooneyRivlinEq4 { g0, g1, g2 }) => {
            b.map(|b| (g0 * (J - 1.0) + g1 * (b - 1.0) - g2 * (1.0 / b - 1.0)) / J)
        }
        Law::NeoHookean(NeoHookean { g0, g1 }) => split(g0, g1, 0.0, J, b),
        Law::MooneyRivlin(MooneyRivlin { g0, g1, g2 }) => split(g0, g1, g2, J, b),
        Law::Yeoh(Yeoh { c10, c20, c30, bulk_modulus }) => {
            // g1 is 2 dW/dI at this I.
            let e = b.iter().sum::<f64>() * J.powf(-2.0 / 3.0) - 3.0;
            split(bulk_modulus, 2.0 * (c10 + 2.0 * c20 * e + 3.0 * c30 * e * e), 0.0, J, b)
        }
        Law::ArrudaBoyce(law) => {
            let i = b.iter().sum::<f64>() * J.powf(-2.0 / 3.0);
            let volumetric = 0.5 * law.bulk_modulus * (J - 1.0 / J);
            split(0.0, chains(&law, i), 0.0, J, b).map(|s| s + volumetric)
        }
        Law::Ogden(law) => {
            let t = powers(&law, l.map(|l| l * J.powf(-1.0 / 3.0)));
            let mean = t.iter().sum::<f64>() / 3.0;
            t.map(|t| law.bulk_modulus * (J - 1.0) + (t - mean) / J)
        }
    }
}

/// 2 dW/dI of the five terms as Arruda and Boyce print them.
fn chains(law: &ArrudaBoyce, i: f64) -> f64 {
    let terms =
        [(1.0, 0.5), (2.0, 0.05), (3.0, 11.0 / 1050.0), (4.0, 19.0 / 7000.0), (5.0, 519.0 / 673_750.0)];
    let term = |(n, c): (f64, f64)| n * c * law.lambda_m.powf(2.0 - 2.0 * n) * i.powf(n - 1.0);
    2.0 * law.mu * terms.map(term).iter().sum::<f64>()
}

/// l dW/dl = sum 2 mu / alpha l^alpha at stretches whose product is 1.
fn powers(law: &Ogden, l: [f64; 3]) -> [f64; 3] {
    let terms = [(law.mu1, law.alpha1), (law.mu2, law.alpha2), (law.mu3, law.alpha3)];
    l.map(|l| terms.iter().map(|(mu, alpha)| 2.0 * mu / alpha * l.powf(*alpha)).sum())
}

/// g0 (J - 1) + dev[g1 b' + g2 (I1' b' - b'^2)] / J with b' = J^(-2/3) b.
fn split(g0: f64, g1: f64, g2: f64, J: f64, b: [f64; 3]) -> [f64; 3] {
    let b = b.map(|b| b * J.powf(-2.0 / 3.0));
    let sum: f64 = b.iter().sum();
    let t = b.map(|b| g1 * b + g2 * (sum * b - b * b));
    let mean = t.iter().sum::<f64>() / 3.0;
    t.map(|t| g0 * (J - 1.0) + (t - mean) / J)
}

/// The stretch of the free directions that leaves them without stress; bisection, since the stress grows with it.
fn free_stretch(stress: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.05, 20.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if stress(middle) > 0.0 { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

/// Largest error of any stress component over the modes, relative to the largest stress or kappa.
fn worst(law: &Law, element: Element) -> Result<[f64; 4]> {
    let mut scene = block([1.0; 3], [1; 3]);
    (scene.body.law, scene.body.element) = (*law, element);
    let model = Model::new(&scene)?;
    let off = |F: &Matrix, expected: &Matrix| {
        let got = cauchy(&model, F);
        let scale = expected.iter().flatten().fold(KAPPA, |m, s| m.max(s.abs()));
        let errors = got.iter().flatten().zip(expected.iter().flatten()).map(|(a, b)| (a - b).abs() / scale);
        errors.fold(0.0, f64::max)
    };
    let mut all = [0.0f64; 4];
    for l in STRETCHES {
        let t = free_stretch(|t| principal(law, [l, t, t])[1]);
        let states = [[l, t, t], {
            let t = free_stretch(|t| principal(law, [l, l, t])[2]);
            [l, l, t]
        }];
        for (k, state) in states.into_iter().enumerate() {
            all[k] = all[k].max(off(&diagonal(state), &diagonal(principal(law, state))));
        }
        let (F, expected) = sheared(law, l);
        all[2] = all[2].max(off(&F, &expected));
        let v = [l.cbrt(); 3];
        all[3] = all[3].max(off(&diagonal(v), &diagonal(principal(law, v))));
    }
    Ok(all)
}

/// Simple shear by g, and its stress: J = 1, B = [[1 + g^2, g], [g, 1]].
fn sheared(law: &Law, g: f64) -> (Matrix, Matrix) {
    let F = [[1.0, 0.0, 0.0], [g, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let (g1, g2, deviatoric) = match *law {
        Law::NeoHookean(NeoHookean { g1, .. }) => (g1, 0.0, true),
        Law::MooneyRivlin(MooneyRivlin { g1, g2, .. }) => (g1, g2, true),
        Law::MooneyRivlinEq4(MooneyRivlinEq4 { g1, g2, .. }) => (g1, g2, false),
        // I - 3 = g^2
        Law::Yeoh(Yeoh { c10, c20, c30, .. }) => {
            (2.0 * (c10 + 2.0 * c20 * g * g + 3.0 * c30 * g.powi(4)), 0.0, true)
        }
        Law::ArrudaBoyce(law) => (chains(&law, 3.0 + g * g), 0.0, true),
        Law::Ogden(law) => return (F, sheared_by_powers(&law, g)),
    };
    let mean = if deviatoric { (g1 - g2) * g * g / 3.0 } else { 0.0 };
    let shear = (g1 + g2) * g;
    let normal = [g1 * g * g - mean, -g2 * g * g - mean, -mean];
    (F, [[normal[0], shear, 0.0], [shear, normal[1], 0.0], [0.0, 0.0, normal[2]]])
}

/// The deviator of principal stresses along the axes of simple shear: of stretches l, 1/l and 1 with l - 1/l = g, l at the angle
/// a from the x axis with tan a = 1/l.
fn sheared_by_powers(law: &Ogden, g: f64) -> Matrix {
    let l = 0.5 * (g + (g * g + 4.0).sqrt());
    let t = powers(law, [l, 1.0 / l, 1.0]);
    let mean = t.iter().sum::<f64>() / 3.0;
    let [t1, t2, t3] = t.map(|t| t - mean);
    let (c, s) = (l / (l * l + 1.0).sqrt(), 1.0 / (l * l + 1.0).sqrt());
    let shear = (t1 - t2) * c * s;
    [[t1 * c * c + t2 * s * s, shear, 0.0], [shear, t1 * s * s + t2 * c * c, 0.0], [0.0, 0.0, t3]]
}

fn run() -> Result<Vec<Claim>> {
    const REASON: &str = "round-off: some hundred operations, J^(-2/3) and B^-1 up to 11";
    let modes = ["uniaxial", "equibiaxial", "simple shear", "volumetric"];
    let mut claims = Vec::new();
    for law in &laws().collect::<Vec<_>>() {
        let mut all = [0.0f64; 4];
        for element in ELEMENTS {
            let found = worst(law, element)?;
            all = std::array::from_fn(|k| all[k].max(found[k]));
        }
        for (mode, error) in modes.iter().zip(all) {
            let what = format!("{}, {mode}: largest stress error over max(kappa, stress)", law.name());
            claims.push(Claim::at_most(what, "", error, 1e-12, REASON));
        }
    }
    claims.extend(incompressible()?);
    Ok(claims)
}

/// The textbook's incompressible solid, approached with kappa = 1e7 G.
fn incompressible() -> Result<Vec<Claim>> {
    const REASON: &str = "kappa = 1e7 G leaves a volume strain of sigma / kappa, up to 4e-6 here";
    let law = Law::NeoHookean(NeoHookean { g0: 1e7 * G, g1: G });
    let mut scene = block([1.0; 3], [1; 3]);
    scene.body.law = law;
    let model = Model::new(&scene)?;
    let mut claims = Vec::new();
    for l in [0.3f64, 3.0] {
        let t = free_stretch(|t| principal(&law, [l, t, t])[1]);
        let got = cauchy(&model, &diagonal([l, t, t]))[0][0];
        let what = format!("uniaxial stretch {l}: sigma / G");
        claims.push(Claim::relative(what, "", got / G, l * l - 1.0 / l, 1e-4, REASON));
        let t = free_stretch(|t| principal(&law, [l, l, t])[2]);
        let got = cauchy(&model, &diagonal([l, l, t]))[0][0];
        let what = format!("equibiaxial stretch {l}: sigma / G");
        claims.push(Claim::relative(what, "", got / G, l * l - l.powi(-4), 1e-4, REASON));
    }
    let got = cauchy(&model, &sheared(&law, 3.0).0)[0][1];
    claims.push(Claim::relative("simple shear 3: tau / G", "", got / G, 3.0, 1e-9, REASON));
    Ok(claims)
}

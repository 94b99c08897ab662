//! Law level: internal forces of one element pass and its gather.
//!
//! A block whose reference shape is distorted, so that every element is its own shape class and no entry of a metric
//! vanishes, in a state with strains and rates of the order of 10 %. The bulk modulus is four shear moduli, so that a
//! change of any constant shows.

use crate::rig::{self, Who, noise, note, relative, scene};
use hexroll::gpu::Gpu;
use hexroll::model::Model;
use hexroll::model::mesh::Mesh;
use hexroll::physics::material::{MooneyRivlin, Ogden, Yeoh};
use hexroll::physics::parameters::Parameter;
use hexroll::scene::{Body, Element, Law, MeshSpec, Scene};
use hexroll_lab::rig::{ELEMENTS, G, by_the_book, laws_of};

/// Relative L2 error of the forces. Single precision leaves 6e-8 of a coordinate of 30 mm, which is 2e-7 of an edge of
/// 9 mm where strains are 0.1, and as much again in J - 1: about 2e-6. Measured 0.5e-6 to 2.5e-6, as on the CPU in f32,
/// and with pairs no less: they save the positions, not the arithmetic.
const TOLERANCE: f64 = 5e-6;

/// One of each law, with a bulk modulus that does not drown the rest in rounding, and constants of Yeoh's and Ogden's laws that
/// show beside a viscosity.
fn laws() -> Vec<Law> {
    let strong = |law| match law {
        Law::Yeoh(yeoh) => Yeoh { c20: 2.0 * G, c30: 30.0 * G, ..yeoh }.into(),
        Law::Ogden(ogden) => {
            let [mu1, mu2, mu3] = [4.0 * G; 3];
            Ogden { mu1, alpha1: 9.0, mu2, alpha2: 5.0, mu3, alpha3: -7.0, ..ogden }.into()
        }
        other => other,
    };
    laws_of(G, 10e6).map(strong).collect()
}

struct Case {
    /// Whether its elements are plane figures extruded along y.
    extruded: bool,
    scene: Scene,
    mesh: Mesh,
    x: Vec<[f64; 3]>,
    v: Vec<[f64; 3]>,
}

fn case() -> Case {
    let scene = scene(
        "spinning_block",
        &["body.mesh.size=[\"30 mm\", \"27 mm\", \"24 mm\"]", "body.mesh.elements=[3, 3, 3]"],
    );
    let mut mesh = Mesh::generate(&scene.body.mesh);
    let mut random = noise(7);
    let mut moved = |x: &[f64; 3], scale: f64| {
        let by = random.within(scale);
        std::array::from_fn(|d| x[d] + by[d])
    };
    mesh.nodes = mesh.nodes.iter().map(|x| moved(x, 0.8e-3)).collect();
    let stretched = |x: &[f64; 3]| [1.05 * x[0] + 0.08 * x[1], 0.97 * x[1] - 0.05 * x[2], x[2] + 0.06 * x[0]];
    let x = mesh.nodes.iter().map(|x| moved(&stretched(x), 0.5e-3)).collect();
    let v = mesh.nodes.iter().map(|_| random.within(20.0)).collect();
    Case { extruded: false, scene, mesh, x, v }
}

/// The same of plane figures extruded along y, the meshes' eta: a metric has its entry xz alone.
fn extruded() -> Case {
    let mut case = Case { extruded: true, ..case() };
    let mut random = noise(13);
    let shifts: Vec<[f64; 3]> = (0..16).map(|_| random.within(0.8e-3)).collect();
    case.mesh = Mesh::generate(&case.scene.body.mesh);
    for (n, x) in case.mesh.nodes.iter_mut().enumerate() {
        // Four nodes along x, y and z each.
        let by = shifts[n / 16 * 4 + n % 4];
        *x = [x[0] + by[0], x[1], x[2] + by[2]];
    }
    case
}

impl Case {
    fn model(&self, body: &Body) -> Model {
        Model::from_mesh(self.mesh.clone(), body).expect("the distorted elements are not inside out")
    }

    fn forces(&self, gpu: &Gpu, who: Who, body: &Body) -> Vec<[f64; 3]> {
        let model = self.model(body);
        let mut engine = rig::engine(gpu, who, &model, &self.scene);
        // Whatever the next call does not write stays NaN.
        let poison = vec![[f64::NAN; 3]; self.x.len()];
        let spoilt = engine.force(&poison, &poison).unwrap();
        assert!(spoilt.iter().flatten().all(|f| f.is_nan()), "forces of NaN positions are not NaN");
        engine.force(&self.x, &self.v).unwrap()
    }
}

/// The body with one constant off by 0.1 % (hourglass stiffness: 1 %), by name.
fn mutants(body: &Body) -> Vec<(&'static str, Body)> {
    let (parameters, values) = body.law.parameters();
    let mutant = |(i, p): (usize, &Parameter)| {
        let mut values = values.clone();
        values[i] *= 1.001;
        let law = (body.law.kind().from_values)(&values).expect("still a law");
        (p.key, Body { law, ..body.clone() })
    };
    let mut all: Vec<_> = parameters.iter().enumerate().map(mutant).collect();
    if let Some(eta) = body.viscosity {
        all.push(("eta", Body { viscosity: Some(1.001 * eta), ..body.clone() }));
    }
    if let Element::UniformGradient { hourglass } = body.element {
        let element = Element::UniformGradient { hourglass: 1.01 * hourglass };
        all.push(("hourglass", Body { element, ..body.clone() }));
    }
    all
}

fn check(gpu: &Gpu, case: &Case, who: Who, body: &Body, tolerance: f64) {
    let name = format!("{who:?} {:?} {} eta {:?}", body.element, body.law.name(), body.viscosity);
    let exact = case.forces(gpu, Who::Cpu64, body);
    let got = case.forces(gpu, who, body);
    let error = relative(&got, &exact);
    note(|| {
        let single = relative(&case.forces(gpu, Who::Cpu32, body), &exact);
        format!("{name}: {error:.1e}, CPU f32 {single:.1e}")
    });
    assert!(error < tolerance, "{name}: {error:.2e}");
    if body.element == Element::Q1p0 && body.viscosity.is_none() {
        let error = relative(&got, &by_the_book(&case.model(body), &case.x));
        assert!(error < tolerance, "{name}: {error:.2e} from the textbook's");
    }
    for (constant, mutant) in mutants(body) {
        let error = relative(&got, &case.forces(gpu, Who::Cpu64, &mutant));
        assert!(error > 5.0 * tolerance, "{name}: {constant} off and an error of only {error:.2e}");
    }
}

/// The mesh less its elements at x = y = 0 (a column, or all of a mesh that has no more): no lattice, if that leaves any.
pub fn notched(mesh: &Mesh) -> Option<Mesh> {
    let at_edge = |h: &&[u32; 8]| [0, 1].iter().all(|&d| mesh.nodes[h[0] as usize][d].abs() < 2e-3);
    let hexes: Vec<[u32; 8]> = mesh.hexes.iter().filter(|h| !at_edge(h)).copied().collect();
    let mut number = vec![None; mesh.nodes.len()];
    let mut nodes = Vec::new();
    for &n in hexes.iter().flatten() {
        if number[n as usize].is_none() {
            number[n as usize] = Some(nodes.len() as u32);
            nodes.push(mesh.nodes[n as usize]);
        }
    }
    let hexes: Vec<[u32; 8]> =
        hexes.iter().map(|h| h.map(|n| number[n as usize].expect("it has been met"))).collect();
    (!hexes.is_empty()).then(|| Mesh { nodes, hexes, facets: vec![], surface: vec![], ..mesh.clone() })
}

/// The mesh with node n as node 7 n + 3 and elements in another order.
fn renumbered(mesh: &Mesh) -> Mesh {
    let (nodes, elements) = (mesh.nodes.len(), mesh.hexes.len());
    assert!(!nodes.is_multiple_of(7) && !elements.is_multiple_of(11), "the strides would not meet all");
    let number: Vec<u32> = (0..nodes).map(|n| ((7 * n + 3) % nodes) as u32).collect();
    let mut other = mesh.clone();
    for (n, x) in mesh.nodes.iter().enumerate() {
        other.nodes[number[n] as usize] = *x;
    }
    other.hexes = (0..elements).map(|e| mesh.hexes[11 * e % elements].map(|n| number[n as usize])).collect();
    other.facets = mesh.facets.iter().map(|f| f.map(|n| number[n as usize])).collect();
    other.surface = mesh.surface.iter().map(|&n| number[n as usize]).collect();
    other.surface.sort_unstable();
    other
}

/// Meshes whose numbers a shader computes with, under these numbers and others, and meshes with tables: one element thick, taller than one chain (the
/// last one shorter), more than one work group wide with rows that end within one, a ring, of few shape classes and of one a
/// element; laid out as for a software adapter and as for others.
pub fn every_numbering(gpu: &Gpu) {
    numberings(gpu, &["lattice", "mixed", "table"]);
    // Tables are the same there, and other numbers become the lattice's.
    numberings(&rig::as_hardware(gpu), &["lattice"]);
}

fn numberings(gpu: &Gpu, kinds: &[&str]) {
    let block = |elements: [usize; 3]| MeshSpec::Block { size: elements.map(|n| 0.01 * n as f64), elements };
    let ring = MeshSpec::Ring { outer_radius: 0.08, inner_radius: 0.05, width: 0.04, elements: [46, 4, 3] };
    let blocks = [[3, 4, 37], [1, 1, 40], [9, 10, 2], [2, 1, 1]].map(block);
    for spec in blocks.into_iter().chain([ring]) {
        for distorted in [false, true] {
            let mut case = case();
            case.mesh = Mesh::generate(&spec);
            let mut random = noise(11);
            if distorted {
                for x in &mut case.mesh.nodes {
                    let by = random.within(0.8e-3);
                    *x = std::array::from_fn(|d| x[d] + by[d]);
                }
            }
            let whole = case.mesh.clone();
            for (kind, mesh) in [
                ("lattice", Some(whole.clone())),
                ("mixed", Some(renumbered(&whole))),
                ("table", notched(&whole)),
            ] {
                let Some(mesh) = mesh.filter(|_| kinds.contains(&kind)) else { continue };
                case.mesh = mesh;
                let nodes = &case.mesh.nodes;
                let moved = |x: &[f64; 3], by: [f64; 3]| std::array::from_fn(|d| x[d] + by[d]);
                case.x = nodes.iter().map(|x| moved(x, random.within(0.5e-3))).collect();
                case.v = nodes.iter().map(|_| random.within(20.0)).collect();
                let body = Body { viscosity: Some(400.0), ..case.scene.body.clone() };
                let [exact, plain, plus] =
                    [Who::Cpu64, Who::Gpu, Who::Plus].map(|who| case.forces(gpu, who, &body));
                // Plain: a coordinate of 0.4 m is rounded to 1.5e-8 m, of an edge of 10 mm whose strains are 0.1: 1.5e-5.
                let errors = [relative(&plain, &exact), relative(&plus, &exact)];
                let name =
                    format!("{spec:?}, distorted {distorted}, {kind}: {:.1e}, {:.1e}", errors[0], errors[1]);
                note(|| name.clone());
                assert!(errors[0] < 5e-5 && errors[1] < TOLERANCE, "{name}");
            }
        }
    }
}

/// Whether a law's programs take a software adapter many seconds to compile. Elements of any shape without viscosity have all of its
/// code.
fn is_long(law: &Law) -> bool {
    matches!(law, Law::Ogden(_))
}

/// Every element, law and viscosity in plain f32, on elements of any shape and on extruded ones; laws whose programs are long on those of
/// any shape without viscosity.
pub fn every_composition(gpu: &Gpu) {
    let cases = [case(), extruded()];
    let models = cases.each_ref().map(|case| case.model(&case.scene.body));
    assert_eq!(models.each_ref().map(|m| m.classes.len()), [27, 9]);
    assert_eq!(models.each_ref().map(Model::is_extruded), [false, true]);
    for case in cases {
        for element in ELEMENTS {
            for law in laws() {
                for viscosity in [None, Some(400.0)] {
                    if is_long(&law) && (viscosity.is_some() || case.extruded) {
                        continue;
                    }
                    let body = Body { element, law, viscosity, ..case.scene.body.clone() };
                    check(gpu, &case, Who::Gpu, &body, TOLERANCE);
                }
            }
        }
    }
}

/// Ogden's law with the powers 2 and -2, which a scene would have turned into the Mooney-Rivlin law, has the forces of that law:
/// they differ by the rounding of W1 and W2, some ten units of 6e-8 of G.
pub fn ogden_is_mooney_rivlin(gpu: &Gpu) {
    let case = case();
    let (g0, g1, g2) = (10e6, 0.7 * G, 0.3 * G);
    let mooney = Law::MooneyRivlin(MooneyRivlin { g0, g1, g2 });
    let terms =
        Ogden { mu1: g1, alpha1: 2.0, mu2: g2, alpha2: -2.0, mu3: 0.0, alpha3: 0.0, bulk_modulus: g0 };
    for element in [ELEMENTS[0], ELEMENTS[2]] {
        let [ogden, mooney] = [Law::Ogden(terms), mooney].map(|law| {
            case.forces(gpu, Who::Gpu, &Body { element, law, viscosity: None, ..case.scene.body.clone() })
        });
        let error = relative(&ogden, &mooney);
        note(|| format!("{element:?}: {error:.1e}"));
        assert!(error < 1e-6, "{element:?}: {error:.1e}");
    }
}

/// In double precision: rounding of 1e-16 of a coordinate is 1e-15 of a strain of 0.1. Measured 1e-15 to 3e-15.
const TOLERANCE_DOUBLE: f64 = 1e-13;

/// Every element and law in double precision, with and without viscosity by turns; long laws on one element.
pub fn doubles(gpu: &Gpu) {
    let case = case();
    for (k, element) in ELEMENTS.into_iter().enumerate() {
        for (j, law) in laws().into_iter().enumerate() {
            // Of a long one the element with one point has all of the law's code.
            if is_long(&law) && !matches!(element, Element::UniformGradient { .. }) {
                continue;
            }
            let viscosity = ((k + j) % 2 == 0).then_some(400.0);
            let body = Body { element, law, viscosity, ..case.scene.body.clone() };
            check(gpu, &case, Who::Double, &body, TOLERANCE_DOUBLE);
        }
    }
}

/// Positions as pairs change what is loaded, once for elements with points and once for the one without. A body a
/// metre away from the origin of the frame has the same forces; single precision has lost two digits there.
pub fn pairs(gpu: &Gpu) {
    let near = case();
    let away = |x: &[[f64; 3]]| x.iter().map(|x| x.map(|c| c + 1.0)).collect::<Vec<_>>();
    let far = Case { x: away(&near.x), ..case() };
    let laws = laws();
    for (element, law, viscosity) in [
        (ELEMENTS[0], laws[1], None),
        (ELEMENTS[1], laws[2], Some(400.0)),
        (ELEMENTS[2], laws[0], Some(400.0)),
    ] {
        let body = Body { element, law, viscosity, ..near.scene.body.clone() };
        check(gpu, &near, Who::Plus, &body, TOLERANCE);
        check(gpu, &far, Who::Plus, &body, TOLERANCE);
        let [single, exact] = [Who::Gpu, Who::Cpu64].map(|who| far.forces(gpu, who, &body));
        let error = relative(&single, &exact);
        assert!(error > 5.0 * TOLERANCE, "{element:?}: plain positions are off by {error:.2e} only");
    }
}

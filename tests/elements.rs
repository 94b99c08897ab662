//! The element formulations: forces from energies, rigid motion, balance, shape classes, mass.
#![allow(non_snake_case)] // X, R: the field's own symbols

use hexroll::model::Model;
use hexroll::model::mesh::{Mesh, SIGNS};
use hexroll::physics::element::{Class, Compose, Composition, Corners, Energy, Force, Formulation};
use hexroll::physics::material::{Forgetful, Hyperelastic, Viscosity};
use hexroll::physics::tensor::{Mat3, Vec3, add, cross, dot};
use hexroll::scene::{Body, Element, Law, Lumping};
use hexroll_lab::rig::given::{DENSITY, INNER_RADIUS, OUTER_RADIUS, WIDTH};
use hexroll_lab::rig::{ELEMENTS, G, Random, block, close, largest, laws, times, wheel};

const EDGE: f64 = 2e-3;
const ETA: f64 = 20.0;
const HOURGLASS: f64 = 0.15;

struct ForceAt<'a> {
    class: &'a Class<f64>,
    x: &'a Corners<f64>,
    v: &'a Corners<f64>,
}

impl Compose for ForceAt<'_> {
    type Output = Force<f64>;
    fn with<F: Formulation, L: Hyperelastic, V: Viscosity>(self, law: L, viscosity: V) -> Force<f64> {
        F::force(&law, &viscosity, self.class, self.x, self.v, &mut Forgetful)
    }
}

fn force(
    element: Element,
    law: &Law,
    class: &Class<f64>,
    x: &Corners<f64>,
    v: Option<&Corners<f64>>,
) -> Force<f64> {
    let composition = Composition { element, law: *law, viscosity: v.map(|_| ETA), relaxes: false };
    composition.visit(ForceAt { class, x, v: v.unwrap_or(&[[0.0; 3]; 8]) })
}

struct EnergyAt<'a> {
    class: &'a Class<f64>,
    x: &'a Corners<f64>,
}

impl Compose for EnergyAt<'_> {
    type Output = Energy<f64>;
    fn with<F: Formulation, L: Hyperelastic, V: Viscosity>(self, law: L, _viscosity: V) -> Energy<f64> {
        F::energy(&law, self.class, self.x)
    }
}

fn energy(element: Element, law: &Law, class: &Class<f64>, x: &Corners<f64>) -> Energy<f64> {
    Composition { element, law: *law, viscosity: None, relaxes: false }.visit(EnergyAt { class, x })
}

/// A cube of `EDGE` with every corner moved by up to 15 % of it.
fn distorted(random: &mut Random) -> Corners<f64> {
    SIGNS.map(|s| {
        let by = random.vector();
        std::array::from_fn(|d| EDGE * (0.5 * s[d] + 0.15 * by[d]))
    })
}

/// The element deformed by some 10 %, affinely and not.
fn deformed(random: &mut Random, X: &Corners<f64>) -> Corners<f64> {
    let F = random.near_identity(0.1);
    X.map(|x| {
        let by = random.vector();
        std::array::from_fn(|d| times(&F, x)[d] + 0.05 * EDGE * by[d])
    })
}

fn class(X: &Corners<f64>) -> Class<f64> {
    Class::new(X, HOURGLASS * G, HOURGLASS * ETA).expect("a valid element")
}

/// Rotation about a unit axis (Rodrigues), columns.
fn rotation(axis: Vec3<f64>, angle: f64) -> Mat3<f64> {
    let n = axis.map(|a| a / dot(axis, axis).sqrt());
    let turned = |e: Vec3<f64>| -> Vec3<f64> {
        let (sin, cos) = angle.sin_cos();
        let c = cross(n, e);
        std::array::from_fn(|i| cos * e[i] + sin * c[i] + (1.0 - cos) * dot(n, e) * n[i])
    };
    [turned([1.0, 0.0, 0.0]), turned([0.0, 1.0, 0.0]), turned([0.0, 0.0, 1.0])]
}

/// Every formulation with every law.
fn combinations() -> impl Iterator<Item = (Element, Law)> {
    ELEMENTS.into_iter().flat_map(|e| laws().map(move |l| (e, l)))
}

/// Corner forces are the gradient of the stored energy, hourglass energy included.
#[test]
fn force_is_the_gradient_of_the_energy() {
    let mut random = Random::new(11);
    let X = distorted(&mut random);
    let (c, x) = (class(&X), deformed(&mut random, &X));
    for (element, law) in combinations() {
        let f = force(element, &law, &c, &x, None).f;
        let scale = largest(&f);
        // Central differences: truncation (h/EDGE)^2 = 1e-10 of the stiffness, a few times the force's scale;
        // rounding 1e-16 W/h.
        let h = 1e-5 * EDGE;
        for (a, d) in (0..24).map(|k| (k / 3, k % 3)) {
            let moved = |s: f64| {
                let mut x = x;
                x[a][d] += s;
                let e = energy(element, &law, &c, &x);
                e.strain + e.hourglass
            };
            let difference = (moved(h) - moved(-h)) / (2.0 * h);
            let error = (f[a][d] - difference).abs();
            assert!(
                error < 1e-8 * scale,
                "{element:?} {law:?} corner {a} direction {d}: off by {:e}",
                error / scale
            );
        }
        let e = energy(element, &law, &c, &x);
        assert_eq!(e.hourglass > 0.0, matches!(element, Element::UniformGradient { .. }));
        assert!(e.strain > 0.0 && e.min_j > 0.0);
    }
}

/// The power of an element that turns from `then` to `x` within a step, by velocities that are means over the step.
struct Turned<'a> {
    class: &'a Class<f64>,
    then: &'a Corners<f64>,
    x: &'a Corners<f64>,
    dt: f64,
}

impl Compose for Turned<'_> {
    type Output = f64;
    fn with<F: Formulation, L: Hyperelastic, V: Viscosity>(self, law: L, viscosity: V) -> f64 {
        let v = std::array::from_fn(|a| std::array::from_fn(|d| (self.x[a][d] - self.then[a][d]) / self.dt));
        F::force(&law, &viscosity.over(self.dt), self.class, self.x, &v, &mut Forgetful).viscous_power
    }
}

/// A deformed element, its hourglass modes too, that turns by any angle a step has no viscous power: below 1e-12 of eta w^2 V. (With the plain
/// symmetric part of the velocity gradient it has (w dt)^2 / 3 of that.) Rounding: velocities have 1e-16 / (w dt) of their size,
/// power its square.
#[test]
fn a_rigid_rotation_has_no_viscous_power() {
    let mut random = Random::new(14);
    for angle in [1e-4, 1e-3, 1e-2, 0.1, 1.0, 3.0] {
        let X = distorted(&mut random);
        let (c, shape, axis) = (class(&X), deformed(&mut random, &X), random.vector());
        let at = |turn: f64| shape.map(|x| times(&rotation(axis, turn), x));
        let dt = 1e-5;
        for (element, law) in combinations() {
            let composition = Composition { element, law, viscosity: Some(ETA), relaxes: false };
            let power = composition.visit(Turned { class: &c, then: &at(0.3), x: &at(0.3 + angle), dt });
            let share = power / (ETA * (angle / dt).powi(2) * EDGE.powi(3));
            assert!(share.abs() < 1e-12, "{element:?} {law:?} by {angle}: {share:e}");
        }
    }
}

/// A viscous element's force does exactly the power it reports, which is never negative.
#[test]
fn viscous_power_is_the_work_of_the_viscous_force() {
    let mut random = Random::new(12);
    for _ in 0..20 {
        let X = distorted(&mut random);
        let (c, x) = (class(&X), deformed(&mut random, &X));
        let v: Corners<f64> = std::array::from_fn(|_| random.vector());
        for (element, law) in combinations() {
            let (with, without) =
                (force(element, &law, &c, &x, Some(&v)), force(element, &law, &c, &x, None));
            let work: f64 = (0..8).map(|a| dot(with.f[a], v[a]) - dot(without.f[a], v[a])).sum();
            assert!(with.viscous_power >= 0.0);
            // The elastic force, subtracted, is up to 1e3 times larger: its round-off.
            let tolerance = 1e-13 * largest(&with.f).max(largest(&without.f));
            assert!(
                (work - with.viscous_power).abs() < tolerance,
                "{element:?}: {work} {}",
                with.viscous_power
            );
        }
    }
}

/// A turn by 90 degrees, or by any angle, with a shift makes no force and no hourglass energy, spinning no viscous force.
#[test]
fn a_rigid_motion_makes_no_force() {
    let mut random = Random::new(13);
    let X = distorted(&mut random);
    let c = class(&X);
    for (axis, angle) in [([0.0, 1.0, 0.0], std::f64::consts::FRAC_PI_2), ([0.3, -0.5, 0.8], 2.1)] {
        let R = rotation(axis, angle);
        let shift = random.vector().map(|s| 10.0 * EDGE * s);
        let x = X.map(|X| add(times(&R, X), shift));
        let spin = random.vector();
        let v = x.map(|x| cross(spin, x));
        for (element, law) in combinations() {
            // Round-off of coordinates of 10 EDGE in strain (1e-15), times the bulk modulus and the face area.
            let scale = 65e6 * EDGE * EDGE;
            let elastic = force(element, &law, &c, &x, None).f;
            assert!(
                largest(&elastic) < 2e-14 * scale,
                "{element:?} {law:?}: {:e}",
                largest(&elastic) / scale
            );
            let viscous = force(element, &law, &c, &x, Some(&v)).f;
            assert!(
                largest(&viscous) < 2e-14 * scale,
                "{element:?} {law:?}: {:e}",
                largest(&viscous) / scale
            );
            let e = energy(element, &law, &c, &x);
            assert!(e.hourglass < 1e-28 * scale * EDGE && e.strain.abs() < 1e-14 * scale * EDGE, "{e:?}");
        }
    }
}

/// Forces turn with a stressed element, viscous ones too.
#[test]
fn a_rotation_turns_the_forces_of_a_stressed_element() {
    let mut random = Random::new(14);
    let X = distorted(&mut random);
    let (c, x) = (class(&X), deformed(&mut random, &X));
    let v: Corners<f64> = std::array::from_fn(|_| random.vector());
    for (axis, angle) in [([0.0, 1.0, 0.0], std::f64::consts::FRAC_PI_2), ([0.3, -0.5, 0.8], 2.1)] {
        let R = rotation(axis, angle);
        for (element, law) in combinations() {
            let f = force(element, &law, &c, &x, Some(&v)).f;
            let turned = force(element, &law, &c, &x.map(|x| times(&R, x)), Some(&v.map(|v| times(&R, v)))).f;
            // Round-off of the bulk modulus, which is some ten times the stress.
            let tolerance = 1e-13 * largest(&f);
            for (f, t) in f.iter().zip(&turned) {
                let expected = times(&R, *f);
                assert!(
                    (0..3).all(|d| (expected[d] - t[d]).abs() < tolerance),
                    "{element:?} {law:?}: {t:?} {expected:?}"
                );
            }
        }
    }
}

/// An element's forces and their moments add up to nothing, with hourglass forces, and with viscosity where it is
/// objective: the viscous partner of the hourglass stiffness acts on the rates of the hourglass modes in fixed axes,
/// so it sees the turning of an hourglass-deformed element and its forces, not its moments, vanish.
#[test]
fn forces_and_moments_of_an_element_vanish() {
    let mut random = Random::new(15);
    let X = distorted(&mut random);
    let (c, x) = (class(&X), deformed(&mut random, &X));
    let v: Corners<f64> = std::array::from_fn(|_| random.vector());
    for (element, law) in combinations() {
        let viscous = force(element, &law, &c, &x, Some(&v)).f;
        let total = viscous.iter().fold([0.0; 3], |sum, f| add(sum, *f));
        let objective = !matches!(element, Element::UniformGradient { .. });
        let f = if objective { viscous } else { force(element, &law, &c, &x, None).f };
        let moment = x.iter().zip(&f).fold([0.0; 3], |sum, (x, f)| add(sum, cross(*x, *f)));
        // Two dozen round-offs.
        assert!(largest([&total]) < 1e-14 * largest(&f), "{element:?} {law:?}: {total:?}");
        assert!(largest([&moment]) < 1e-14 * EDGE * largest(&f), "{element:?} {law:?}: {moment:?}");
    }
}

/// The elements of a ring have one shape class a radial layer, those of a block one.
#[test]
fn a_ring_has_one_class_a_radial_layer() {
    let model = Model::new(&wheel([44, 4, 5], 0.0)).unwrap();
    assert_eq!(model.classes.len(), 4);
    for (element, hex) in model.mesh.hexes.iter().enumerate() {
        let [x, _, z] = model.mesh.nodes[hex[0] as usize];
        // The inner corner of layer k is at radius 17 mm + k 5.5 mm.
        let layer = ((x.hypot(z - OUTER_RADIUS) - INNER_RADIUS) / 5.5e-3).round() as u32;
        assert_eq!(model.class_of[element], model.class_of[(layer * 44 * 5) as usize]);
    }
    assert_eq!(Model::new(&block([0.03, 0.02, 0.01], [3, 4, 5])).unwrap().classes.len(), 1);
}

/// Elements of one volume but another shape have classes of their own; a turned and shifted copy has not.
#[test]
fn shape_classes_tell_shapes_apart() {
    let R = rotation([0.3, -0.5, 0.8], 2.1);
    let shapes: [&dyn Fn(Vec3<f64>) -> Vec3<f64>; 4] =
        [&|c| c, &|c| [2.0 * c[0], 0.5 * c[1], c[2]], &|c| [c[0] + 1e-6 * c[1], c[1], c[2]], &|c| {
            add(times(&R, c), [3.0, -2.0, 1.0])
        }];
    let corner = |k: u32| (0..8).map(|c| 8 * k + c).collect::<Vec<u32>>().try_into().expect("eight corners");
    let mesh = Mesh {
        nodes: shapes.iter().flat_map(|shape| SIGNS.map(shape)).collect(),
        hexes: (0..4).map(corner).collect(),
        ..Mesh::default()
    };
    let model = Model::from_mesh(mesh, &body(Lumping::RowSum)).unwrap();
    assert_eq!(model.class_of, [0, 1, 2, 0]);
}

/// Any element of a class may lend its geometry: the forces of the ring's elements are those of their own geometry.
#[test]
fn forces_do_not_depend_on_which_element_names_the_class() {
    let model = Model::new(&wheel([44, 4, 5], 0.0)).unwrap();
    let mut random = Random::new(16);
    for index in (0..model.element_count()).step_by(37) {
        let X = model.mesh.hexes[index].map(|n| model.mesh.nodes[n as usize]);
        let F = random.near_identity(0.1);
        let x = X.map(|X| {
            let by = random.vector();
            std::array::from_fn(|d| times(&F, X)[d] + 1e-4 * by[d])
        });
        // The model's table was made without an hourglass stiffness; give both the same.
        let shared_element = model.class_of.iter().position(|&c| c == model.class_of[index]).unwrap();
        let shared = class(&model.mesh.hexes[shared_element].map(|n| model.mesh.nodes[n as usize]));
        for (element, law) in combinations() {
            let (a, b) =
                (force(element, &law, &shared, &x, None).f, force(element, &law, &class(&X), &x, None).f);
            for (a, b) in a.iter().zip(&b) {
                // Classes are the same shape to 1e-13 (coordinates are ten times an edge); the bulk modulus is
                // some ten times the stress.
                assert!(
                    (0..3).all(|d| (a[d] - b[d]).abs() < 1e-11 * largest([a, b])),
                    "{element:?} {a:?} {b:?}"
                );
            }
        }
    }
}

/// Elements of a ring and of a block are extruded, distorted ones are not; and where they are, the shorter routine computes
/// the same force.
#[test]
fn extruded_elements_take_the_shorter_way_to_the_same_force() {
    let mut random = Random::new(12);
    let mut scenes = [wheel([12, 2, 3], 0.0), block([0.02, 0.015, 0.01], [2, 3, 2])];
    for scene in &mut scenes {
        for law in laws() {
            scene.body.law = law;
            let model = Model::new(scene).unwrap();
            assert!(model.is_extruded());
            for (hex, &class) in model.mesh.hexes.iter().zip(&model.class_of) {
                let X = hex.map(|n| model.mesh.nodes[n as usize]);
                let x = deformed(&mut random, &X);
                let v: Corners<f64> = std::array::from_fn(|_| random.vector());
                let c = &model.classes[class as usize];
                let general = force(Element::Q1p0, &law, c, &x, Some(&v));
                let composition =
                    Composition { element: Element::Q1p0, law, viscosity: Some(ETA), relaxes: false };
                let shorter = composition.visit_fastest(true, ForceAt { class: c, x: &x, v: &v });
                let scale = largest(&general.f);
                for (a, b) in general.f.iter().flatten().zip(shorter.f.iter().flatten()) {
                    // The same sums without terms that are zero up to round-off.
                    assert!((a - b).abs() < 1e-12 * scale, "{a} {b}");
                }
            }
        }
    }
    assert!(!class(&distorted(&mut random)).is_extruded());
}

fn body(lumping: Lumping) -> Body {
    Body { lumping, ..block([1.0; 3], [1; 3]).body }
}

/// The lumped masses add up to density times volume, whichever way they are shared out.
#[test]
fn mass_is_density_times_volume() {
    for lumping in [Lumping::RowSum, Lumping::Equal] {
        let mut scene = wheel([44, 4, 5], 0.0);
        scene.body.lumping = lumping;
        let model = Model::new(&scene).unwrap();
        // Between two 44-gons.
        let polygon = |r: f64| 22.0 * r * r * (std::f64::consts::TAU / 44.0).sin();
        let expected = DENSITY * WIDTH * (polygon(OUTER_RADIUS) - polygon(INNER_RADIUS));
        // A sum of 1,320 terms.
        close("mass", model.mass.iter().sum(), expected, 1e-13);
        let moment =
            model.mesh.nodes.iter().zip(&model.mass).map(|(x, m)| m * (x[2] - OUTER_RADIUS)).sum::<f64>();
        assert!(moment.abs() < 1e-14 * expected, "the wheel is balanced");
    }
}

/// Row sums keep the centre of mass of a tapered element, eighths do not.
#[test]
fn row_sums_keep_the_centre_of_mass() {
    // A frustum of height 1 on a square of side 1 under one of side s.
    let s = 0.6;
    let side = |z: f64| if z < 0.0 { 0.5 } else { 0.5 * s };
    let nodes = SIGNS.map(|c| [side(c[2]) * c[0], side(c[2]) * c[1], 0.5 + 0.5 * c[2]]).to_vec();
    let mesh = Mesh { nodes, hexes: vec![[0, 1, 2, 3, 4, 5, 6, 7]], ..Mesh::default() };
    let centroid = |lumping| {
        let model = Model::from_mesh(mesh.clone(), &body(lumping)).unwrap();
        let total: f64 = model.mass.iter().sum();
        close("mass", total, DENSITY * (1.0 + s + s * s) / 3.0, 1e-14);
        mesh.nodes.iter().zip(&model.mass).map(|(x, m)| x[2] * m).sum::<f64>() / total
    };
    let exact = (1.0 + 2.0 * s + 3.0 * s * s) / (4.0 * (1.0 + s + s * s));
    close("centre of mass, row sums", centroid(Lumping::RowSum), exact, 1e-14);
    close("centre of mass, eighths", centroid(Lumping::Equal), 0.5, 1e-14);
}

/// Inside-out elements, also those folded at a corner only, are refused by number.
#[test]
fn an_inside_out_element_is_refused() {
    let scene = block([2.0, 1.0, 1.0], [2, 1, 1]);
    let mesh = Model::new(&scene).unwrap().mesh;
    let mut mirrored = mesh.clone();
    mirrored.hexes[1] = [4, 5, 6, 7, 0, 1, 2, 3].map(|c: usize| mesh.hexes[1][c]);
    assert_eq!(Model::from_mesh(mirrored, &scene.body).err(), Some(1));
    // The far corner pushed through the plane of its three neighbours: positive at the Gauss points, not there.
    let mut folded = mesh.clone();
    let corner = folded.hexes[1][6] as usize;
    folded.nodes[corner] = [1.6, 0.6, 0.6];
    let X = folded.hexes[1].map(|n| folded.nodes[n as usize]);
    let at_points = hexroll::physics::element::hex8::gradients(&X);
    let positive =
        |q| hexroll::physics::tensor::det(&hexroll::physics::element::hex8::at(&at_points, q)) > 0.0;
    assert!((0..8).all(positive), "only the corner is folded");
    assert_eq!(Model::from_mesh(folded, &scene.body).err(), Some(1));
    // A hair further out it is a valid element.
    let mut valid = mesh.clone();
    valid.nodes[corner] = [1.7, 0.7, 0.7];
    assert!(Model::from_mesh(valid, &scene.body).is_ok());
}

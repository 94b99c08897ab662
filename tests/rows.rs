//! Elements in rows, loose elements and threads give the forces of elements taken one by one.
//!
//! The CPU engine arranges any mesh in rows of neighbours that load as vectors, and takes what fits into no row lane by
//! lane (src/cpu/plan/lines.rs). Requirement: whatever the numbering of elements and nodes, the shapes of the elements and
//! the number of threads, the forces are those of a plain loop over the elements, and the motion does not depend on
//! the numbering.

use hexroll::cpu::{Precision, engine, engine_at};
use hexroll::model::Model;
use hexroll::model::mesh::Mesh;
use hexroll::physics::lanes::Level;
use hexroll::scene::{Drive, Element, Scene};
use hexroll_lab::rig::{
    Driver, Random, block, distort, explicit, press, relative, shipped, simulate_with, wheel,
};

/// Elements and nodes in random order.
fn shuffled(mesh: &Mesh, random: &mut Random) -> Mesh {
    let mut order = |count: usize| {
        let mut keyed: Vec<(f64, u32)> = (0..count as u32).map(|i| (random.signed(), i)).collect();
        keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
        keyed.into_iter().map(|k| k.1).collect::<Vec<u32>>()
    };
    let (nodes, hexes) = (order(mesh.nodes.len()), order(mesh.hexes.len()));
    let mut new = vec![0; nodes.len()];
    for (to, &from) in nodes.iter().enumerate() {
        new[from as usize] = to as u32;
    }
    let renamed = |n: &u32| new[*n as usize];
    let sorted = |set: &[u32]| {
        let mut set: Vec<u32> = set.iter().map(renamed).collect();
        set.sort_unstable();
        set
    };
    Mesh {
        nodes: nodes.iter().map(|n| mesh.nodes[*n as usize]).collect(),
        hexes: hexes.iter().map(|e| mesh.hexes[*e as usize].each_ref().map(renamed)).collect(),
        facets: mesh.facets.iter().map(|f| f.each_ref().map(renamed)).collect(),
        rim: sorted(&mesh.rim),
        axle: mesh.axle,
        surface: sorted(&mesh.surface),
        ..Mesh::default()
    }
}

fn model(scene: &Scene, change: impl FnOnce(&mut Mesh)) -> Model {
    let mut mesh = Model::new(scene).unwrap().mesh;
    change(&mut mesh);
    Model::from_mesh(mesh, &scene.body).expect("no element is inside out")
}

/// Element by element, corner by corner.
fn plain(model: &Model, x: &[[f64; 3]], v: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut f = vec![[0.0; 3]; x.len()];
    for (hex, &class) in model.mesh.hexes.iter().zip(&model.class_of) {
        let at = |field: &[[f64; 3]]| hex.map(|n| field[n as usize]);
        for (n, g) in hex.iter().zip(model.element_forces(class as usize, &at(x), &at(v))) {
            for d in 0..3 {
                f[*n as usize][d] += g[d];
            }
        }
    }
    f
}

/// Elements one by one are computed without what the engine knows of their shapes: that none of their numbers is zero because
/// a figure is extruded.
#[test]
fn forces_are_those_of_elements_one_by_one() {
    forces_are_plain(Element::Q1p0);
}

#[test]
fn forces_of_mean_gradients_are_those_of_elements_one_by_one() {
    forces_are_plain(Element::UniformGradient { hourglass: 0.15 });
}

/// In one piece: meshes one after the other, from the rows of a ring to elements with nothing in common.
fn forces_are_plain(element: Element) {
    let mut random = Random::new(7);
    let of = |mut scene: Scene| {
        scene.body.element = element;
        scene
    };
    let (ring, long, cube) = (
        of(wheel([44, 2, 3], 0.5)),
        of(block([0.1, 0.02, 0.02], [21, 3, 3])),
        of(block([0.02, 0.02, 0.02], [3, 3, 3])),
    );
    let cases: Vec<(&str, &Scene, Model)> = vec![
        ("closed rows", &ring, model(&ring, |_| {})),
        ("open rows", &long, model(&long, |_| {})),
        ("open rows of whole vectors", &long, {
            let mut scene = long.clone();
            scene.body.mesh = block([0.1, 0.02, 0.02], [32, 3, 3]).body.mesh;
            model(&scene, |_| {})
        }),
        ("loose elements", &cube, model(&cube, |_| {})),
        ("a shape an element", &long, model(&long, |mesh| distort(mesh, 0.1 / 21.0, 0.1))),
        ("loose and distorted", &cube, model(&cube, |mesh| distort(mesh, 0.02 / 3.0, 0.1))),
        ("a shuffled ring", &ring, model(&ring, |mesh| *mesh = shuffled(mesh, &mut random))),
        (
            "rows beside loose elements",
            &long,
            model(&long, |mesh| {
                // Without every fifth element rows are of four: loose where there are more lanes than eight.
                let mut e = 0;
                mesh.hexes.retain(|_| {
                    e += 1;
                    e % 5 != 0 || e > 60
                });
            }),
        ),
    ];
    for (name, scene, model) in cases {
        let size = model.mesh.nodes.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs()));
        let x: Vec<[f64; 3]> = model
            .mesh
            .nodes
            .iter()
            .map(|x| [0, 1, 2].map(|d| x[d] + 0.01 * size * (3.0 * x[(d + 1) % 3] / size).sin()))
            .collect();
        let v: Vec<[f64; 3]> = x.iter().map(|x| [0, 1, 2].map(|d| (5.0 * x[d] / size).cos())).collect();
        let expected = plain(&model, &x, &v);
        for level in Level::available() {
            for (precision, threads, tolerance) in [
                // Rounding of stresses that nearly cancel: 1e-16 (6e-8) times kappa/G and the digits lost in sums.
                (Precision::F64, 1, 1e-12),
                (Precision::F64, 3, 1e-12),
                (Precision::F32, 2, 1e-3),
            ] {
                let forces =
                    engine_at(&model, scene, precision, threads, level).unwrap().force(&x, &v).unwrap();
                let error = relative(&forces, &expected);
                assert!(error < tolerance, "{name}, {level:?}, {precision:?} x{threads}: {error:e}");
            }
        }
    }
}

/// 200 steps of a wheel pressed and rolled: positions of a shuffled mesh are those of the mesh as it came, but for the
/// order of sums. An elastic body in frictional contact amplifies rounding: 1e-16 grows to 1e-12 over these steps.
#[test]
fn the_motion_does_not_depend_on_the_numbering() {
    let mut scene = wheel([44, 2, 3], 0.5);
    scene.body.viscosity = Some(20.0);
    scene.stages = vec![press(Drive::Displacement { to: -2e-3, ramp: 1e-3 }), explicit("roll", 0.01)];
    let whole = model(&scene, |_| {});
    let other = model(&scene, |mesh| *mesh = shuffled(mesh, &mut Random::new(3)));
    let moved = |model: &Model| {
        let mut driver = Driver::new(model, &scene).unwrap();
        driver.advance(std::iter::repeat_n(1e-5, 200)).expect("the steps are stable");
        let window = driver.sample(1e-5).unwrap();
        assert!(window.step_contact.iter().any(|s| s.touching > 0), "it touches");
        // By reference position, which shuffling keeps to the last bit.
        let mut x: Vec<_> = std::iter::zip(&model.mesh.nodes, driver.engine.state().unwrap().x).collect();
        x.sort_by(|a, b| a.0.partial_cmp(b.0).unwrap());
        x.into_iter().map(|x| x.1).collect::<Vec<_>>()
    };
    let error = relative(&moved(&other), &moved(&whole));
    assert!(error < 1e-10, "{error:e}");
}

/// Lanes behind the last node of a line carry no force: what the internal force has done is what the kinetic energy has
/// gained. Two blocks whose lines, of 11 and of 10 nodes, fill as many vectors, so that one could take the other's slots.
#[test]
fn lanes_without_a_node_do_no_work() {
    let scene = block([0.1, 0.03, 0.03], [20, 6, 6]);
    let model = model(&scene, |mesh| {
        let mut e = 0..;
        mesh.hexes.retain(|_| e.next().is_some_and(|e| e % 20 != 10));
    });
    assert_eq!(model.element_count(), 19 * 36);
    let mut random = Random::new(11);
    let v: Vec<[f64; 3]> = (0..model.node_count()).map(|_| random.vector()).collect();
    let square = |v: &[f64; 3]| v.iter().map(|c| c * c).sum::<f64>();
    let given: f64 = v.iter().zip(&model.mass).map(|(v, m)| 0.5 * m * square(v)).sum();
    for level in Level::available() {
        for threads in [1, 2] {
            let mut driver = Driver::new(&model, &scene).unwrap();
            driver.engine = engine_at(&model, &scene, Precision::F64, threads, level).unwrap();
            driver.engine.set_velocity(&v, &[0.0; 6]).unwrap();
            driver.advance(std::iter::repeat_n(1e-6, 50)).unwrap();
            let window = driver.sample(1e-6).unwrap();
            let done = window.works.internal + window.works.viscous;
            let error = (window.kinetic - given - done) / given;
            // Round-off of 50 steps' sums over 800 nodes.
            assert!(error.abs() < 1e-12, "{level:?} x{threads}: {error:e}");
            assert!(done.abs() > 1e-3 * given, "{level:?} x{threads}: {done} of {given}");
        }
    }
}

/// What a window says of its steps is what it says of its nodes.
#[test]
fn contact_of_every_step_adds_up_to_the_windows() {
    let scene = wheel([44, 2, 3], 0.5);
    let model = Model::new(&scene).unwrap();
    for threads in [1, 2] {
        let mut driver = Driver::new(&model, &scene).unwrap();
        driver.engine = engine(&model, &scene, Precision::F64, threads).unwrap();
        driver.advance(std::iter::repeat_n(1e-5, 150)).unwrap();
        let window = driver.sample(1e-5).unwrap();
        assert_eq!(window.step_contact.len(), 150);
        let touching: u32 = window.step_contact.iter().map(|s| s.touching).sum();
        assert!(touching > 0);
        assert_eq!(touching, window.surface.iter().map(|s| s.touching).sum::<u32>());
        for d in 0..3 {
            let impulse: f64 = window.step_contact.iter().map(|s| s.force[d] * s.dtm).sum();
            let nodes: f64 = window.surface.iter().map(|s| s.impulse[d]).sum();
            assert!((impulse - nodes).abs() <= 1e-12 * nodes.abs().max(1e-9), "{d}: {impulse} {nodes}");
        }
        // Every node was free at first: it changed at least once if it touched, and at most once a step.
        let changes: u32 = window.step_contact.iter().map(|s| s.changes).sum();
        let touched = window.surface.iter().filter(|s| s.touching > 0).count() as u32;
        assert!(changes >= touched && changes <= 2 * touching, "{changes} {touched} {touching}");
    }
}

/// A sample between two steps is no change of state: nodes that stick go on sticking.
#[test]
fn changes_of_state_do_not_depend_on_the_windows() {
    let scene = wheel([44, 2, 3], 1.0);
    let model = Model::new(&scene).unwrap();
    let [rarely, often] = [200, 10].map(|window| {
        let mut driver = Driver::new(&model, &scene).unwrap();
        let mut all = Vec::new();
        for step in 1..=200 {
            // Down by 1 mm at 1 m/s, then held.
            driver.rim[2] -= if step <= 100 { 1e-5 } else { 0.0 };
            driver.advance([1e-5]).unwrap();
            if step % window == 0 {
                all.extend(driver.sample(1e-5).unwrap().step_contact);
            }
        }
        all
    });
    assert_eq!((rarely.len(), often.len()), (200, 200));
    for (step, (one, other)) in rarely.iter().zip(&often).enumerate() {
        assert_eq!(one.changes, other.changes, "step {step}");
    }
    // Nodes stick when samples are taken, or nothing has been shown.
    assert!(rarely.iter().filter(|s| s.touching > s.changes).count() > 50);
}

/// The run asks the mesh, not the generator, how many elements stand round its axle: with other numbers the tone is found
/// and the windows of the footprint are cut as before.
#[test]
fn a_shuffled_wheel_has_its_tone_and_its_footprint() {
    // Windows of 5 ms, in which a wheel of 24 elements rolls over one and a bit; 2.9 of them in the tail of 40 ms.
    let sets = ["body.mesh.elements=[24,2,2]", "output.sample=5 ms", "stage.1.duration=40 ms"];
    let scene = shipped("lat100_straight_viscous", &sets);
    let rolled = |model: Model| {
        let outcome = simulate_with(&scene, model, Precision::F64, 1).unwrap();
        let length = outcome.samples.iter().rev().take(4).map(|s| s.footprint_length_m).sum::<f64>() / 4.0;
        let noise = outcome.totals.noise.last().copied().flatten().expect("it touches");
        (length, noise.tone.expect("the mesh has rows").frequency)
    };
    let (length, tone) = rolled(model(&scene, |_| {}));
    let (other_length, other_tone) =
        rolled(model(&scene, |mesh| *mesh = shuffled(mesh, &mut Random::new(5))));
    assert!((other_tone / tone - 1.0).abs() < 1e-9, "{other_tone} Hz, {tone} Hz");
    // Forces are summed in another order; that is round-off, which rolling contact makes larger. Over whole windows it
    // would be another length: a node that rolls through touches for half of a part, but not for half of a window.
    assert!((other_length / length - 1.0).abs() < 1e-3, "{other_length} m, {length} m");
}

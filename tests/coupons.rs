//! Components of nodes that follow a motion: samples in tension and shear as scenes, against closed forms, explicit and implicit;
//! works, reactions and balances of what drives them.

#![allow(non_snake_case)] // X: reference positions

use std::path::Path;

use hexroll::Error;
use hexroll::cpu::{self, Precision};
use hexroll::model::Model;
use hexroll::record::Reaction;
use hexroll::scene::{Law, Scene};
use hexroll::study::curves::Test;
use hexroll_lab::rig::{Outcome, close, simulate, simulate_with};

/// In place of the relaxation: equilibria along the ramp.
const IMPLICIT: [&str; 1] = [
    "stage=[{ name = \"draw\", method = \"implicit\", duration = \"20 ms\", implicit = { scheme = \"static\", increments = 10 } }]",
];

fn scene(stem: &str, changes: &[&str]) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{stem}.toml"));
    let changes: Vec<String> = changes.iter().map(|c| c.to_string()).collect();
    Scene::load(&file, &changes).unwrap_or_else(|e| panic!("{e}"))
}

/// Displacement and force along a component of a set.
fn along(row: &[Reaction], set: &str, component: usize) -> [f64; 2] {
    let one = row.iter().find(|r| r.set == set).expect("the set is recorded");
    one.components[component].expect("the component is prescribed")
}

/// Force against stretch in every row, the force of the other end, and the energy stored.
fn assert_drawn(outcome: &Outcome, law: &Law, test: Test, every: bool) {
    let rows = &outcome.reactions;
    let from = if every { 0 } else { rows.len() - 1 };
    assert!(rows.len() > 3);
    for row in &rows[from..] {
        let [u, force] = along(row, "z-max", 2);
        let stretch = 1.0 + u / 0.01;
        // A window's mean force in equilibrium. A homogeneous state is exact with any mesh.
        close("force", force, 1e-4 * test.nominal_stress(law, stretch).unwrap(), 1e-3);
        close("the other end", along(row, "z-min", 2)[1], -force, 1e-3);
    }
    close("stretch", along(rows.last().unwrap(), "z-max", 2)[0], 5e-3, 1e-12);
}

/// The scenes' own numbers, and each row of an implicit run.
#[test]
fn samples_in_tension_carry_what_their_law_says() {
    for (stem, test, force) in
        [("coupon_uniaxial", Test::Uniaxial, 190.0), ("coupon_planar", Test::Planar, 216.667)]
    {
        for implicit in [false, true] {
            let scene = scene(stem, if implicit { &IMPLICIT } else { &[] });
            let outcome = simulate(&scene).unwrap();
            assert_drawn(&outcome, &scene.body.law, test, implicit);
            close("the scene's force", along(outcome.reactions.last().unwrap(), "z-max", 2)[1], force, 1e-3);
            let last = outcome.last();
            if test == Test::Uniaxial {
                close("stored energy", last.strain_J, 0.525, 1e-3);
            }
            // At rest all that was put in is stored or was damped.
            let missing = last.external_work_J + last.damping_work_J - last.strain_J;
            // Work along an increment is that of the mean force: ten chords of a curve that bends by 12 C10 at its start.
            let tolerance = if implicit { 2e-2 } else { 1e-6 };
            assert!(missing.abs() < tolerance * last.strain_J, "{stem} {implicit}: {missing} J");
            assert!(last.balance_error_J.abs() < 1e-9 * last.strain_J.max(1e-3), "{}", last.balance_error_J);
        }
    }
}

/// Every law, drawn implicitly: the sample's force is the curve that `check` prints.
#[test]
fn samples_of_every_law_carry_what_check_prints() {
    for law in hexroll_lab::rig::laws() {
        let mut scene = scene("coupon_uniaxial", &IMPLICIT);
        scene.body.law = law;
        let outcome = simulate(&scene).unwrap();
        for row in &outcome.reactions {
            let [u, force] = along(row, "z-max", 2);
            // Newton's tolerance of 1e-6 of the force scale or so.
            close("force", force, 1e-4 * Test::Uniaxial.nominal_stress(&law, 1.0 + u / 0.01).unwrap(), 1e-4);
        }
    }
}

#[test]
fn a_sheared_sample_turned_once_has_the_same_stress() {
    let scene = scene("coupon_shear_turned", &[]);
    let outcome = simulate(&scene).unwrap();
    let sheared = outcome.samples.iter().position(|s| s.stage == "turn").unwrap() - 1;
    let [u, force] = along(&outcome.reactions[sheared], "z-max", 0);
    close("shear", u, 0.01, 1e-12);
    // The mean over the last window of the ramp, which ends as the cube of what is left: 10 (1/20)^3 / 4 of it is missing.
    close("force", force, 180.0, 1e-3);
    let [before, after] =
        [&outcome.snapshots[outcome.snapshots.len() - 2], outcome.snapshots.last().unwrap()];
    for (a, b) in before.von_mises.iter().zip(&after.von_mises) {
        close("von Mises", *a, 3.6e6, 1e-9);
        // Round-off of positions, of which kappa = 1111 G makes as much more.
        close("von Mises, turned", *b, *a, 1e-11);
    }
    // Every node is prescribed: in single precision too.
    let single = simulate_with(&scene, Model::new(&scene).unwrap(), Precision::F32, 1).unwrap();
    for (x, y) in single.snapshots.last().unwrap().x.iter().zip(&after.x) {
        assert!(x.iter().zip(y).all(|(a, b)| (a - b).abs() < 1e-8), "{x:?} {y:?}");
    }
}

/// A sine along y, a table along x: nodes are where they are told to be, other components are free, and both energy balances
/// close in motion.
#[test]
fn what_is_driven_goes_where_it_is_told_and_its_work_is_booked() {
    let changes = [
        "hold=[{ nodes = \"z-min\", components = \"xyz\", reaction = \"recorded\" }]",
        "motion=[{ nodes = \"z-max\", x = { table = [[\"0 ms\", \"0 mm\"], [\"1 ms\", \"0.2 mm\"], [\"3 ms\", \"-0.1 mm\"]] }, \
         y = { amplitude = \"0.3 mm\", frequency = \"400 Hz\", ramp = \"2 ms\" } }]",
        "stage=[{ method = \"explicit\", duration = \"4 ms\", mass_damping = \"200 1/s\" }]",
        "gravity=[\"0 m/s2\", \"0 m/s2\", \"-9.81 m/s2\"]",
        "body.material={ shear_modulus = \"1.8 MPa\", bulk_modulus = \"50 MPa\", viscosity = \"20 Pa s\" }",
        "output.sample=\"0.1 ms\"",
    ];
    let scene = scene("coupon_uniaxial", &changes);
    let outcome = simulate(&scene).unwrap();
    let mesh = &outcome.model.mesh;
    let (path, last) = (&scene.motions[0], outcome.snapshots.last().unwrap());
    let mut free = 0.0f64;
    for &n in &mesh.set("z-max").unwrap() {
        let (X, x, u) = (mesh.nodes[n as usize], last.x[n as usize], path.displacement(4e-3));
        assert!((0..2).all(|d| (x[d] - X[d] - u[d]).abs() < 1e-16), "{x:?}");
        free = free.max((x[2] - X[2]).abs());
    }
    assert!(free > 1e-6, "the faces' normal component is free");
    let most = outcome.samples.iter().map(|s| s.external_work_J.abs()).fold(0.0, f64::max);
    assert!(most > 1e-4);
    for row in &outcome.samples {
        // Round-off of ten thousand steps.
        assert!(row.balance_error_J.abs() < 1e-11 * most, "{}: {:e}", row.time_s, row.balance_error_J);
        // Second order in a step that is a thousandth of the sine's period, at the table's corners a jump of velocity.
        assert!(
            row.stored_balance_error_J.abs() < 1e-2 * most,
            "{}: {:e}",
            row.time_s,
            row.stored_balance_error_J
        );
    }
    // The two ends' forces differ by the inertia, the weight and the damping between them: of the same order, not the same.
    let row = &outcome.reactions[20];
    assert!(along(row, "z-max", 1)[1] * along(row, "z-min", 1)[1] < 0.0);
    // As many threads as one likes, the same bits.
    let threads = simulate_with(&scene, Model::new(&scene).unwrap(), Precision::F64, 2).unwrap();
    assert_eq!(threads.reactions, outcome.reactions);
}

/// Newmark's scheme follows the same motion.
#[test]
fn implicit_steps_follow_a_motion_in_time() {
    let changes = [
        "stage=[{ method = \"implicit\", duration = \"4 ms\", implicit = { scheme = \"dynamic\", step = \"0.05 ms\" } }]",
        "motion.0.z={ amplitude = \"0.5 mm\", frequency = \"250 Hz\", ramp = \"2 ms\" }",
        "body.material.bulk_modulus=\"50 MPa\"",
        "output.sample=\"0.5 ms\"",
    ];
    let implicit = simulate(&scene("coupon_uniaxial", &changes)).unwrap();
    let explicit =
        ["stage=[{ method = \"explicit\", duration = \"4 ms\" }]", changes[1], changes[2], changes[3]];
    let explicit = simulate(&scene("coupon_uniaxial", &explicit)).unwrap();
    let most = explicit.samples.iter().map(|s| s.strain_J).fold(0.0, f64::max);
    for (a, b) in implicit.samples.iter().zip(&explicit.samples) {
        // Steps of 1/80 of the period.
        assert!((a.strain_J - b.strain_J).abs() < 2e-2 * most, "{}: {} {}", a.time_s, a.strain_J, b.strain_J);
        assert!(a.balance_error_J.abs() < 1e-2 * most, "{}: {:e}", a.time_s, a.balance_error_J);
    }
}

fn mistake(changes: &[&str]) -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/coupon_uniaxial.toml");
    let changes: Vec<String> = changes.iter().map(|c| c.to_string()).collect();
    let failed = Scene::load(&file, &changes).and_then(|scene| Model::new(&scene).map(|_| ()));
    failed.expect_err("a mistake").to_string()
}

#[test]
fn motions_that_cannot_be_are_refused() {
    for (change, problem) in [
        ("motion.0.z={ displacement = \"1 mm\" }", "motion.0.z.ramp"),
        ("motion.0.z={ displacement = \"1 mm\", amplitude = \"1 mm\" }", "exclude each other"),
        ("motion=[{ nodes = \"z-max\" }]", "no component moves"),
        ("motion=[{ nodes = \"z-min\", z = { displacement = \"1 mm\", ramp = \"1 ms\" } }]", "held or moved"),
        ("motion=[{ nodes = \"top\", z = { displacement = \"1 mm\", ramp = \"1 ms\" } }]", "no node set"),
        ("motion.0.z={ table = [[\"0 ms\", \"1 mm\"]] }", "nothing can be moved at once"),
        ("motion.0.z={ table = [[\"1 ms\", \"1 mm\"], [\"1 ms\", \"2 mm\"]] }", "not later than"),
        ("motion.0.z={ table = \"not there.csv\" }", "not there.csv"),
        ("motion.0.z={ amplitude = \"1 mm\", frequency = \"10 Hz\" }", "never comes to rest"),
        ("hold.2.reaction=\"yes\"", "recorded"),
    ] {
        let message = mistake(&[change]);
        assert!(message.contains(problem), "{change}: {message}");
    }
    let scene = scene("coupon_uniaxial", &[]);
    assert!(matches!(scene.beyond_gpu(), Some(Error::Unsupported { .. })));
    assert!(cpu::engine(&Model::new(&scene).unwrap(), &scene, Precision::F32, 1).is_ok());
}

/// A table in a file beside the scene: columns by their names, as many components as one likes.
#[test]
fn a_table_is_read_from_a_file_beside_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let text =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/coupon_uniaxial.toml"))
            .unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    std::fs::write(
        folder.path().join("pull.csv"),
        "# by hand\ntime_s, x_m, z_m\n0, 0, 0\n0.01, 1e-3, 2e-3\n",
    )
    .unwrap();
    let change = ["motion.0.z={ table = \"pull.csv\" }".to_string()];
    let scene = Scene::load(&path, &change).unwrap();
    assert_eq!(scene.motions[0].displacement(5e-3), [0.0, 0.0, 1e-3]);
    std::fs::write(folder.path().join("pull.csv"), "time_s, x_m\n0, 0\n").unwrap();
    let message = Scene::load(&path, &change).unwrap_err().to_string();
    assert!(message.contains("no column z_m"), "{message}");
    std::fs::write(folder.path().join("pull.csv"), "time_s, z_m\n0, 0\n1, much\n").unwrap();
    let message = Scene::load(&path, &change).unwrap_err().to_string();
    assert!(message.contains("line 3"), "{message}");
}

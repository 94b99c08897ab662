//! Held components: symmetry planes and plane strain, exact and free of charge to every balance.

#![allow(non_snake_case)] // X: reference positions

use hexroll::cpu::Precision;
use hexroll::model::Model;
use hexroll::physics::friction::Coulomb;
use hexroll::physics::tensor::sub;
use hexroll::run::stability;
use hexroll::scene::{Friction, Hold, Scene};
use hexroll_lab::rig::{Driver, GROUND, block, close, largest, simulate_with};

fn hold(nodes: &str, components: [bool; 3]) -> Hold {
    Hold { nodes: nodes.into(), components }
}

/// Half of a body with its symmetry plane held moves as the whole body does: a block that breathes along x and bends
/// along z, whole with 6 x 2 x 3 elements and its half with 3 x 2 x 3.
#[test]
fn half_a_body_moves_as_the_whole() {
    let (length, h) = (0.06, 0.01);
    let field = |x: [f64; 3]| {
        let s = (x[0] - 0.5 * length) / length;
        [2.0 * (std::f64::consts::PI * s).sin() + 3.0 * s * x[2] / h, 0.3 * x[1] / h, 1.0 - 8.0 * s * s]
    };
    let run = |scene: &Scene| {
        let model = Model::new(scene).unwrap();
        let mut driver = Driver::new(&model, scene).unwrap();
        let v: Vec<_> = model.mesh.nodes.iter().map(|&x| field(x)).collect();
        driver.engine.set_velocity(&v, &[0.0; 6]).unwrap();
        driver.advance(std::iter::repeat_n(1.5e-5, 400)).unwrap();
        (model, driver.engine.state().unwrap())
    };
    let whole = run(&block([length, 0.02, 0.03], [6, 2, 3]));
    let mut scene = block([0.5 * length, 0.02, 0.03], [3, 2, 3]);
    scene.body.offset = [0.5 * length, 0.0, 0.0];
    scene.holds = vec![hold("x-min", [true, false, false])];
    let half = run(&scene);
    let mut compared = 0;
    for (X, x) in half.0.mesh.nodes.iter().zip(&half.1.x) {
        let near = |Y: &&[f64; 3]| largest([&sub(**Y, *X)]) < 1e-9;
        let (n, _) = (whole.0.mesh.nodes.iter().enumerate()).find(|(_, Y)| near(Y)).expect("the same node");
        // Round-off of 400 steps, grown by a motion of 10 % strain.
        let off = largest([&sub(whole.1.x[n], *x)]);
        assert!(off < 1e-11, "at {X:?}: {off}");
        compared += 1;
    }
    assert_eq!(compared, 4 * 3 * 4);
    let moved = half.1.x.iter().zip(&half.0.mesh.nodes).map(|(x, X)| sub(*x, *X)).collect::<Vec<_>>();
    assert!(largest(&moved) > 1e-3, "it did move");
}

fn sliding() -> Scene {
    let mut scene = block([0.03, 0.01, 0.02], [4, 2, 3]);
    scene.body.offset = [0.0, 0.0, 2e-4];
    scene.body.velocity = [0.5, 0.7, -0.4];
    scene.body.viscosity = Some(20.0);
    scene.road = Some(GROUND);
    scene.friction = Some(Friction::Coulomb(Coulomb { mu: 0.6 }));
    scene.gravity = [0.0, 0.0, -9.81];
    scene.holds = vec![hold("all", [false, true, false])];
    scene.stages[0].duration = 0.01;
    scene.stages[0].mass_damping = 20.0;
    scene
}

/// In plane strain nothing moves across by a bit, in either precision, and the work balance closes all the same.
#[test]
fn a_held_component_does_not_move_by_a_bit() {
    for (precision, balance) in [(Precision::F64, 1e-12), (Precision::F32, 1e-4)] {
        let scene = sliding();
        let outcome = simulate_with(&scene, Model::new(&scene).unwrap(), precision, 1).unwrap();
        let snapshot = outcome.snapshots.last().unwrap();
        for ((x, v), X) in snapshot.x.iter().zip(&snapshot.v).zip(&outcome.model.mesh.nodes) {
            let stored = if precision == Precision::F64 { X[1] } else { f64::from(X[1] as f32) };
            // In single precision positions are relative to a frame of a power of two: exact in f64.
            assert!((x[1] - stored).abs() < 1e-9 && v[1] == 0.0, "{precision:?}: {x:?} {v:?}");
        }
        let ledger = &outcome.totals.ledger;
        assert!(ledger.worst_balance < balance * ledger.largest_term, "{precision:?}: {ledger:?}");
        let last = outcome.last();
        assert!(last.friction_work_J < 0.0 && last.strain_J > 0.0 && last.road_fy_N == 0.0, "{last:?}");
    }
}

/// The critical step knows what is held: a bar whose sides are held has plane waves alone, dt = h / c.
#[test]
fn the_critical_step_is_that_of_plane_waves() {
    let h = 1e-3;
    let mut scene = block([0.05, h, h], [50, 1, 1]);
    scene.holds = vec![hold("all", [false, true, true])];
    let model = Model::new(&scene).unwrap();
    let mut driver = Driver::new(&model, &scene).unwrap();
    let guess = stability::element_bound(&model).unwrap();
    let found = stability::assembled(&mut *driver.engine, &model, &model.mesh.nodes, guess, None).unwrap();
    let c = (scene.body.law.wave_modulus() / scene.body.density).sqrt();
    // Half of the eigenvalue's residual of 1e-3.
    close("critical step", found.dt, h / c, 1e-3);
}

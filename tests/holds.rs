//! Held components: symmetry planes and plane strain, exact and free of charge to every balance.

#![allow(non_snake_case)] // X: reference positions

use hexroll::cpu::Precision;
use hexroll::model::Model;
use hexroll::physics::friction::Coulomb;
use hexroll::physics::tensor::sub;
use hexroll::run::stability;
use hexroll::scene::{
    Friction, Hold, Implicit, ImplicitScheme, ImplicitSolver, Linear, Method, Scene, Snapshots,
};
use hexroll_lab::rig::{Driver, GROUND, block, close, largest, simulate_with};

fn hold(nodes: &str, components: [bool; 3]) -> Hold {
    Hold { nodes: nodes.into(), components, reaction: false }
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

/// A beam of 50 mm by 10 mm by 10 mm, clamped at one end, under its own weight.
fn cantilever(method: Method) -> Scene {
    let mut scene = block([0.05, 0.01, 0.01], [20, 4, 4]);
    scene.holds = vec![hold("x-min", [true; 3])];
    scene.gravity = [0.0, 0.0, -9.81];
    scene.stages[0].method = method;
    // First bending mode: 340 1/s; about critical damping.
    scene.stages[0].mass_damping = if matches!(method, Method::QuasiStatic { .. }) { 700.0 } else { 0.0 };
    scene.stages[0].duration = 0.4;
    scene.output.sample = 1e-2;
    scene.output.snapshots = Snapshots::StageEnds;
    scene
}

/// Tip deflection of a cantilever at rest, whose clamp carries its weight and the moment of it; the clamp has not moved.
fn checked_sag(name: &str, scene: &Scene) -> f64 {
    let outcome = simulate_with(scene, Model::new(scene).unwrap(), Precision::F64, 1).unwrap();
    let (model, x) = (&outcome.model, &outcome.snapshots.last().unwrap().x);
    let mut driver = Driver::new(model, scene).unwrap();
    let f = driver.engine.force(x, &vec![[0.0; 3]; x.len()]).unwrap();
    let (mut force, mut moment, mut sag) = ([0.0; 3], 0.0, 0.0_f64);
    for (n, X) in model.mesh.nodes.iter().enumerate() {
        sag = sag.max(X[2] - x[n][2]);
        if X[0] > 0.0 {
            continue;
        }
        assert_eq!(x[n], *X, "{name}: the clamp stands");
        let reaction: [f64; 3] = std::array::from_fn(|d| f[n][d] - model.mass[n] * scene.gravity[d]);
        (0..3).for_each(|d| force[d] += reaction[d]);
        moment += X[2] * reaction[0] - X[0] * reaction[2];
    }
    let weight = 9.81 * model.mass.iter().sum::<f64>();
    let lever: f64 = x.iter().zip(&model.mass).map(|(x, m)| 9.81 * m * x[0]).sum();
    // What is asked of the equilibrium: 1e-6 of internal forces that are some ten times the weight.
    close(&format!("{name}: weight"), force[2], weight, 1e-4);
    close(&format!("{name}: moment"), -moment, lever, 1e-4);
    assert!(force[0].abs() + force[1].abs() < 1e-4 * weight, "{name}: {force:?}");
    sag
}

/// A clamp takes the weight of what hangs on it, by relaxation and in every implicit solver, and they find the same beam.
#[test]
fn a_clamped_beam_hangs_on_its_clamp() {
    let slow = Method::QuasiStatic { kinetic_ratio: 1e-12, residual: 1e-6 };
    let relaxed = checked_sag("relaxed", &cantilever(slow));
    let sweeps =
        |corrections| ImplicitSolver::Relaxation { omega: 1.0, tolerance: 1e-8, sweeps: 40_000, corrections };
    let solvers = [
        ("direct", ImplicitSolver::ActiveSet(Linear::Direct)),
        ("multigrid", ImplicitSolver::ActiveSet(Linear::Multigrid)),
        ("block Jacobi", ImplicitSolver::ActiveSet(Linear::BlockJacobi)),
        ("relaxation", sweeps(Some(Linear::Direct))),
    ];
    for (name, solver) in solvers {
        let scheme = ImplicitScheme::Static { increments: 1 };
        let implicit = Implicit { scheme, solver, tolerance: 1e-7, iterations: 30 };
        let sag = checked_sag(name, &cantilever(Method::Implicit(implicit)));
        close(name, sag, relaxed, 1e-3);
    }
    // Bernoulli's beam and what shear adds, rho g L^4 / (8 E h^2 / 12) + rho g L^2 / (2 (5/6) G). Four elements over the height
    // are a tenth too stiff in bending, and the clamp keeps its section from warping.
    let scene = cantilever(slow);
    let (g, kappa) = (
        scene.body.law.shear_modulus(),
        scene.body.law.wave_modulus() - scene.body.law.shear_modulus() * 4.0 / 3.0,
    );
    let (young, load) = (9.0 * kappa * g / (3.0 * kappa + g), 9.81 * scene.body.density);
    let (length, h) = (0.05_f64, 0.01_f64);
    let beam = load * length.powi(4) * 1.5 / (young * h * h) + load * length.powi(2) / (2.0 * g * 5.0 / 6.0);
    assert!(relaxed > 0.8 * beam && relaxed < 1.02 * beam, "{relaxed} m of {beam} m");
}

/// In time: a clamped beam is let go under gravity, by central differences and by Newmark; no energy comes from the clamp.
#[test]
fn a_clamp_does_no_work() {
    let scheme = ImplicitScheme::Dynamic { step: 2e-4, damping: 0.0 };
    let solver = ImplicitSolver::ActiveSet(Linear::Direct);
    let newmark = Method::Implicit(Implicit { scheme, solver, tolerance: 1e-9, iterations: 20 });
    let fall = |method, precision| {
        let mut scene = cantilever(method);
        scene.stages[0].duration = 0.01;
        scene.output.sample = 2e-3;
        let outcome = simulate_with(&scene, Model::new(&scene).unwrap(), precision, 1).unwrap();
        let snapshot = outcome.snapshots.last().unwrap();
        for (n, X) in outcome.model.mesh.nodes.iter().enumerate().filter(|(_, X)| X[0] == 0.0) {
            let moved = (0..3).map(|d| (snapshot.x[n][d] - X[d]).abs()).fold(0.0, f64::max);
            // In single precision by what rounding it to the engine's positions does.
            assert!(
                moved <= if precision == Precision::F64 { 1e-17 } else { 1e-9 },
                "{precision:?}: {moved}"
            );
            assert_eq!(snapshot.v[n].map(f64::abs), [0.0; 3]);
        }
        let last = outcome.last();
        assert!(last.external_work_J > 0.0);
        (last.stored_balance_error_J / last.external_work_J, snapshot.x.iter().map(|x| x[2]).sum::<f64>())
    };
    let (explicit, there) = fall(Method::Explicit, Precision::F64);
    let (implicit, here) = fall(newmark, Precision::F64);
    let (_, single) = fall(Method::Explicit, Precision::F32);
    // Second order in strains of a thousandth; Newmark's of a step twenty times as long.
    assert!(explicit.abs() < 1e-3 && implicit.abs() < 1e-3, "{explicit} and {implicit}");
    let start: f64 = Model::new(&cantilever(Method::Explicit)).unwrap().mesh.nodes.iter().map(|x| x[2]).sum();
    close("the same fall", here - start, there - start, 1e-2);
    close("in single precision", single - start, there - start, 1e-2);
}

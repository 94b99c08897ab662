//! A Prony series on the isochoric stress (src/physics/material/relaxation.rs): its forces are those of the book's convolution, stresses
//! relax by the closed form at finite strain and whatever turns, a sheared block has the storage and loss modulus of the
//! series, and the engine remembers point by point on any mesh, level and number of threads.
#![allow(non_snake_case)] // X: the field's own symbol

use hexroll::cpu::{Precision, engine_at};
use hexroll::engine::{Engine, StageSetup, Step};
use hexroll::model::Model;
use hexroll::physics::element::{Class, Compose, Composition, Corners, Element, Force, Formulation};
use hexroll::physics::lanes::Level;
use hexroll::physics::material::{
    Fading, Hyperelastic, Law, Memory, NeoHookean, Pace, Relaxation, Term, Viscosity, WithLaw,
};
use hexroll::physics::tensor::Sym3;
use hexroll::scene::{Drive, InitialVelocity, RimMotion, Scene, Stage};
use hexroll_lab::rig::{
    ELEMENTS, G, HELD, Random, block, book, close, distort, explicit, laws, press, relative, shipped,
    simulate_with, times, wheel,
};

const CUBE: Corners<f64> = [
    [0.0, 0.0, 0.0],
    [1e-2, 0.0, 0.0],
    [1e-2, 1e-2, 0.0],
    [0.0, 1e-2, 0.0],
    [0.0, 0.0, 1e-2],
    [1e-2, 0.0, 1e-2],
    [1e-2, 1e-2, 1e-2],
    [0.0, 1e-2, 1e-2],
];

fn series() -> Relaxation {
    Relaxation { terms: vec![Term { ratio: 0.5, time: 2e-3 }, Term { ratio: 0.8, time: 3e-2 }] }
}

/// What one element's points remember, in plain numbers.
struct Remembered {
    terms: Vec<Fading>,
    before: f64,
    keeps: bool,
    relaxed: Vec<[Sym3<f64>; 8]>,
}

impl Memory<f64> for Remembered {
    fn terms(&self) -> &[Fading] {
        &self.terms
    }
    fn before(&self) -> f64 {
        self.before
    }
    fn keeps(&self) -> bool {
        self.keeps
    }
    fn relaxed(&self, point: usize, term: usize) -> Sym3<f64> {
        self.relaxed[term][point]
    }
    fn keep(&mut self, point: usize, term: usize, relaxed: Sym3<f64>) {
        self.relaxed[term][point] = relaxed;
    }
}

/// One element on its way: of any formulation, law and series.
struct Specimen {
    composition: Composition,
    class: Class<f64>,
    series: Relaxation,
    memory: Remembered,
    /// Positions before.
    x: Corners<f64>,
}

struct At<'a> {
    class: &'a Class<f64>,
    x: &'a Corners<f64>,
    v: &'a Corners<f64>,
    memory: &'a mut Remembered,
}

impl Compose for At<'_> {
    type Output = Force<f64>;
    fn with<F: Formulation, L: Hyperelastic, V: Viscosity>(self, law: L, viscosity: V) -> Force<f64> {
        F::force(&law, &viscosity, self.class, self.x, self.v, self.memory)
    }
}

impl Specimen {
    fn new(element: Element, law: Law, series: &Relaxation, X: &Corners<f64>) -> Specimen {
        let c = match element {
            Element::UniformGradient { hourglass } => hourglass,
            _ => 0.0,
        };
        Specimen {
            composition: Composition { element, law, viscosity: None, relaxes: true },
            class: Class::new(X, c * law.shear_modulus(), 0.0).unwrap(),
            series: series.clone(),
            memory: Remembered {
                terms: Vec::new(),
                before: 0.0,
                keeps: true,
                relaxed: vec![[Sym3::zero(); 8]; series.terms.len()],
            },
            x: *X,
        }
    }

    /// Its force at `x`, `before` [s] after the positions before, and `after` before the next.
    fn goes(&mut self, x: &Corners<f64>, before: f64, after: f64) -> Force<f64> {
        let modulus = self.composition.law.shear_modulus();
        self.memory.terms = self.series.fading(modulus, before, after, Pace::Timed);
        self.memory.before = before;
        let rate = if before > 0.0 { 1.0 / before } else { 0.0 };
        let v = std::array::from_fn(|a| std::array::from_fn(|d| (x[a][d] - self.x[a][d]) * rate));
        self.x = *x;
        let at = At { class: &self.class, x, v: &v, memory: &mut self.memory };
        self.composition.visit_fastest(self.class.is_extruded(), at)
    }
}

/// The book's overstress for any law.
struct Book<'a> {
    series: &'a Relaxation,
    X: &'a Corners<f64>,
    history: &'a [(f64, Corners<f64>)],
}

impl WithLaw for Book<'_> {
    type Output = Corners<f64>;
    fn with<L: hexroll::physics::material::Moduli>(self, law: L) -> Corners<f64> {
        hexroll::physics::element::textbook::overstress(&law, &self.series.terms, self.X, self.history)
    }
}

fn isochoric() -> impl Iterator<Item = Law> {
    laws().filter(Law::is_isochoric)
}

/// Random motions in steps of random lengths: what the fast routine makes of six numbers a term is the book's recursion with the
/// stress before in memory. Rounding of a hundred operations and of cancelling stresses.
#[test]
fn forces_are_those_of_the_book() {
    let (series, mut random) = (series(), Random::new(3));
    for law in isochoric() {
        for turned in [false, true] {
            let X = CUBE.map(|x| {
                let by = if turned { random.within(1.5e-3) } else { [0.0; 3] };
                std::array::from_fn(|d| x[d] + by[d])
            });
            let mut specimen = Specimen::new(Element::Q1p0, law, &series, &X);
            let mut history = vec![(0.0, X)];
            let mut before = 0.0;
            for _ in 0..12 {
                let after = 1e-3 * (1.2 + random.signed());
                let x = X.map(|x| {
                    let by = random.within(1e-3);
                    std::array::from_fn(|d| x[d] + by[d])
                });
                if before == 0.0 {
                    specimen.goes(&X, 0.0, after);
                    before = after;
                    continue;
                }
                let f = specimen.goes(&x, before, after).f;
                history.push((before, x));
                let over = law.visit(Book { series: &series, X: &X, history: &history });
                let long = book(&law, &X, &x);
                let expected: Corners<f64> =
                    std::array::from_fn(|a| std::array::from_fn(|d| over[a][d] + long[a][d]));
                let error = relative(&f, &expected);
                assert!(error < 1e-11, "{} turned {turned}: {error:e}", law.name());
                before = after;
            }
        }
    }
}

fn sheared(by: f64) -> [[f64; 3]; 3] {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [by, 0.0, 1.0]]
}

fn stretched(by: f64) -> [[f64; 3]; 3] {
    [[by, 0.0, 0.0], [0.0, by.powf(-0.5), 0.0], [0.0, 0.0, by.powf(-0.5)]]
}

fn about(axis: usize, angle: f64) -> [[f64; 3]; 3] {
    let (sin, cos) = angle.sin_cos();
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut r = [[0.0; 3]; 3];
    r[axis][axis] = 1.0;
    (r[i][i], r[i][j], r[j][i], r[j][j]) = (cos, sin, -sin, cos);
    r
}

/// A step in strain: stress(t) / stress(0+) = (1 + sum r_k e^(-t/tau_k)) / (1 + sum r_k), in simple shear by 0.5 and stretched by
/// 1.5, still or turned a hundred times meanwhile; in steps of any length. The forces turn with the body. Rounding: 1e-13 of the bulk
/// modulus, which is 25 times the shear modulus.
#[test]
fn a_step_in_strain_relaxes_by_the_closed_form() {
    let series = series();
    for element in ELEMENTS {
        for law in isochoric() {
            for strain in [sheared(0.5), stretched(1.5)] {
                for turns in [0.0, 100.0] {
                    let end = 0.05;
                    let at = |t: f64| {
                        let r = about(1, std::f64::consts::TAU * turns * t / end);
                        (r, CUBE.map(|x| times(&r, times(&strain, x))))
                    };
                    let mut specimen = Specimen::new(element, law, &series, &CUBE);
                    let first = specimen.goes(&at(0.0).1, 0.0, 1e-3).f;
                    let (mut t, mut before) = (0.0, 1e-3);
                    for k in 0..20 {
                        t += before;
                        let after = if k % 3 == 0 { 4e-3 } else { 1e-3 };
                        let (r, x) = at(t);
                        let f = specimen.goes(&x, before, after).f;
                        let left = |t: f64| {
                            1.0 + series.terms.iter().map(|k| k.ratio * (-t / k.time).exp()).sum::<f64>()
                        };
                        let expected = first.map(|f| times(&r, f).map(|f| f * left(t) / left(0.0)));
                        let error = relative(&f, &expected);
                        assert!(error < 1e-10, "{element:?} {} {turns} turns at {t}: {error:e}", law.name());
                        before = after;
                    }
                }
            }
        }
    }
}

/// Storage and loss modulus of a block sheared by a small sine, G' = G (1 + sum r w^2 tau^2 / (1 + w^2 tau^2)) and
/// G'' = G sum r w tau / (1 + w^2 tau^2), at 10, 100 and 1000 Hz; work of the overstress and loss of a cycle are both pi G'' gamma^2 V.
/// Two hundred steps a cycle and the shortest time: the midpoint rule is off by (w dt)^2 / 24 and (dt / tau)^2 / 24, at most 1e-4.
#[test]
fn a_sheared_block_has_the_moduli_of_the_series() {
    let series = series();
    let (law, gamma, V) = (Law::from(NeoHookean { g0: 25.0 * G, g1: G }), 1e-4, 1e-6);
    for element in ELEMENTS {
        for frequency in [10.0, 100.0, 1000.0] {
            let omega = std::f64::consts::TAU * frequency;
            let steps_a_cycle = 200 * (1.0f64 / (frequency * 2e-3)).ceil() as usize;
            let dt = 1.0 / (frequency * steps_a_cycle as f64);
            let cycles = (0.3 * frequency).ceil() as usize + 1;
            let mut specimen = Specimen::new(element, law, &series, &CUBE);
            let (mut storage, mut loss_modulus, mut work, mut loss) = (0.0, 0.0, 0.0, 0.0);
            let mut before = 0.0;
            for n in 0..=cycles * steps_a_cycle {
                let phase = omega * n as f64 * dt;
                let x = CUBE.map(|x| times(&sheared(gamma * phase.sin()), x));
                let force = specimen.goes(&x, before, dt);
                before = dt;
                if n > (cycles - 1) * steps_a_cycle {
                    // Shear stress of the upper face.
                    let stress = (4..8).map(|a| force.f[a][0]).sum::<f64>() / 1e-4;
                    storage += 2.0 * stress * phase.sin() / (gamma * steps_a_cycle as f64);
                    loss_modulus += 2.0 * stress * phase.cos() / (gamma * steps_a_cycle as f64);
                    work += force.memory_work;
                    loss += force.memory_loss * dt;
                }
            }
            let wt = |k: &Term| omega * k.time;
            let sum = |f: &dyn Fn(&Term) -> f64| series.terms.iter().map(|k| k.ratio * f(k)).sum::<f64>();
            let expected = [
                G * (1.0 + sum(&|k| wt(k).powi(2) / (1.0 + wt(k).powi(2)))),
                G * sum(&|k| wt(k) / (1.0 + wt(k).powi(2))),
            ];
            close("storage modulus", storage, expected[0], 1e-3);
            close("loss modulus", loss_modulus, expected[1], 1e-3);
            let cycle = std::f64::consts::PI * expected[1] * gamma * gamma * V;
            close("work of a cycle", work, cycle, 1e-3);
            close("loss of a cycle", loss, cycle, 1e-3);
        }
    }
}

/// tan delta of one term that is a share of 0.3 of the instantaneous modulus, tau = 0.1 s: largest at 1.332 Hz, 0.1793.
#[test]
fn the_loss_angle_of_one_term_is_the_known_one() {
    let ratio = 0.3 / 0.7;
    let tangent = |f: f64| {
        let wt = std::f64::consts::TAU * f * 0.1;
        ratio * wt / (1.0 + wt * wt) / (1.0 + ratio * wt * wt / (1.0 + wt * wt))
    };
    let best =
        (1..4000).map(|i| f64::from(i) * 1e-3).max_by(|a, b| tangent(*a).total_cmp(&tangent(*b))).unwrap();
    close("frequency", best, 1.332, 1e-3);
    close("tan delta", tangent(best), 0.1793, 1e-3);
    // And of an element sheared at that frequency.
    let series = Relaxation { terms: vec![Term { ratio, time: 0.1 }] };
    let law = Law::from(NeoHookean { g0: 25.0 * G, g1: G });
    let mut specimen = Specimen::new(Element::Q1p0, law, &series, &CUBE);
    let (steps, cycles) = (400, 4);
    let dt = 1.0 / (best * f64::from(steps));
    let [mut sine, mut cosine] = [0.0; 2];
    for n in 0..=cycles * steps {
        let phase = std::f64::consts::TAU * f64::from(n) / f64::from(steps);
        let x = CUBE.map(|x| times(&sheared(1e-3 * phase.sin()), x));
        let f = specimen.goes(&x, if n == 0 { 0.0 } else { dt }, dt).f;
        if n > (cycles - 1) * steps {
            let stress: f64 = (4..8).map(|a| f[a][0]).sum();
            (sine, cosine) = (sine + stress * phase.sin(), cosine + stress * phase.cos());
        }
    }
    close("tan delta of the element", cosine / sine, 0.1793, 1e-3);
}

/// A body that relaxes, in random motion: a block or a ring, whose elements lie in rows, or are all loose and of any shape.
fn moving(element: Element, loose: bool) -> (Scene, Model, Vec<[f64; 3]>) {
    let mut scene = match loose {
        true => block([0.03, 0.02, 0.02], [3, 2, 2]),
        false => wheel([19, 2, 3], 0.0),
    };
    (scene.road, scene.rim) = (None, None);
    scene.body.element = element;
    scene.body.relaxation = series();
    let mut mesh = Model::new(&scene).unwrap().mesh;
    if loose {
        distort(&mut mesh, 0.01, 0.1);
    }
    let model = Model::from_mesh(mesh, &scene.body).unwrap();
    let mut random = Random::new(5);
    let v = model.mesh.nodes.iter().map(|_| random.within(2.0)).collect();
    (scene, model, v)
}

fn step(time: f64, dt: f64, dt_before: f64) -> Step {
    Step { time, dt, dt_before, rim: [0.0; 6], load: [0.0; 6] }
}

/// Lengths of the steps of the tests on engines, and of those before.
fn lengths() -> Vec<(f64, f64)> {
    let dt = |n: usize| if n % 5 < 2 { 6e-6 } else { 8e-6 };
    (0..40).map(|n| (dt(n), if n == 0 { 0.0 } else { dt(n - 1) })).collect()
}

/// Central differences of a body whose elements are taken one by one.
fn one_by_one(model: &Model, v: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut specimens: Vec<Specimen> = (0..model.element_count())
        .map(|e| {
            let X = model.mesh.hexes[e].map(|n| model.mesh.nodes[n as usize]);
            let mut specimen = Specimen::new(model.element, model.law, &model.relaxation, &X);
            specimen.class = model.classes[model.class_of[e] as usize];
            specimen
        })
        .collect();
    let (mut x, mut v) = (model.mesh.nodes.clone(), v.to_vec());
    for (dt, before) in lengths() {
        let mut f = vec![[0.0; 3]; x.len()];
        for (hex, specimen) in model.mesh.hexes.iter().zip(&mut specimens) {
            let force = specimen.goes(&hex.map(|n| x[n as usize]), before, dt).f;
            hex.iter().zip(force).for_each(|(n, g)| (0..3).for_each(|d| f[*n as usize][d] += g[d]));
        }
        for n in 0..x.len() {
            for d in 0..3 {
                v[n][d] -= 0.5 * (dt + before) * f[n][d] / model.mass[n];
                x[n][d] += dt * v[n][d];
            }
        }
    }
    x
}

/// Displacements of an engine's nodes after the steps, which are looked at, and tried, in between where `disturbed`.
fn on_engine(engine: &mut dyn Engine, model: &Model, v: &[[f64; 3]], disturbed: bool) -> Vec<[f64; 3]> {
    engine.begin_stage(&StageSetup::default()).unwrap();
    engine.set_velocity(v, &[0.0; 6]).unwrap();
    let mut time = 0.0;
    for (dt, before) in lengths() {
        engine.advance(&[step(time, dt, before)]).unwrap();
        time += dt;
        if disturbed {
            engine.sample(&step(time, dt, dt)).unwrap();
            let x = engine.state().unwrap().x;
            let squeezed: Vec<[f64; 3]> = x.iter().map(|x| x.map(|c| 0.99 * c)).collect();
            engine.force(&squeezed, v).unwrap();
        }
    }
    displacements(&engine.state().unwrap().x, model)
}

fn displacements(x: &[[f64; 3]], model: &Model) -> Vec<[f64; 3]> {
    x.iter().zip(&model.mesh.nodes).map(|(x, X)| std::array::from_fn(|d| x[d] - X[d])).collect()
}

/// At every level and for every element, in rows and loose. Single precision: positions round at 4e-9 m, displacements are
/// some 0.5 mm.
#[test]
fn the_engine_moves_as_elements_one_by_one() {
    for element in ELEMENTS {
        for loose in [false, true] {
            let (scene, model, v) = moving(element, loose);
            let expected = displacements(&one_by_one(&model, &v), &model);
            for level in Level::available() {
                for (precision, tolerance) in [(Precision::F64, 1e-11), (Precision::F32, 1e-4)] {
                    let mut engine = engine_at(&model, &scene, precision, 1, level).unwrap();
                    let error = relative(&on_engine(&mut *engine, &model, &v, false), &expected);
                    assert!(
                        error < tolerance,
                        "{element:?} loose {loose} {level:?} {precision:?}: {error:e}"
                    );
                }
            }
        }
    }
}

/// Samples, probes and trial forces leave no trace in what the points remember.
#[test]
fn looking_and_trying_change_nothing() {
    let (scene, model, v) = moving(Element::Q1p0, false);
    for precision in [Precision::F64, Precision::F32] {
        let engine = || engine_at(&model, &scene, precision, 2, Level::detect()).unwrap();
        let undisturbed = on_engine(&mut *engine(), &model, &v, false);
        assert_eq!(undisturbed, on_engine(&mut *engine(), &model, &v, true));
    }
}

/// A step that fails takes back what its elements have kept already: the steps before it can be taken once more.
#[test]
fn a_failing_step_leaves_what_was_remembered_before_it() {
    let (scene, model, mut v) = moving(Element::Q1p0, false);
    v.iter_mut().flatten().for_each(|c| *c *= 60.0);
    let failing = |together: usize| {
        let mut engine = engine_at(&model, &scene, Precision::F64, 1, Level::detect()).unwrap();
        engine.begin_stage(&StageSetup::default()).unwrap();
        engine.set_velocity(&v, &[0.0; 6]).unwrap();
        let steps: Vec<Step> =
            (0..60).map(|n| step(f64::from(n) * 6e-6, 6e-6, if n == 0 { 0.0 } else { 6e-6 })).collect();
        let failed = steps.chunks(together).any(|steps| engine.advance(steps).is_err());
        assert!(failed, "nothing failed");
        engine.state().unwrap()
    };
    assert_eq!(failing(1), failing(60));
}

/// The step is that of the instantaneous modulus: as large as that of an elastic body with that modulus, within the residual of
/// the search.
#[test]
fn the_critical_step_is_that_of_the_instantaneous_modulus() {
    let mut scene = block([0.03, 0.02, 0.02], [4, 3, 3]);
    // A bulk modulus that does not drown the shear modulus.
    scene.body.law = NeoHookean { g0: G, g1: G }.into();
    scene.body.relaxation = series();
    let of = |scene: &Scene| {
        let model = Model::new(scene).unwrap();
        simulate_with(scene, model, Precision::F64, 1).unwrap().totals.critical_first
    };
    let relaxing = of(&scene);
    let mut elastic = scene.clone();
    elastic.body.relaxation = Relaxation::default();
    let long_term = of(&elastic);
    elastic.body.law = elastic.body.law.with_shear_scaled(series().instantaneous());
    close("critical step", relaxing, of(&elastic), 2e-3);
    assert!(relaxing < 0.9 * long_term, "{relaxing:e} {long_term:e}");
}

/// A wheel pressed slowly and rolled: in the press everything has relaxed, so its force is that of the law alone; rolling loses
/// energy, and both balances close.
fn rolled() -> Scene {
    let mut scene = wheel([44, 2, 4], 0.5);
    scene.body.viscosity = Some(20.0);
    scene.body.relaxation = series();
    let down = press(Drive::Displacement { to: -2e-3, ramp: 0.02 });
    let spin = Drive::Velocity { to: 70.0, ramp: 0.0 };
    let rim = RimMotion { x: Drive::Velocity { to: 2.6, ramp: 0.0 }, spin, ..HELD };
    let roll = Stage { initial_velocity: Some(InitialVelocity::Rim), rim, ..explicit("roll", 0.02) };
    scene.stages = vec![down, roll];
    scene
}

#[test]
fn a_slow_press_is_that_of_the_law_alone() {
    let mut scene = rolled();
    scene.stages.truncate(1);
    let of = |scene: &Scene| {
        let out = simulate_with(scene, Model::new(scene).unwrap(), Precision::F64, 1).unwrap();
        (out.last().road_fz_N, out.last().strain_J, out.last().viscous_work_J)
    };
    let (force, strain, _) = of(&scene);
    scene.body.relaxation = Relaxation::default();
    let (elastic, energy, _) = of(&scene);
    // Two rests within the residual of 1e-4.
    close("force", force, elastic, 1e-3);
    close("strain energy", strain, energy, 1e-3);
}

#[test]
fn the_balances_of_a_rolling_wheel_close_and_threads_change_no_bit() {
    let scene = rolled();
    let model = Model::new(&scene).unwrap();
    for precision in [Precision::F64, Precision::F32] {
        let run = |threads| simulate_with(&scene, model.clone(), precision, threads).unwrap();
        let one = run(1);
        let rows = one.stage("roll");
        let largest = rows.iter().fold(0.0f64, |m, r| m.max(r.strain_J + r.kinetic_J));
        for row in &rows {
            // The time integration of contact that changes at every step, as without relaxation.
            let error = row.stored_balance_error_J.abs();
            assert!(error < 5e-3 * largest, "{precision:?} {}: {error:e} of {largest:e}", row.time_s);
            assert!(row.dissipation_J >= 0.0);
        }
        assert!(
            rows.windows(2).all(|r| r[1].dissipation_J > r[0].dissipation_J),
            "energy is lost all the time"
        );
        let two = run(2);
        assert_eq!(one.samples, two.samples);
        assert_eq!(one.snapshots, two.snapshots);
    }
}

/// What rolling loses [W] with one term of this time: mean over the last half of a stretch of rolling, from a press that the wheel has
/// had time to relax in.
fn rolling_loss(time: f64) -> f64 {
    let mut scene = rolled();
    scene.body.viscosity = None;
    scene.friction = None;
    scene.body.relaxation = Relaxation { terms: vec![Term { ratio: 0.5, time }] };
    let out = simulate_with(&scene, Model::new(&scene).unwrap(), Precision::F64, 1).unwrap();
    let rows = out.stage("roll");
    let (middle, last) = (rows[rows.len() / 2], rows[rows.len() - 1]);
    (last.dissipation_J - middle.dissipation_J) / (last.time_s - middle.time_s)
}

/// A wheel loses most where the material's time is that of passing the road, patch length over speed, and little where everything has
/// relaxed at once or nothing has: as the loss modulus, w tau / (1 + w^2 tau^2), which at a hundred times the best time, or a hundredth, is
/// a fiftieth of its largest value. A passing is no sine: a fifth is asked for.
#[test]
fn rolling_loses_most_where_the_loss_modulus_is_largest() {
    let [fast, best, slow] = [2e-5, 2e-3, 0.2].map(rolling_loss);
    assert!(best > 5.0 * fast && best > 5.0 * slow, "{fast} {best} {slow} W");
    assert!(fast > 0.0 && slow > 0.0);
}

/// The shipped scene, as anybody runs it: the loss angle from the force that drives the block, and the energy that a cycle loses.
#[test]
fn the_sheared_block_of_the_scenes_lags_by_its_loss_angle() {
    let outcome = hexroll_lab::rig::run(&shipped::<&str>("sheared_rubber_loss", &[]));
    let omega = std::f64::consts::TAU * 1.332;
    let half = 100;
    // Means over windows: of the forces at the starts of their steps. Two whole cycles.
    let [mut sine, mut cosine] = [0.0; 2];
    let rows = outcome.samples.len();
    for (sample, reactions) in outcome.samples.iter().zip(&outcome.reactions).skip(rows - 2 * half) {
        let force = reactions.iter().find(|r| r.set == "z-max").unwrap().components[0].unwrap()[1];
        let phase = omega * (sample.time_s - 0.5 * (7.5075e-3 + sample.dt_s));
        (sine, cosine) = (sine + force * phase.sin(), cosine + force * phase.cos());
    }
    close("tan delta", cosine / sine, 0.1793, 5e-3);
    let lost = |row: usize| outcome.samples[row].dissipation_J;
    let cycle = lost(rows - 1) - lost(rows - 1 - half);
    close("loss of a cycle", cycle, 0.1325, 5e-3);
    let worst = outcome.samples.iter().fold(0.0f64, |m, s| m.max(s.stored_balance_error_J.abs()));
    assert!(worst < 5e-3 * outcome.last().external_work_J, "{worst} of {}", outcome.last().external_work_J);
}

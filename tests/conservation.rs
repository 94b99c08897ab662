//! Balances: energy to round-off whatever the step does, momentum of a free body, stored energy to second order.

use hexroll::engine::{StageSetup, Window, Works};
use hexroll::model::Model;
use hexroll::physics::friction::Coulomb;
use hexroll::physics::material::MooneyRivlin;
use hexroll::physics::tensor::{Vec3, add, cross, scale, sub};
use hexroll::run::stability;
use hexroll::scene::{Drive, Element, Friction, Law, Scene};
use hexroll_lab::rig::{self, Driver, ELEMENTS, GROUND, block, wheel};

/// Totals of a driven simulation.
#[derive(Default)]
struct Book {
    works: Works,
    /// Largest single term so far [J].
    largest: f64,
    worst: f64,
}

impl Book {
    /// Books a window: kinetic energy less everything that was done, from rest.
    fn add(&mut self, w: &Window) {
        self.works.accumulate(&w.works);
        let Works { internal, viscous, damping, body_force, rim, normal, friction } = self.works;
        for term in [w.kinetic, internal, viscous, damping, body_force, rim, normal, friction] {
            self.largest = self.largest.max(term.abs());
        }
        let error = w.kinetic - internal - self.works.without_internal();
        self.worst = self.worst.max(error.abs());
    }
}

/// A small viscous wheel with gravity, friction and damping, pressed down, driven forward and spun, by steps that change
/// by 10 % from one to the next.
fn everything_at_once(scene: &Scene, free: [Option<f64>; 6], each: impl Fn(&Window, &Book)) -> Book {
    let model = Model::new(scene).unwrap();
    let mut driver = Driver::new(&model, scene).unwrap();
    driver.engine.begin_stage(&StageSetup { mass_damping: 50.0, free, ..Default::default() }).unwrap();
    let dt = 0.8 * stability::element_bound(&model).unwrap();
    let [x, y, z] = model.mesh.axle;
    let mut book = Book::default();
    for window in 0..60 {
        let mut steps = Vec::new();
        for n in 0..50 {
            let dt = dt * if n % 2 == 0 { 1.0 } else { 0.9 };
            let t = driver.time + dt;
            // Half a turn with slip, sideways too, on a height that swings by 0.3 mm.
            let height = z - 1e-3 * (1.0 - (-t / 2e-3).exp()) + 3e-4 * (1500.0 * t).sin();
            driver.rim = [x + 2.6 * t, y + 0.2 * t, height, 0.1 * t, 0.0, 70.0 * t];
            let mut step = driver.step(dt);
            step.load[2] = if free[2].is_some() { -200.0 } else { 0.0 };
            (driver.time, driver.dt_before) = (t, dt);
            steps.push(step);
        }
        driver.engine.advance(&steps).unwrap();
        let w = driver.sample(if window % 2 == 0 { dt } else { 0.9 * dt }).unwrap();
        book.add(&w);
        each(&w, &book);
    }
    book
}

/// The accumulated-work balance closes to 1e-12 of its largest term, with every force that there is and every formulation.
/// 150,000 node-steps of round-off a window, of random sign: about 1e-14.
#[test]
fn the_energy_balance_closes_whatever_the_step_does() {
    let prescribed = [None; 6];
    let free = [None, None, Some(0.05), None, None, Some(1e-5)];
    for (element, free) in ELEMENTS.into_iter().flat_map(|e| [(e, prescribed), (e, free)]) {
        let mut scene = wheel([16, 2, 3], 0.6);
        scene.body.element = element;
        scene.body.viscosity = Some(20.0);
        scene.gravity = [0.0, 0.0, -9.81];
        let book = everything_at_once(&scene, free, |w, book| {
            // Losses are losses at any time: totals, and for damping every window.
            assert!(w.works.damping <= 0.0, "damping gives {:?}", w.works);
            assert!(book.works.friction <= 0.0 && book.works.viscous <= 0.0, "{:?}", book.works);
        });
        assert!(book.worst < 1e-12 * book.largest, "{element:?}: {:e}", book.worst / book.largest);
        let Works { viscous, damping, body_force, rim, normal, friction, internal } = book.works;
        for (name, work) in [
            ("viscous", viscous),
            ("damping", damping),
            ("body force", body_force),
            ("rim", rim),
            ("normal", normal),
            ("friction", friction),
            ("internal", internal),
        ] {
            assert!(work.abs() > 1e-6 * book.largest, "the {name} force is part of the test: {work}");
        }
    }
}

/// A free block of rubber, 20 mm, with a smooth velocity field: a spin and a breathing mode that strains it by about
/// `strain`. Returns the model and its driver.
fn vibrating(scene: &Scene, strain: f64) -> (Model, Driver) {
    let model = Model::new(scene).unwrap();
    let mut driver = Driver::new(&model, scene).unwrap();
    let spin = [150.0, -80.0, 220.0];
    // An axial half wave: v = c strain sin(pi x / L) at bar speed 84 m/s, the block's centre at the origin.
    let v: Vec<Vec3<f64>> = model
        .mesh
        .nodes
        .iter()
        .map(|&x| {
            let r = sub(x, [0.01; 3]);
            let wave = 84.0 * strain * (std::f64::consts::PI * r[0] / 0.02).sin();
            add(cross(spin, r), [wave, 0.0, 0.0])
        })
        .collect();
    driver.engine.set_velocity(&v, &[0.0; 6]).unwrap();
    (model, driver)
}

fn soft_block() -> Scene {
    let mut scene = block([0.02; 3], [4; 3]);
    // Compressible, so that the smooth axial mode dominates.
    scene.body.law = Law::MooneyRivlin(MooneyRivlin { g0: 5e6, g1: 2e6, g2: 0.64e6 });
    scene
}

/// Linear and angular momentum about the origin.
fn momenta(model: &Model, driver: &mut Driver) -> [Vec3<f64>; 2] {
    let state = driver.engine.state().unwrap();
    let mut sums = [[0.0; 3]; 2];
    for ((x, v), &m) in state.x.iter().zip(&state.v).zip(&model.mass) {
        sums[0] = add(sums[0], scale(*v, m));
        sums[1] = add(sums[1], scale(cross(*x, *v), m));
    }
    sums
}

/// Twenty thousand steps of a spinning, vibrating block: linear and angular momentum grow like round-off.
#[test]
fn a_free_body_keeps_its_momenta() {
    for element in ELEMENTS {
        let mut scene = soft_block();
        scene.body.element = element;
        let (model, mut driver) = vibrating(&scene, 0.05);
        let dt = 0.8 * stability::element_bound(&model).unwrap();
        let before = momenta(&model, &mut driver);
        driver.advance((0..20_000).map(|n| dt * [1.0, 0.95][n % 2])).unwrap();
        let after = momenta(&model, &mut driver);
        let speed = 5.0; // the corners' speed from the spin, and the wave's [m/s]
        let mass: f64 = model.mass.iter().sum();
        for (what, unit, k) in [("linear", mass * speed, 0), ("angular", mass * speed * 0.01, 1)] {
            let drift = rig::largest([&sub(after[k], before[k])]) / unit;
            // A random walk of 20,000 steps of 1e-16 of forces far above the mean: 140 x 1e-15, with a margin of 10.
            assert!(drift < 1e-12, "{element:?}: {what} momentum drifts by {drift:e} of the body's own");
        }
    }
}

/// Stored-energy error over the block's own energy after every `every` steps of `share` of the element bound.
fn stored_errors(scene: &Scene, strain: f64, share: f64, every: usize, samples: usize) -> Vec<f64> {
    let (model, mut driver) = vibrating(scene, strain);
    let dt = share * stability::element_bound(&model).unwrap();
    let state = driver.engine.state().unwrap();
    let square = |v: &Vec3<f64>| v.iter().map(|c| c * c).sum::<f64>();
    let start: f64 = state.v.iter().zip(&model.mass).map(|(v, m)| 0.5 * m * square(v)).sum();
    let error = |_| {
        driver.advance(std::iter::repeat_n(dt, every)).unwrap();
        let w = driver.sample(dt).unwrap();
        (w.strain + w.hourglass + w.probe.mixed_kinetic - start) / start
    };
    (0..samples).map(error).collect()
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}

/// Stored plus kinetic energy of that block over 20,000 steps at 5 % strain: within 1e-2 (`full`, whose
/// bending modes are too stiff: 2e-2), without a trend. The error rises
/// while the smooth mode breaks into short ones (some thousand steps), then stays.
#[test]
fn stored_energy_is_bounded_without_a_trend() {
    for element in ELEMENTS {
        let mut scene = soft_block();
        scene.body.element = element;
        let errors = stored_errors(&scene, 0.05, 0.9, 50, 400);
        let worst = errors.iter().fold(0.0f64, |m, e| m.max(e.abs()));
        let limit = if element == Element::Full { 2e-2 } else { 1e-2 };
        assert!(worst < limit, "{element:?}: {worst}");
        let (second, last) = (rms(&errors[100..200]), rms(&errors[300..]));
        // A drift that reached the second quarter's value by then would double it by the last.
        assert!(
            last < 1.25 * second.max(2e-3),
            "{element:?}: {second} in the second quarter, {last} in the last"
        );
    }
}

/// While the motion is smooth (150 steps, about one period, at 1 % strain) halving the step divides that error by four:
/// the scheme is of second order.
#[test]
fn stored_energy_error_is_of_second_order() {
    for element in ELEMENTS {
        let mut scene = soft_block();
        scene.body.element = element;
        let coarse = rms(&stored_errors(&scene, 0.01, 0.8, 5, 30));
        let fine = rms(&stored_errors(&scene, 0.01, 0.4, 10, 30));
        assert!((3.2..5.0).contains(&(coarse / fine)), "{element:?}: the error falls by {}", coarse / fine);
    }
}

/// Free fall by steps that change by a half from one to the next: x = g t^2 / 2 at every step, to round-off, since a force at
/// t(n) acts over the mean of the two steps beside it. With any other mean a step is off by up to a quarter of dt.
#[test]
fn steps_that_change_keep_free_fall_exact() {
    let mut scene = block([0.02; 3], [2; 3]);
    scene.gravity = [0.0, 0.0, -9.81];
    let model = Model::new(&scene).unwrap();
    let mut driver = Driver::new(&model, &scene).unwrap();
    let dt = 0.8 * stability::element_bound(&model).unwrap();
    for n in 1..=20 {
        driver.advance((0..7).map(|k| dt * [1.0, 0.5, 0.75][(n + k) % 3])).unwrap();
        let fallen = -0.5 * 9.81 * driver.time * driver.time;
        let off = |(x, start): (&Vec3<f64>, &Vec3<f64>)| (x[2] - start[2] - fallen).abs();
        let worst =
            driver.engine.state().unwrap().x.iter().zip(&model.mesh.nodes).map(off).fold(0.0, f64::max);
        // 140 steps of 1e-16 of 0.02 m each, and forces of rounded positions: 1e-15; a fall of 1e-9 to 1e-6 m.
        assert!(worst < 1e-14, "off by {worst:e} m after {} s, fallen {fallen:e} m", driver.time);
    }
}

/// The run loop's own ledger agrees: a block dropped on a rough road with gravity, damping and viscosity.
#[test]
fn the_ledger_of_a_run_closes() {
    // With every force, and with no more than a node pass of its own takes.
    for (gravity, mass_damping) in [(-9.81, 20.0), (0.0, 0.0)] {
        let mut scene = block([0.02, 0.03, 0.02], [3, 3, 3]);
        scene.body.offset = [0.0, 0.0, 5e-4];
        scene.body.velocity = [1.0, 0.3, -0.5];
        scene.body.viscosity = Some(20.0);
        scene.road = Some(GROUND);
        scene.friction = Some(Friction::Coulomb(Coulomb { mu: 0.5 }));
        scene.gravity = [0.0, 0.0, gravity];
        scene.safety = 0.45;
        scene.stages[0].duration = 0.03;
        scene.stages[0].mass_damping = mass_damping;
        assert_eq!(scene.stages[0].rim.spin, Drive::Hold);
        let outcome = rig::run(&scene);
        let ledger = &outcome.totals.ledger;
        assert!(ledger.worst_balance < 1e-12 * ledger.largest_term, "{ledger:?}");
        // The impact excites every frequency: at half of the largest step the second-order error is within 1e-2.
        assert!(ledger.worst_stored_balance < 1e-2 * ledger.largest_term, "{ledger:?}");
        let last = outcome.last();
        assert!(last.friction_work_J < 0.0 && last.viscous_work_J < 0.0, "{last:?}");
        assert_eq!(last.damping_work_J < 0.0, mass_damping > 0.0, "{last:?}");
    }
}

/// A viscous bar spins: once its ringing is out it turns as if rigid, without loss, and stores what rotation strains, by steps of
/// any length. (With the plain symmetric part of the velocity gradient it would lose 2 eta (2/3) (w^2 dt / 2)^2 V.)
#[test]
fn a_steady_rotation_loses_nothing_to_viscosity() {
    const ETA: f64 = 2000.0;
    const SPIN: f64 = 200.0;
    let size = [0.2, 0.02, 0.01];
    let spun = |element: Element, safety: f64| {
        let mut scene = block(size, [10, 1, 1]);
        scene.body.element = element;
        scene.body.viscosity = Some(ETA);
        scene.body.angular_velocity = [0.0, 0.0, SPIN];
        scene.safety = safety;
        scene.stages[0].duration = 1.6;
        scene.output.sample = 0.05;
        rig::run(&scene)
    };
    for element in ELEMENTS {
        let runs = [0.9, 0.45].map(|safety| spun(element, safety));
        for run in &runs {
            let [before, last] = [run.samples.len() - 2, run.samples.len() - 1].map(|n| &run.samples[n]);
            let power = (last.viscous_work_J - before.viscous_work_J) / (last.time_s - before.time_s);
            let volume: f64 = size.iter().product();
            let plain = 4.0 / 3.0 * ETA * (0.5 * SPIN * SPIN * last.dt_s).powi(2) * volume;
            // The works of 50 ms are differences of sums of 0.1 J with 1e-16 of rounding each.
            assert!(power.abs() < 1e-6 * plain, "{element:?}: {power:e} W beside {plain:e} W");
        }
        let [coarse, fine] = [0, 1].map(|n| runs[n].last().strain_J);
        // Central differences turn by (w dt)^2 / 24 too fast, some 1e-7 here, but stretched by forces a step is
        // (w dt)^2 / 12 off in the radius.
        assert!((coarse / fine - 1.0).abs() < 1e-4, "{element:?}: {coarse} and {fine} J");
    }
}

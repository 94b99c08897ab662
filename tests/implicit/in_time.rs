//! Dynamics: Newmark's energy and order, numerical damping, impact, contact that does not ring.

use hexroll::engine::State;
use hexroll::implicit::direct::Direct;
use hexroll::implicit::problem::Problem;
use hexroll::implicit::{Inner, Newton, Scheme, Simulation};
use hexroll::model::Model;
use hexroll::scene::{Element, MeshSpec};
use hexroll_lab::rig::RUBBER;
use hexroll_lab::rig::implicit::*;

fn bar() -> Model {
    let mesh = MeshSpec::Block { size: [0.02, 0.02, 0.1], elements: [1, 1, 5] };
    model(&body(mesh, RUBBER, Element::Q1p0), Some("z-min"))
}

/// A bar held at its foot whose nodes start with a velocity along it that grows linearly.
fn vibrating(model: &Model, speed: f64, delta: f64) -> Simulation<'_> {
    let problem = Problem::new(model, [0.0; 3]);
    let newton = Newton::new(&problem, Inner::ActiveSet(Box::new(Direct::default())), TIGHT);
    let state = State {
        x: model.mesh.nodes.clone(),
        v: model.mesh.nodes.iter().map(|x| [0.0, 0.0, speed * x[2] / 0.1]).collect(),
    };
    let [x, y, z] = model.mesh.axle;
    let scheme = Scheme::Dynamic { delta };
    let mut s = Simulation::new(problem, newton, scheme, None, state, [[x, y, z, 0.0, 0.0, 0.0], [0.0; 6]]);
    s.start(&held(model, 0.0, 0.0, [0.0; 6])).unwrap();
    s
}

fn energy(s: &Simulation<'_>) -> f64 {
    let kinetic =
        s.v.iter()
            .zip(&s.problem.model.mass)
            .map(|(v, m)| 0.5 * m * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
    kinetic.sum::<f64>() + s.problem.assembler.stored(&s.x).strain
}

fn run(s: &mut Simulation<'_>, dt: f64, steps: usize) {
    for n in 1..=steps {
        let target = held(s.problem.model, n as f64 * dt, dt, [0.0; 6]);
        s.step(&target).unwrap_or_else(|e| panic!("{e}"));
    }
}

#[test]
fn newmark_conserves_the_energy_of_a_small_vibration_and_damping_takes_it() {
    let model = bar();
    let mut s = vibrating(&model, 1e-3, 0.0);
    let start = energy(&s);
    let mut worst = 0.0f64;
    for _ in 0..50 {
        run(&mut s, 2e-4, 4);
        worst = worst.max((energy(&s) / start - 1.0).abs());
    }
    // Exact for a linear body; at strains of 1e-5 the law is linear to about as much.
    assert!(worst < 1e-4, "{worst}");
    let mut damped = vibrating(&model, 1e-3, 0.1);
    run(&mut damped, 2e-4, 200);
    assert!(energy(&damped) < 0.95 * start, "numerical damping takes energy: {}", energy(&damped) / start);
}

#[test]
fn newmark_is_of_second_order() {
    let model = bar();
    // The foot moves smoothly by 2 mm in 4 ms: about a period of the bar, so that its lowest modes answer.
    let end = |steps: usize| {
        let mut s = vibrating(&model, 0.0, 0.0);
        let dt = 4e-3 / steps as f64;
        for n in 1..=steps {
            let t = n as f64 / steps as f64;
            let up = 2e-3 * t * t * t * (10.0 + t * (6.0 * t - 15.0));
            let target = held(&model, n as f64 * dt, dt, [0.0, 0.0, up, 0.0, 0.0, 0.0]);
            s.step(&target).unwrap_or_else(|e| panic!("{e}"));
        }
        s.x
    };
    let distance = |a: &[[f64; 3]], b: &[[f64; 3]]| -> f64 {
        a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    };
    let [a, b, c] = [40, 80, 160].map(end);
    let order = (distance(&a, &b) / distance(&b, &c)).log2();
    assert!((order - 2.0).abs() < 0.15, "{order}");
}

#[test]
fn a_pressed_and_released_block_does_not_ring() {
    let mesh = MeshSpec::Block { size: [0.04, 0.04, 0.02], elements: [4, 4, 3] };
    let model = model(&body(mesh, RUBBER, Element::Q1p0), Some("z-max"));
    let mut s = simulation(&model, Scheme::Dynamic { delta: 0.0 }, Some(road(0.5)));
    s.start(&held(&model, 0.0, 0.0, [0.0; 6])).unwrap();
    let dt = 2e-4;
    let mut forces = Vec::new();
    for n in 1..=150 {
        // Pressed by 1 mm over 10 ms, held for 10 ms, lifted over 10 ms.
        let t = n as f64 * dt;
        let down = if t < 0.01 {
            t / 0.01
        } else if t < 0.02 {
            1.0
        } else {
            ((0.03 - t) / 0.01).max(0.0)
        };
        let down = down * down * (3.0 - 2.0 * down);
        s.step(&held(&model, t, dt, [0.0, 0.0, -1e-3 * down, 0.0, 0.0, 0.0]))
            .unwrap_or_else(|e| panic!("step {n}: {e}"));
        let (f, touching) = road_force(&s);
        forces.push(f[2]);
        assert!(f[2] >= 0.0);
        assert!(touching > 0 || f[2] == 0.0);
    }
    let held = &forces[60..95];
    let mean = held.iter().sum::<f64>() / held.len() as f64;
    let scatter = (held.iter().map(|f| (f - mean).powi(2)).sum::<f64>() / held.len() as f64).sqrt() / mean;
    let jumps = held.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max) / mean;
    // What remains is the block's own vibration; a ringing contact swings by its whole force from step to step.
    assert!(scatter < 0.05 && jumps < 0.05, "{held:?}");
}

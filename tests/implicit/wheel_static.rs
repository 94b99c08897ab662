//! The paper's wheel pressed on the road: forces of other programs, quadratic convergence, both inner solvers.

use hexroll::implicit::contact::Status;
use hexroll::implicit::relax::Relaxation;
use hexroll::implicit::{Inner, Limits, Scheme, Simulation};
use hexroll::scene::Element;
use hexroll_lab::rig::given::{DEPTH, LOAD, MESH};
use hexroll_lab::rig::implicit::*;
use hexroll_lab::rig::references::{Node, pressed_nodes};
use hexroll_lab::rig::{close, reference};

/// Presses by 2.2 mm in equal increments; the logs' residuals.
fn press(s: &mut Simulation<'_>, model: &hexroll::model::Model, steps: usize) -> Vec<Vec<f64>> {
    (1..=steps)
        .map(|n| {
            let down = -DEPTH * n as f64 / steps as f64;
            let log = s
                .step(&held(model, n as f64, 1.0, [0.0, 0.0, down, 0.0, 0.0, 0.0]))
                .unwrap_or_else(|e| panic!("{e}"));
            log.iter().map(|i| i.residual).collect()
        })
        .collect()
}

#[test]
fn pressed_by_2_2_mm_the_wheel_carries_300_newtons() {
    for (mu, run) in [(1.0, "pressed-q1p0"), (0.0, "pressed-q1p0-frictionless")] {
        let of = |quantity| reference(&format!("{run}.{quantity}"));
        let model = wheel(MESH, Element::Q1p0);
        let mut s = simulation(&model, Scheme::Static, Some(road(mu)));
        let logs = press(&mut s, &model, 10);
        assert!(logs.iter().all(|l| l.len() <= 11), "more than 10 iterations");
        let (f, touching) = road_force(&s);
        // Nearer than the explicit schemes must come to each other: nothing moves here.
        close("force", f[2], of("road_fz").value, 0.005);
        of("contact_nodes").assert(touching as f64);
        // At rest and in balance: the road carries what the rim presses.
        let rim: f64 = model.mesh.rim.iter().map(|&n| s.internal[n as usize][2]).sum();
        assert!((rim + f[2]).abs() < 1e-6 * f[2], "{rim} {}", f[2]);
    }
}

#[test]
fn newton_converges_quadratically_once_the_contact_set_stands() {
    let model = wheel(MESH, Element::Q1p0);
    let mut s = simulation(&model, Scheme::Static, Some(road(1.0)));
    for log in press(&mut s, &model, 10) {
        // r(k+1) <= C r(k)^2: the last two steps above round-off, C of order one in these units.
        let tail: Vec<f64> = log.iter().skip(1).copied().filter(|r| *r > 1e-9).collect();
        let [.., before, after] = tail[..] else { continue };
        assert!(after < 0.1 * before.max(before * before * 10.0) && after < before.powf(1.5), "{log:?}");
    }
}

#[test]
fn contact_forces_agree_node_by_node_with_another_program() {
    let rows = pressed_nodes();
    let model = wheel(MESH, Element::Q1p0);
    let mut s = simulation(&model, Scheme::Static, Some(road(1.0)));
    // By force, in 10 increments.
    for n in 1..=10 {
        let mut target = held(&model, n as f64, 1.0, [0.0; 6]);
        target.free[2] = Some(0.05);
        target.load[2] = -0.1 * LOAD * n as f64;
        s.step(&target).unwrap_or_else(|e| panic!("{e}"));
    }
    let down = model.mesh.axle[2] - s.q[2];
    close("depth", down, DEPTH, 0.005);
    let (mut square, mut total) = (0.0, 0.0);
    for Node { position, force } in &rows {
        let near = |n: &&u32| {
            let x = model.mesh.nodes[**n as usize];
            (0..3).all(|i| (x[i] - model.mesh.axle[i] - position[i]).abs() < 1e-6)
        };
        let n = *model.mesh.surface.iter().find(near).expect("the same mesh") as usize;
        let d: [f64; 3] = std::array::from_fn(|i| s.contact[n][i] - force[i]);
        square += d.iter().map(|d| d * d).sum::<f64>();
        total += force.iter().map(|f| f * f).sum::<f64>();
    }
    // The other program holds its road by springs (0.3 um of scatter) and follows another friction path.
    assert!((square / total).sqrt() < 0.02);
}

/// The projected relaxation's state is the active set's, by status and force.
fn assert_same(relaxed: &Simulation<'_>, reference: &Simulation<'_>) {
    assert_eq!(relaxed.status, reference.status);
    let largest = reference.contact.iter().flatten().fold(0.0f64, |m, f| m.max(f.abs()));
    for (a, b) in relaxed.contact.iter().zip(&reference.contact) {
        for i in 0..3 {
            // Both stop at residuals of 1e-9 of the internal forces' norm, some 10 times the largest force.
            assert!((a[i] - b[i]).abs() < 1e-6 * largest, "{a:?} {b:?}");
        }
    }
}

const RELAXED: Limits = Limits { tolerance: 1e-9, iterations: 30 };

#[test]
fn the_projected_relaxation_agrees_with_the_active_set() {
    let model = wheel([24, 3, 2], Element::Q1p0);
    for mu in [0.0, 0.1] {
        let mut reference = simulation(&model, Scheme::Static, Some(road(mu)));
        let inner = Inner::Relaxation(Relaxation { omega: 1.6, tolerance: 1e-12, sweeps: 200_000 });
        let mut relaxed = simulation_with(&model, Scheme::Static, Some(road(mu)), inner, RELAXED);
        press(&mut reference, &model, 4);
        press(&mut relaxed, &model, 4);
        let slips = reference.status.iter().filter(|s| **s == Status::Slip).count();
        assert!(mu == 0.0 || slips > 0, "no node slips: nothing is compared");
        assert_same(&relaxed, &reference);
    }
}

#[test]
fn every_contact_force_obeys_its_law() {
    let model = wheel(MESH, Element::Q1p0);
    let mut s = simulation(&model, Scheme::Static, Some(road(0.2)));
    press(&mut s, &model, 6);
    let slips = s.status.iter().filter(|s| **s == Status::Slip).count();
    assert!(slips > 3, "{slips} slip");
    for (k, &n) in model.mesh.surface.iter().enumerate() {
        let (f, x) = (s.contact[n as usize], s.x[n as usize]);
        let (tangential, bound) = (f[0].hypot(f[1]), 0.2 * f[2]);
        match s.status[k] {
            Status::Free => assert!(x[2] > 0.0 && f == [0.0; 3]),
            Status::Stick => assert!(x[2].abs() < 1e-15 && f[2] > 0.0 && tangential <= bound * (1.0 + 1e-9)),
            // The residual of the increment: 1e-10 of the internal forces' norm, about 3 kN.
            Status::Slip => {
                assert!(x[2].abs() < 1e-15 && (tangential - bound).abs() < 1e-6, "{tangential} {bound}")
            }
        }
    }
}

//! The paper's wheel pressed on the road: forces of other programs, quadratic convergence, both inner solvers.

use super::fixtures::*;
use hexroll::implicit::contact::Status;
use hexroll::implicit::relax::Relaxation;
use hexroll::implicit::{Inner, Limits, Scheme, Simulation};
use hexroll::scene::Element;

/// Presses by 2.2 mm in equal increments; the logs' residuals.
fn press(s: &mut Simulation<'_>, model: &hexroll::model::Model, steps: usize) -> Vec<Vec<f64>> {
    (1..=steps)
        .map(|n| {
            let down = -2.2e-3 * n as f64 / steps as f64;
            let log = s
                .step(&held(model, n as f64, 1.0, [0.0, 0.0, down, 0.0, 0.0, 0.0]))
                .unwrap_or_else(|e| panic!("{e}"));
            let shown: Vec<String> =
                log.iter().map(|i| format!("{:.1e} ({} changes)", i.residual, i.changes)).collect();
            println!("{:.2} mm, {:.2} N: {}", 1e3 * down, road_force(s).0[2], shown.join(", "));
            log.iter().map(|i| i.residual).collect()
        })
        .collect()
}

#[test]
fn pressed_by_2_2_mm_the_wheel_carries_300_newtons() {
    for (mu, force, nodes) in [(1.0, 300.3, 22), (0.0, 283.9, 26)] {
        let model = wheel([44, 4, 5], Element::Q1p0);
        let mut s = simulation(&model, Scheme::Static, Some(road(mu)));
        let logs = press(&mut s, &model, 10);
        assert!(logs.iter().all(|l| l.len() <= 11), "more than 10 iterations");
        let (f, touching) = road_force(&s);
        // The bound; another program's number has four digits.
        assert!((f[2] / force - 1.0).abs() < 0.005, "mu = {mu}: {} N", f[2]);
        assert_eq!(touching, nodes);
        // At rest and in balance: the road carries what the rim presses.
        let rim: f64 = model.mesh.rim.iter().map(|&n| s.internal[n as usize][2]).sum();
        assert!((rim + f[2]).abs() < 1e-6 * f[2], "{rim} {}", f[2]);
    }
}

#[test]
fn newton_converges_quadratically_once_the_contact_set_stands() {
    let model = wheel([44, 4, 5], Element::Q1p0);
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
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/wheel_static/880_q1p0_mu1_300N.csv");
    let mut reader = csv::Reader::from_path(file).unwrap();
    // Undeformed position relative to the axle [mm] and force [N].
    let rows: Vec<([f64; 3], [f64; 3])> = reader
        .records()
        .map(|r| {
            let r = r.unwrap();
            let at = |c: usize| r[c].trim().parse::<f64>().unwrap();
            ([at(1), at(2), at(3)], [at(7), at(8), at(9)])
        })
        .collect();
    let model = wheel([44, 4, 5], Element::Q1p0);
    let mut s = simulation(&model, Scheme::Static, Some(road(1.0)));
    // By force: 300 N in 10 increments.
    for n in 1..=10 {
        let mut target = held(&model, n as f64, 1.0, [0.0; 6]);
        target.free[2] = Some(0.05);
        target.load[2] = -30.0 * n as f64;
        s.step(&target).unwrap_or_else(|e| panic!("{e}"));
    }
    let down = model.mesh.axle[2] - s.q[2];
    println!("300 N: {:.4} mm", 1e3 * down);
    assert!((down / 2.2e-3 - 1.0).abs() < 0.005, "{down}");
    let (mut square, mut worst, mut total) = (0.0, 0.0f64, 0.0);
    for (place, force) in &rows {
        let near = |n: &&u32| {
            let x = model.mesh.nodes[**n as usize];
            (0..3).all(|i| (1e3 * (x[i] - model.mesh.axle[i]) - place[i]).abs() < 1e-3)
        };
        let n = *model.mesh.surface.iter().find(near).expect("the same mesh") as usize;
        let d: [f64; 3] = std::array::from_fn(|i| s.contact[n][i] - force[i]);
        square += d.iter().map(|d| d * d).sum::<f64>();
        worst = d.iter().fold(worst, |m, d| m.max(d.abs()));
        total += force.iter().map(|f| f * f).sum::<f64>();
    }
    println!("{} nodes: rms {:.2} %, worst {worst:.3} N", rows.len(), 100.0 * (square / total).sqrt());
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
        println!("mu {mu}: {slips} slip");
        assert!(mu == 0.0 || slips > 0, "no node slips: nothing is compared");
        assert_same(&relaxed, &reference);
    }
}

#[test]
fn every_contact_force_obeys_its_law() {
    let model = wheel([44, 4, 5], Element::Q1p0);
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

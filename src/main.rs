use hexroll::cpu::CpuEngine;
use hexroll::engine::Engine;
use hexroll::model::Model;
use hexroll::record::{Sample, Snapshot};
use hexroll::run::{Observer, Progress};
use hexroll::scene::*;
struct P(Vec<Sample>);
impl Observer for P {
    fn sample(&mut self, s: &Sample, p: &Progress) -> hexroll::Result<()> {
        if self.0.len() % 10 == 9 && std::env::var("Q").is_err() {
            println!(
                "{} t={:.4} steps {} dt {:.3e} Fx {:.2} Fy {:.2} Fz {:.2} My {:.3} K {:.3e} W {:.3e} bal {:.1e} st {:.1e} A {:.2e} n {:.1} s {:.2} z {:.5}",
                p.stage,
                s.time_s,
                p.steps,
                s.dt_s,
                s.road_fx_N,
                s.road_fy_N,
                s.road_fz_N,
                s.rim_my_Nm,
                s.kinetic_J,
                s.strain_J,
                s.balance_error_J,
                s.stored_balance_error_J,
                s.contact_area_m2,
                s.contact_nodes,
                s.sticking_share,
                s.axle_z_m
            );
        }
        self.0.push(s.clone());
        Ok(())
    }
    fn snapshot(&mut self, _: &Snapshot, _: &str) -> hexroll::Result<()> {
        Ok(())
    }
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let f = |i: usize, d: f64| a.get(i).and_then(|s| s.parse().ok()).unwrap_or(d);
    let (n, eta, mu, threads, single, free) =
        (f(1, 1.0) as usize, f(2, 0.0), f(3, 1.0), f(4, 2.0) as usize, f(5, 0.0) != 0.0, f(6, 0.0) != 0.0);
    let motion = RimMotion {
        x: Drive::Hold,
        y: Drive::Hold,
        z: if free {
            Drive::Free { mass: 0.05, load: -300.0, ramp: 0.02 }
        } else {
            Drive::Displacement { to: -2.2e-3, ramp: 0.02 }
        },
        steer: Drive::Hold,
        camber: Drive::Hold,
        spin: Drive::Hold,
    };
    let press = Stage {
        name: "press".into(),
        method: Method::QuasiStatic { kinetic_ratio: 1e-8, residual: 1e-4 },
        duration: 0.2,
        mass_damping: 3000.0,
        initial_velocity: None,
        rim: motion,
    };
    let roll = Stage {
        name: "roll".into(),
        method: Method::Explicit,
        duration: std::env::var("D").ok().and_then(|s| s.parse().ok()).unwrap_or(0.1),
        mass_damping: 0.0,
        initial_velocity: Some(InitialVelocity::Rim),
        rim: RimMotion {
            x: Drive::Velocity { to: 2.59, ramp: 0.0 },
            z: Drive::Hold,
            spin: Drive::Velocity { to: 70.0, ramp: 0.0 },
            ..motion
        },
    };
    let scene = Scene {
        file: "x".into(),
        hash: "".into(),
        title: "".into(),
        source: "".into(),
        expected: "".into(),
        body: Body {
            mesh: MeshSpec::Ring {
                outer_radius: 0.039,
                inner_radius: 0.017,
                width: 0.0175,
                elements: [44 * n, 4 * n, 5 * n],
            },
            offset: [0.; 3],
            density: 1100.,
            law: Law::NeoHookean { g0: 65.1e6, g1: 2.64e6 },
            viscosity: (eta > 0.).then_some(eta),
            element: match f(7, 0.0) as i32 {
                1 => Element::Full,
                2 => Element::UniformGradient { hourglass: 0.15 },
                _ => Element::Q1p0,
            },
            lumping: if std::env::var("EQ").is_ok() { Lumping::Equal } else { Lumping::RowSum },
            velocity: [0.; 3],
            angular_velocity: [0.; 3],
        },
        rim: Some(Rim { nodes: NodeSet::Inner }),
        road: Some(Road::Plane { point: [0.; 3], normal: [0., 0., 1.], velocity: [0.; 3] }),
        friction: (mu > 0.).then_some(Friction::Coulomb { mu }),
        gravity: [0.; 3],
        safety: std::env::var("S").ok().and_then(|s| s.parse().ok()).unwrap_or(0.9),
        stages: vec![press, roll],
        output: Output {
            sample: std::env::var("W").ok().and_then(|s| s.parse().ok()).unwrap_or(1e-3),
            snapshots: Snapshots::StageEnds,
            pictures: vec![],
        },
    };
    let model = Model::new(&scene).unwrap();
    println!("classes {}", model.classes.len());
    let gpu_mode = std::env::var("GPU").ok();
    let mut engine: Box<dyn Engine> = if let Some(mode) = gpu_mode {
        let gpu = hexroll::gpu::Gpu::open(None).unwrap();
        match hexroll::gpu::GpuEngine::new(&gpu, &model, &scene, mode == "+") {
            Ok(e) => Box::new(e),
            Err(e) => {
                println!("{e}");
                return;
            }
        }
    } else if single {
        Box::new(CpuEngine::<f32>::new(&model, &scene, threads))
    } else {
        Box::new(CpuEngine::<f64>::new(&model, &scene, threads))
    };
    let mut p = P(vec![]);
    let t = std::time::Instant::now();
    let totals = hexroll::run::run(&scene, &model, &mut *engine, &mut p);
    println!("{:?} {totals:?}", t.elapsed());
    for s in p.0.iter().filter(|s| s.stage == "roll").take(100) {
        println!(
            "ROW {} {} {} {} {} {}",
            s.time_s,
            s.road_fx_N,
            s.road_fz_N,
            s.rim_my_Nm,
            s.contact_nodes,
            s.contact_nodes * s.sticking_share
        );
    }
    let r: Vec<&Sample> = p.0.iter().filter(|s| s.stage == "roll").collect();
    for b in r.chunks(10) {
        print!(
            "{:.1}/{:.1} ",
            b.iter().map(|s| s.road_fx_N).sum::<f64>() / b.len() as f64,
            b.iter().map(|s| s.road_fz_N).sum::<f64>() / b.len() as f64
        );
    }
    println!();
    let tail: Vec<f64> = r.iter().rev().take(2400).map(|s| s.road_fz_N).collect();
    let m = tail.iter().sum::<f64>() / tail.len() as f64;
    println!(
        "std Fz {} mean {}",
        (tail.iter().map(|f| (f - m) * (f - m)).sum::<f64>() / tail.len() as f64).sqrt(),
        m
    );
    let k = p.0.len().saturating_sub(30);
    let mean = |f: fn(&Sample) -> f64| p.0[k..].iter().map(f).sum::<f64>() / 30.;
    println!(
        "means {} {} {} {}",
        mean(|s| s.road_fx_N),
        mean(|s| s.road_fy_N),
        mean(|s| s.road_fz_N),
        mean(|s| s.rim_my_Nm)
    );
}

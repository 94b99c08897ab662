//! The road is a constraint: nothing is below it at the end of a step, and what sticks to a resting road stays.

use crate::rig::{Plan, Who, dot, engine, note, safe_step, scene};
use hexroll::engine::{State, Step, Window};
use hexroll::gpu::Gpu;
use hexroll::model::Model;
use hexroll::physics::road::Plane;
use hexroll::scene::{Road, Scene};

/// Half the distance of neighbouring f32 numbers at 40 mm, the size of the block: what one rounding of a coordinate
/// can do.
const ROUNDING: f64 = 0.03125 * f32::EPSILON as f64 / 2.0;

fn block(road: &[&str]) -> (Scene, Model, Plan) {
    let changes =
        ["body.mesh.elements=[4, 4, 2]", "stage.0.rim.z={ displacement = \"-1 mm\", ramp = \"5 ms\" }"];
    let scene = scene("pressed_block", &[&changes, road].concat());
    let model = Model::new(&scene).unwrap();
    let plan = Plan::of_first_stage(&scene, &model, safe_step(&model), 20, 40);
    (scene, model, plan)
}

/// What came of the plan: the windows, and the state after each (a window's positions are rounded to single precision).
struct Track(Vec<(Window, State)>);

fn track(gpu: &Gpu, who: Who, model: &Model, scene: &Scene, plan: &Plan) -> Track {
    let mut engine = engine(gpu, who, model, scene);
    engine.begin_stage(&plan.setup).unwrap();
    let nexts = plan.windows[1..].iter().map(|w| &w[0]).chain([&plan.next]);
    let window = |(steps, next): (&Vec<Step>, &Step)| {
        engine.advance(steps).unwrap();
        (engine.sample(next).unwrap(), engine.state().unwrap())
    };
    Track(plan.windows.iter().zip(nexts).map(window).collect())
}

fn plane(scene: &Scene) -> ([f64; 3], [f64; 3]) {
    let Some(Road::Plane(Plane { point, normal, .. })) = scene.road else { panic!("no road") };
    (point, normal)
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|d| a[d] - b[d])
}

impl Track {
    /// Deepest gap of a surface node at the end of any window [m].
    fn deepest(&self, model: &Model, scene: &Scene) -> f64 {
        let (point, normal) = plane(scene);
        let gap = |state: &State, n: u32| dot(normal, difference(state.x[n as usize], point));
        let gaps = self.0.iter().flat_map(|(_, state)| model.mesh.surface.iter().map(|&n| gap(state, n)));
        gaps.fold(f64::INFINITY, f64::min)
    }

    /// Furthest that a node moved along the road in a window in which it stuck all the time, and how many did.
    fn creep(&self, model: &Model, scene: &Scene) -> (f64, usize) {
        let (_, normal) = plane(scene);
        let (mut most, mut count) = (0.0f64, 0);
        for pair in self.0.windows(2) {
            let [(before, from), (after, to)] = pair else { unreachable!("windows of two") };
            for (k, &n) in model.mesh.surface.iter().enumerate() {
                let stuck = u64::from(after.surface[k].sticking) == after.steps && before.surface[k].sticks;
                if stuck {
                    let moved = difference(to.x[n as usize], from.x[n as usize]);
                    let along: [f64; 3] = std::array::from_fn(|d| moved[d] - dot(moved, normal) * normal[d]);
                    most = most.max(dot(along, along).sqrt());
                    count += 1;
                }
            }
        }
        (most, count)
    }
}

/// A level road through the origin is met exactly. The height of a lifted one is rounded to single precision (its
/// digits are finer than the block's), a tilted one rounds three products: measured 0.04 roundings of a coordinate.
pub fn exact(gpu: &Gpu) {
    let lifted =
        ["road.point=[\"0 m\", \"0 m\", \"0.137 mm\"]", "body.offset=[\"0 m\", \"0 m\", \"0.137 mm\"]"];
    let tilted = ["road.normal=[0.05, 0.02, 1]"];
    for (name, road, roundings) in
        [("level", &[][..], 0.0), ("lifted", &lifted, 0.1), ("tilted", &tilted, 0.5)]
    {
        let (scene, model, plan) = block(road);
        for who in [Who::Cpu32, Who::Gpu, Who::Plus] {
            let found = track(gpu, who, &model, &scene, &plan);
            let (gap, (creep, sticking)) = (found.deepest(&model, &scene), found.creep(&model, &scene));
            note(|| {
                let [gap, creep] = [gap, creep].map(|length| length / ROUNDING);
                format!("{name} {who:?}: gap {gap:.3} roundings, creep {creep:.3} of {sticking}")
            });
            assert!(sticking > 50, "{name} {who:?}: only {sticking} node-windows stick");
            assert!(gap >= -roundings * ROUNDING, "{name} {who:?}: {gap:.2e} m deep");
            let still = if name == "tilted" { 0.5 * ROUNDING } else { 0.0 };
            assert!(creep <= still, "{name} {who:?}: a sticking node moved by {creep:.2e} m");
        }
    }
}

/// Contact step by step is what the windows hold node by node: impulses and node-steps; and a node that changes its
/// state has touched before or after. Sums in single precision of some hundred numbers: 1e-5.
pub fn steps_add_up(gpu: &Gpu) {
    let (scene, model, plan) = block(&[]);
    for who in [Who::Gpu, Who::Plus] {
        let (mut impulse, mut changes) = ([0.0; 3], 0);
        for ((window, _), steps) in track(gpu, who, &model, &scene, &plan).0.iter().zip(&plan.windows) {
            assert_eq!(window.step_contact.len(), steps.len());
            let by_step = |d: usize| window.step_contact.iter().map(|s| s.force[d] * s.dtm).sum::<f64>();
            let by_node = |d: usize| window.surface.iter().map(|s| s.impulse[d]).sum::<f64>();
            let size = window.surface.iter().map(|s| dot(s.impulse, s.impulse).sqrt()).sum::<f64>();
            for d in 0..3 {
                let [step, node] = [by_step(d), by_node(d)];
                assert!((step - node).abs() <= 1e-5 * size, "{who:?}: {step} by steps, {node} by nodes");
                impulse[d] += step;
            }
            let touching: u32 = window.step_contact.iter().map(|s| s.touching).sum();
            assert_eq!(touching, window.surface.iter().map(|s| s.touching).sum::<u32>());
            let last = window.step_contact.last().unwrap().touching;
            assert_eq!(last as usize, window.surface.iter().filter(|s| s.touches).count());
            changes += window.step_contact.iter().map(|s| s.changes).sum::<u32>();
            assert!(window.step_contact.iter().zip(steps).all(|(s, step)| s.dtm == step.dtm()));
        }
        assert!(impulse[2] > 0.0 && changes > 0, "{who:?}: {impulse:?} N s, {changes} changes");
    }
}

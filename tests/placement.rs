//! Where a body begins: never inside the road, whose step out of it would make energy from nothing.

use hexroll::cpu::Precision;
use hexroll::model::Model;
use hexroll::physics::road::{Drum, Plane, Road};
use hexroll::scene::Scene;
use hexroll_lab::rig::{block, explicit, ring, scene, simulate_with};

const PLANE: Plane = Plane { point: [0.0; 3], normal: [0.0, 0.0, 1.0], velocity: [0.0; 3] };

/// The block of 40 x 40 x 20 mm, lifted by `lift` [m] over the plane z = 0.
fn lifted(lift: f64) -> Scene {
    let mut scene = block([0.04, 0.04, 0.02], [4, 4, 2]);
    scene.road = Some(PLANE.into());
    scene.body.offset = [0.0, 0.0, lift];
    scene.stages = vec![explicit("wait", 2e-3)];
    scene.output.sample = 2e-4;
    scene
}

/// Smallest gap of the nodes that can touch the road [m].
fn lowest(model: &Model, road: &Road) -> f64 {
    let gaps = model.mesh.surface.iter().map(|&n| road.gap(model.mesh.nodes[n as usize]));
    gaps.fold(f64::INFINITY, f64::min)
}

#[test]
fn a_body_inside_the_road_is_refused_with_its_depth_and_a_remedy() {
    for depth in [1e-7, 1e-4, 1e-3, 5e-3] {
        let error = Model::new(&lifted(-depth)).expect_err("inside the road").to_string();
        let said = format!("25 of 66 surface nodes, the deepest by {:.6} mm", 1e3 * depth);
        assert!(
            error.contains("body.offset: the body begins inside the road: ") && error.contains(&said),
            "{error}"
        );
        let remedy = "write place = \"on-road\", or offset = [\"0.000000000 mm\", \"0.000000000 mm\", \"0.000000000 mm\"]";
        assert!(error.contains(remedy), "{error}");
    }
    // Where it touches the road, also but for the rounding of its place, it may begin.
    for lift in [-1e-15, 0.0, 1e-9, 1e-3] {
        Model::new(&lifted(lift)).unwrap();
    }
}

#[test]
fn a_body_placed_on_a_road_touches_it() {
    let tilted = |slope: f64| {
        let length = (1.0 + slope * slope).sqrt();
        Plane { point: [0.0, 0.0, 0.03], normal: [-slope / length, 0.0, 1.0 / length], ..PLANE }
    };
    let drum = |curvature: f64| Drum {
        point: [0.01, 0.0, 0.0],
        normal: [0.0, 0.0, 1.0],
        axis: [0.0, 1.0, 0.0],
        curvature,
        speed: 0.0,
    };
    let roads: [Road; 5] =
        [tilted(0.0).into(), tilted(0.7).into(), tilted(-3.0).into(), drum(2.0).into(), drum(-2.0).into()];
    for road in roads {
        for (mesh, lift) in
            [(ring([16, 2, 3]), -0.01), (ring([16, 2, 3]), 0.05), (lifted(0.0).body.mesh, -0.02)]
        {
            let mut scene = scene(mesh);
            scene.road = Some(road.clone());
            scene.body.offset = [0.002, 0.0, lift];
            scene.body.on_road = true;
            let model = Model::new(&scene).unwrap();
            // The gap is found to 1e-12 of the body's size, some 0.1 m.
            let gap = lowest(&model, &road);
            assert!(gap.abs() < 1e-13, "{road:?}: {gap}");
        }
    }
    let mut scene = scene(ring([16, 2, 3]));
    scene.road = Some(drum(-100.0).into());
    scene.body.on_road = true;
    let error = Model::new(&scene).expect_err("the drum is smaller than the wheel").to_string();
    assert!(error.contains("body.place: ") && error.contains("a larger drum"), "{error}");
}

/// A body put on a tilted road without gravity stays at rest: nothing has lifted it.
#[test]
fn a_body_placed_on_a_road_has_no_energy() {
    for (precision, most) in [
        // Rounding of positions of 0.1 m, over a step of some 10 us, as a speed of 0.1 kg: with 16 digits, and with 7.
        (Precision::F64, 1e-20),
        (Precision::F32, 1e-8),
    ] {
        let mut scene = lifted(-5e-3);
        scene.road = Some(Plane { normal: [-0.6, 0.0, 0.8], ..PLANE }.into());
        scene.body.on_road = true;
        let model = Model::new(&scene).unwrap();
        let outcome = simulate_with(&scene, model, precision, 1).unwrap();
        for row in &outcome.samples {
            assert!(row.kinetic_J < most && row.contact_work_J.abs() < most, "{precision:?}: {row:?}");
        }
    }
}

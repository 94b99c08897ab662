//! The nearest point: it is one, and a node lands on it.

use std::sync::Arc;

use hexroll::physics::road::{Base, Border, HeightField, Plane, Profile, Road, Samples, Shape, Smooth, Wave};
use hexroll::physics::tensor::{axpy, cross, dot, sub};
use hexroll_lab::rig::{Random, largest};

use crate::near;

const LEVEL: Base = Base { point: [0.0; 3], normal: [0.0, 0.0, 1.0], along: [1.0, 0.0, 0.0] };

/// A base that is level nowhere.
fn tilted() -> Base {
    Base::turned([0.02, -0.01, 0.03], [0.6, 0.0, 0.8], 0.4)
}

fn wave(base: Base) -> Road {
    Wave { base, amplitude: 4e-4, wavelength: 0.02 }.into()
}

/// Smooth heights of a millimetre on a grid of 1 mm by 1.5 mm.
fn field(base: Base, border: Border) -> Road {
    let size = [40, 24];
    let height = |i: usize, j: usize| {
        let (u, v) = (i as f64 / 40.0, j as f64 / 24.0);
        let tau = std::f64::consts::TAU;
        5e-4 * (tau * (2.0 * u + v)).cos() + 3e-4 * (tau * (u - 2.0 * v)).sin()
    };
    let heights = (0..size[1]).flat_map(|j| (0..size[0]).map(move |i| height(i, j))).collect();
    HeightField { base, samples: Arc::new(Samples::new(size, [1e-3, 1.5e-3], heights, border)) }.into()
}

fn smooth() -> [Road; 4] {
    [wave(LEVEL), wave(tilted()), field(LEVEL, Border::Periodic), field(tilted(), Border::Keep)]
}

fn profile(vertices: &[[f64; 2]], radius: f64, period: Option<f64>) -> Road {
    Profile { base: LEVEL, shape: Arc::new(Shape::new(vertices, radius, period).unwrap()) }.into()
}

/// A node a step's way inside a smooth road lands within round-off of it by one projection, from any point of it.
#[test]
fn a_node_lands_exactly() {
    let mut random = Random::new(81);
    for road in smooth() {
        for depth in [1e-4, 1e-5, 1e-6, 1e-9, -1e-6] {
            for _ in 0..200 {
                let [u, v] = [0.03 * random.signed(), 0.03 * random.signed()];
                let x = axpy(road.normal(road.point([u, v])), -depth, road.point([u, v]));
                let gap: f64 = road.gap(x);
                let landed = axpy(road.normal(x), -gap, x);
                let left: f64 = road.gap(landed);
                assert!(left.abs() < 1e-15, "{road:?}: {left} after {gap}");
                // Where it was taken from: no nearer point, none farther; the place by the square root of round-off.
                near("depth", gap, -depth, 1e-15);
                assert!(largest([&sub(landed, road.point([u, v]))]) < 1e-11);
            }
        }
    }
}

/// The normal is square to both tangents of the surface, by differences of its points.
#[test]
fn normals_and_tangents_are_those_of_the_surface() {
    let mut random = Random::new(82);
    for road in smooth() {
        for _ in 0..100 {
            let [u, v] = [0.03 * random.signed(), 0.03 * random.signed()];
            let (x, h) = (road.point([u, v]), 1e-6);
            let n = road.normal(x);
            for way in [[h, 0.0], [0.0, h]] {
                let chord = sub(road.point([u + way[0], v + way[1]]), road.point([u - way[0], v - way[1]]));
                // Third derivatives of some 1e5 /m2 times h^2.
                assert!(dot(chord, n).abs() < 1e-6 * h, "{road:?}: {}", dot(chord, n) / h);
            }
            let [along, across] = road.tangents(x);
            assert!(largest([&sub(cross(along, across), n)]) < 1e-14, "a right-handed set");
            assert!(largest([&sub(road.point(road.chart(x)), x)]) < 1e-14);
        }
    }
}

/// Between samples the surface has neither steps nor kinks, and goes through every sample.
#[test]
fn a_height_field_goes_through_its_samples_without_kinks() {
    let mut random = Random::new(83);
    let heights: Vec<f64> = (0..30).map(|_| 1e-3 * random.signed()).collect();
    for border in [Border::Periodic, Border::Keep] {
        let samples = Samples::new([6, 5], [1e-3, 2e-3], heights.clone(), border);
        for j in -2..7i64 {
            for i in -2..8i64 {
                let (u, v, e) = (1e-3 * i as f64, 2e-3 * j as f64, 1e-12);
                let at = |u: f64, v: f64| samples.height(u, v);
                let within = (0..6).contains(&i) && (0..5).contains(&j);
                if within {
                    near("sample", at(u, v)[0], heights[(6 * j + i) as usize], 1e-15);
                }
                for [left, right] in [[at(u - e, v), at(u + e, v)], [at(u, v - e), at(u, v + e)]] {
                    assert!((left[0] - right[0]).abs() < 2e-11, "a step at {i} {j}");
                    assert!((left[1] - right[1]).hypot(left[2] - right[2]) < 2e-8, "a kink at {i} {j}");
                }
                // Slopes by differences.
                let (a, b, d) = (u + 3e-4, v + 7e-4, 1e-7);
                let slope = (at(a + d, b)[0] - at(a - d, b)[0]) / (2.0 * d);
                near("slope along", slope, at(a, b)[1], 1e-6);
                let slope = (at(a, b + d)[0] - at(a, b - d)[0]) / (2.0 * d);
                near("slope across", slope, at(a, b)[2], 1e-6);
                assert!(at(a, b)[0] < samples.top());
            }
        }
    }
    let samples = Samples::new([6, 5], [1e-3, 2e-3], heights, Border::Nothing);
    assert!(samples.height(5.001e-3, 0.0)[0].is_nan() && samples.height(5e-3, 8e-3)[0].is_finite());
}

/// A level field is the plane, to the last digit.
#[test]
fn a_flat_field_is_the_plane() {
    let samples = Samples::new([5, 4], [1e-3; 2], vec![0.7e-3; 20], Border::Periodic);
    let road = Road::HeightField(HeightField { base: LEVEL, samples: Arc::new(samples) });
    let plane = Road::Plane(Plane { point: [0.0, 0.0, 0.7e-3], normal: [0.0, 0.0, 1.0], velocity: [0.0; 3] });
    let mut random = Random::new(84);
    for _ in 0..200 {
        let x = axpy(random.vector(), 1e-2, [0.0; 3]);
        assert_eq!(road.gap::<f64>(x), plane.gap::<f64>(x));
        assert_eq!(road.normal::<f64>(x), plane.normal::<f64>(x));
        let x = x.map(|c| c as f32);
        near("f32", road.gap::<f32>(x).into(), plane.gap::<f32>(x).into(), 1e-9);
    }
}

/// A cleat with sharp corners: beside its walls, over its corners, and inside.
#[test]
fn a_cleat_has_walls_and_corners() {
    let road = profile(&[[-5e-3, 0.0], [-5e-3, 1e-2], [5e-3, 1e-2], [5e-3, 0.0]], 0.0, None);
    let seen = |u: f64, w: f64| (road.gap::<f64>([u, 0.3, w]), road.normal::<f64>([u, 0.3, w]));
    let is = |(gap, n): (f64, [f64; 3]), expected: f64, normal: [f64; 3]| {
        near("gap", gap, expected, 1e-16);
        assert!(largest([&sub(n, normal)]) < 1e-14, "{n:?} {normal:?}");
    };
    is(seen(-0.1, 0.004), 0.004, [0.0, 0.0, 1.0]);
    is(seen(-7e-3, 6e-3), 2e-3, [-1.0, 0.0, 0.0]);
    is(seen(6e-3, 6e-3), 1e-3, [1.0, 0.0, 0.0]);
    is(seen(-4e-3, 5e-3), -1e-3, [-1.0, 0.0, 0.0]);
    is(seen(1e-3, 9e-3), -1e-3, [0.0, 0.0, 1.0]);
    is(seen(0.1, -3e-3), -3e-3, [0.0, 0.0, 1.0]);
    // In the ground below the wall both push: towards the corner between them.
    let (gap, n) = seen(-5e-3 + 3e-4, -4e-4);
    is((gap, n), -5e-4, [-0.6, 0.0, 0.8]);
    let landed: f64 = road.gap(axpy(n, -gap, [-5e-3 + 3e-4, 0.3, -4e-4]));
    assert!(landed.abs() < 1e-16);
}

/// Round corners: the gap from the arc's centre; what lies above one sees it, what lies beside it the flat side.
#[test]
fn a_cleats_round_corners_are_arcs() {
    let (half, height, r) = (5e-3, 1e-2, 2e-3);
    for period in [None, Some(0.05)] {
        let corners = [[-half, 0.0], [-half, height], [half, height], [half, 0.0]];
        let road = profile(&corners, r, period);
        let shifts = if period.is_some() { vec![0.0, 0.05, -0.15, 1.0] } else { vec![0.0] };
        for (angle, shift) in
            [0.01f64, 0.4, 0.8, 1.2, 1.56].into_iter().flat_map(|a| shifts.iter().map(move |s| (a, *s)))
        {
            for distance in [-5e-4, 0.0, -1e-9] {
                let (sin, cos) = angle.sin_cos();
                let x = [half - r + (r + distance) * cos + shift, 0.1, height - r + (r + distance) * sin];
                // Places of a metre.
                near("gap", road.gap(x), distance, 4e-16);
                assert!(largest([&sub(road.normal(x), [cos, 0.0, sin])]) < 1e-12);
            }
        }
        near("height", road.point([half - 0.5 * r, 0.0])[2], height - r + r * 0.75f64.sqrt(), 1e-15);
    }
    // The largest that fits is said.
    near("radius", Shape::new(&[[0.0, 0.0], [0.0, 0.01]], 0.02, None).unwrap_err(), 0.01, 1e-17);
}

/// A fine polyline of a circle's arc sees what the circle does, whichever piece is nearest: by the chord's height.
#[test]
fn a_polyline_of_many_points_is_the_curve() {
    let (r, n) = (0.05, 4000);
    let curve = |u: f64| r - (r * r - u * u).sqrt();
    let vertices: Vec<[f64; 2]> =
        (0..=n).map(|k| -0.03 + 0.06 * k as f64 / n as f64).map(|u| [u, curve(u)]).collect();
    let road = profile(&vertices, 0.0, None);
    let sagitta = (0.06f64 / n as f64 / 0.8).powi(2) / (8.0 * r);
    let mut random = Random::new(85);
    for _ in 0..2000 {
        let [a, depth] = [0.5 * random.signed(), 1e-3 * random.signed()];
        // Inside the circle is above the ground.
        let x = [(r + depth) * a.sin(), 0.0, r - (r + depth) * a.cos()];
        near("gap", road.gap(x), -depth, sagitta + 1e-15);
    }
    // Just below a corner that hardly bends a node is inside, whichever side rounding puts its foot on.
    for [u, w] in vertices {
        near("below", road.gap([u, 0.0, w - 1e-9]), -1e-9 * (1.0 - u * u / (r * r)).sqrt(), 1e-12);
    }
}

/// Lanes look at a bound that is never more than the gap.
#[test]
fn the_bound_is_below_the_gap() {
    let mut random = Random::new(86);
    let cleat = profile(&[[-5e-3, 0.0], [-5e-3, 1e-3], [5e-3, 1e-3], [5e-3, 0.0]], 5e-4, Some(0.03));
    for road in smooth().into_iter().chain([cleat]) {
        for _ in 0..1000 {
            let x = axpy(random.vector(), 2e-2, [0.0; 3]);
            let (bound, gap): (f64, f64) = (road.bound(x), road.gap(x));
            assert!(bound <= gap + 1e-16, "{road:?}: {bound} {gap}");
        }
    }
}

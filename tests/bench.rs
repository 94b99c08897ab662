//! The bench measures what it says: operations counted, floors by hand, records read back, wrong runs noticed.

use hexroll::cpu::{self, Precision};
use hexroll::engine::State;
use hexroll::model::Model;
use hexroll::physics::element::hex8::gram;
use hexroll::physics::material::NeoHookean;
use hexroll::physics::scalar::{Real, Scalar};
use hexroll::physics::tensor::{Mat3, Metric, Sym3, cofactor, det, dot};
use hexroll::scene::{Element, Law};
use hexroll_lab::bench::counting::{Counted, Operations, count};
use hexroll_lab::bench::floor::{Bound, Limits, floor};
use hexroll_lab::bench::kind::Kind;
use hexroll_lab::bench::report::{Report, Row, Spread};
use hexroll_lab::bench::wheel::{Roll, Wheel, refinement};
use hexroll_lab::bench::work::{Pass, cpu_passes, element_operations, node_operations};
use hexroll_lab::bench::{chart, critical, markdown};
use hexroll_lab::rig::given::INNER_RADIUS;
use hexroll_lab::rig::{DENSITY, ELEMENTS, G, KAPPA, RUBBER, TWO_CONSTANTS, laws, reference, wheel};

/// Requirement: the counting scalar counts what is written, kind by kind; counts below are done by hand.
#[test]
fn operations_of_simple_routines_are_those_counted_by_hand() {
    let n = Counted::<f64>::from_f64;
    let ops = |add, mul, fused, div| Operations { add, mul, fused, div };
    let (a, b, c) = (n(2.0), n(3.0), n(5.0));
    assert_eq!(count(|| (a + b) * c - a / b).1, ops(2, 1, 0, 1));
    assert_eq!(count(|| a.mul_add(b, -c)).1, ops(0, 0, 1, 0), "a sign is free");
    assert_eq!(count(|| a.min(b)).1, ops(0, 0, 0, 0), "a minimum is not arithmetic");
    let m: Mat3<Counted<f64>> = [[a, b, c], [c, a, b], [b, b, a]];
    assert_eq!(count(|| dot(m[0], m[1])).1, ops(0, 1, 2, 0));
    // Three cross products of three products and three fused ones.
    assert_eq!(count(|| cofactor(&m)).1, ops(0, 9, 9, 0));
    assert_eq!(count(|| det(&m)).1, ops(0, 4, 5, 0));
    let s = Sym3 { xx: a, yy: b, zz: c, xy: a, xz: b, yz: c };
    // Six dot products; M : G twice over off the diagonal; c M.
    assert_eq!(count(|| gram(&m)).1, ops(0, 6, 12, 0));
    assert_eq!(count(|| s.contracted(&s)).1, ops(1, 1, 5, 0));
    assert_eq!(count(|| s.scaled(a)).1, ops(0, 6, 0, 0));
    // Columns of G M, then the products of rows that six entries need.
    assert_eq!(count(|| s.around(&s)).1, ops(0, 9 + 6, 18 + 12, 0));
    // A guess (one of each), and two steps of three products and four fused ones.
    assert_eq!(count(|| a.recip_cbrt()).1, ops(1, 7, 8, 0));
    let single = count(|| Counted::<f32>::from_f64(2.0).recip_cbrt());
    // Its second step leaves two terms of the series out.
    assert_eq!(single.1, ops(1, 7, 6, 0));
    // Eight corners of three components; g - f/m and v' = keep v + push a; x' = x + dt v.
    assert_eq!(node_operations::<f64>(8), ops(24, 3, 9, 0));
    let o = ops(2, 3, 5, 7);
    assert_eq!((o.flops(), o.places()), (2 + 3 + 2 * 5 + 7, 2 + 3 + 5 + 7));
}

/// The counting scalar computes: its operations are those of a right answer.
#[test]
fn counting_does_not_change_the_numbers() {
    for x in [1e-3, 0.2, 1.0, 7.0, 4e5] {
        let root = Counted::<f64>::from_f64(x).recip_cbrt().0;
        // Two steps of fourth order: the last digits, as in the lanes.
        assert!((root * x.cbrt() - 1.0).abs() < 8e-16, "{x}: {root}");
        let root = Counted::<f32>::from_f64(x).recip_cbrt().0.to_f64();
        assert!((root * f64::from(x as f32).cbrt() - 1.0).abs() < 5e-7, "{x}: {root}");
    }
}

/// A wheel of 32 elements.
fn small(element: Element, law: Law, viscosity: Option<f64>) -> Model {
    let mut scene = wheel([8, 2, 2], 0.5);
    (scene.body.element, scene.body.law, scene.body.viscosity) = (element, law, viscosity);
    Model::new(&scene).unwrap()
}

#[test]
fn every_composition_is_counted_and_costs_what_it_should() {
    for element in ELEMENTS {
        for law in laws() {
            let [elastic, viscous] = [None, Some(20.0)].map(|eta| {
                let model = small(element, law, eta);
                element_operations::<f64>(&model).flops()
            });
            assert!(elastic > 200, "{element:?} {law:?}: {elastic}");
            assert!(viscous > elastic, "{element:?} {law:?}: viscosity is not free");
        }
    }
    let of = |element, law| element_operations::<f64>(&small(element, law, None)).flops();
    let [q1p0, full, uniform] = ELEMENTS.map(|e| of(e, RUBBER));
    // One point against eight; the mean pressure needs the volume before the points.
    assert!(2 * uniform < q1p0 && 2 * uniform < full, "{q1p0} {full} {uniform}");
    // I2 needs M A^T A M.
    assert!(of(Element::Q1p0, TWO_CONSTANTS) > q1p0 + 8 * 40);
    // The same routine in either precision, but for two fused operations of each point's root.
    assert_eq!(q1p0, element_operations::<f32>(&small(Element::Q1p0, RUBBER, None)).flops() + 8 * 2 * 2);
}

#[test]
fn passes_add_up_to_the_arrays_and_operations_of_the_mesh() {
    let model = small(Element::Q1p0, RUBBER, None);
    let (elements, nodes) = (model.element_count() as f64, model.node_count() as f64);
    let passes = cpu_passes::<f64>(&model);
    let bytes: f64 = passes.iter().map(|p| p.bytes).sum();
    // Positions and velocities once in and once out, two masses in; forces stay in the cache.
    assert_eq!(bytes, 8.0 * 14.0 * nodes);
    let half: f64 = cpu_passes::<f32>(&model).iter().map(|p| p.bytes).sum();
    assert_eq!(half, 0.5 * bytes);
    let viscous = small(Element::Q1p0, RUBBER, Some(20.0));
    let more: f64 = cpu_passes::<f64>(&viscous).iter().map(|p| p.bytes).sum();
    assert_eq!(more, bytes, "velocities are in the cache when the forces need them");
    let flops: f64 = passes.iter().map(|p| p.flops).sum();
    let element = element_operations::<f64>(&model).flops() as f64;
    assert_eq!(flops, elements * (element + 24.0) + nodes * (3.0 + 18.0));
}

#[test]
fn the_floor_is_the_sum_over_passes_of_what_each_needs_most() {
    let pass = |bytes, flops| Pass { name: "p".into(), bytes, flops };
    let limits = Limits { bandwidth: 1e9, flops: 1e10, latency: 1e-6 };
    // 4 us of bytes against 3 us of arithmetic; 1 us against 8 us; less than the latency.
    let passes = [pass(4e3, 3e4), pass(1e3, 8e4), pass(1.0, 1.0)];
    let found = floor(&passes, &limits);
    assert!((found.seconds - 13e-6).abs() < 1e-18, "{found:?}");
    assert_eq!(found.bound_by, Bound::Compute);
    assert_eq!(floor(&passes[..1], &limits).bound_by, Bound::Bandwidth);
    let slow = Limits { latency: 1e-3, ..limits };
    assert_eq!(floor(&passes, &slow).bound_by, Bound::Latency);
}

#[test]
fn a_spread_is_least_median_and_most() {
    assert_eq!(Spread::of(vec![3.0, 1.0, 2.0]), Spread { min: 1.0, median: 2.0, max: 3.0 });
    assert_eq!(Spread::of(vec![4.0, 1.0]), Spread { min: 1.0, median: 2.5, max: 4.0 });
}

fn row(engine: Kind, elements: usize, error: Option<f64>) -> Row {
    Row {
        engine,
        lanes: "avx2".into(),
        threads: 1,
        copies: 1,
        element: "q1p0".into(),
        elements,
        nodes: 1320,
        mesh: "structured".into(),
        contact: true,
        viscosity: 20.0,
        dt: 1e-5,
        steps: 700,
        batch: 70,
        us_per_step: Spread { min: 40.0, median: 44.0, max: 50.0 },
        updates_per_s: 2e7,
        floor_us: 11.0,
        fraction: 0.25,
        bound_by: Bound::Compute,
        bytes_per_update: 500.0,
        flops_per_update: 1500.0,
        mix: 0.7,
        passes: vec![Pass { name: "element".into(), bytes: 1.0, flops: 2.0 }],
        pass_us: vec![30.0],
        steps_per_submit: Some(64),
        memory_per_element: None,
        error,
        error_limit: 1e-3,
        reason: Some("compute: why".into()),
    }
}

#[test]
fn a_report_comes_back_from_json_as_it_was() {
    let mut report = Report { rows: vec![row(Kind::CpuF64, 880, Some(1e-12))], ..Report::default() };
    report.rows.push(row(Kind::GpuF32Plus, 7040, None));
    let text = serde_json::to_string(&report).unwrap();
    assert_eq!(serde_json::from_str::<Report>(&text).unwrap(), report);
    // The keys that other programs read.
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    for key in [
        "engine",
        "element",
        "elements",
        "contact",
        "threads",
        "us_per_step",
        "updates_per_s",
        "floor_us",
        "fraction",
        "bound_by",
        "bytes_per_update",
        "flops_per_update",
        "error",
    ] {
        assert!(value["rows"][0].get(key).is_some(), "{key}");
    }
    assert_eq!(value["rows"][0]["bound_by"], "compute");
    assert_eq!(value["rows"][0]["us_per_step"]["median"], 44.0);
    assert!(value["machine"].is_object() && value["limits"].is_object());
}

#[test]
fn a_fast_wrong_run_is_a_failed_run() {
    let rows = vec![
        row(Kind::CpuF64, 880, Some(9e-4)),
        row(Kind::CpuF32, 880, Some(1.1e-3)),
        row(Kind::GpuF32, 880, None),
    ];
    let report = Report { rows, ..Report::default() };
    let failures = report.failures();
    assert_eq!(failures.len(), 2, "{failures:?}");
    assert!(failures[0].starts_with("cpu-f32 ") && failures[1].starts_with("gpu-f32 "), "{failures:?}");
    let page = markdown::page(&report);
    assert!(page.contains("1.1e-3, failed") && page.contains("not finite, failed"), "{page}");
    assert!(page.contains("compute: why"), "a slow row says why");
}

#[test]
fn rows_that_differ_in_size_only_make_one_line_of_the_picture() {
    let rows = [row(Kind::CpuF64, 7040, None), row(Kind::CpuF64, 880, None), row(Kind::CpuF32, 880, None)];
    let lines = chart::lines(&rows);
    assert_eq!(lines.len(), 2);
    assert_eq!(lines[0].points, [[880.0, 44.0], [7040.0, 44.0]]);
    let picture = chart::scaling(&rows).unwrap().unwrap();
    // Blue of the first engine and vermilion of the second are both on it.
    for colour in [[0, 114, 178], [213, 94, 0]] {
        assert!(picture.pixels().any(|p| p.0[..3] == colour), "{colour:?}");
    }
    assert_eq!(chart::scaling(&[]).unwrap(), None);
}

#[test]
fn sizes_are_refinements_of_the_papers_mesh() {
    let expected = [(880, 1), (7_040, 2), (56_320, 4), (450_560, 8), (3_604_480, 16)];
    for (elements, n) in expected {
        assert_eq!(refinement(elements), Some(n));
    }
    for other in [0, 1, 879, 1_760] {
        assert_eq!(refinement(other), None);
    }
}

/// Requirement: an error of the forces shows in the error column. Mutant: a shear modulus 1 % too large, which the
/// displacements of a rolling wheel, mostly rigid motion, would hide if they were not taken relative to the
/// deformation.
#[test]
fn the_error_column_sees_a_per_cent_of_stiffness() {
    let wheel = Wheel { elements: 880, element: "uniform-gradient", contact: true, viscosity: None };
    let scene = wheel.scene().unwrap();
    let model = Model::new(&scene).unwrap();
    let roll = Roll::new(&model).unwrap();
    let run = |model: &Model, precision| -> State {
        let mut engine = cpu::engine(model, &scene, precision, 1).unwrap();
        roll.start(&mut *engine, model).unwrap();
        engine.advance(&roll.steps(0, 400)).unwrap();
        engine.state().unwrap()
    };
    let exact = run(&model, Precision::F64);
    let (single, deformation) = roll.error(&model, 400, &run(&model, Precision::F32), &exact);
    let mut stiff = scene.clone();
    let Law::NeoHookean(NeoHookean { g0, g1 }) = stiff.body.law else { panic!("{:?}", stiff.body.law) };
    stiff.body.law = Law::NeoHookean(NeoHookean { g0, g1: 1.01 * g1 });
    let (mutant, _) = roll.error(&model, 400, &run(&Model::new(&stiff).unwrap(), Precision::F64), &exact);
    // What a per cent of stiffness does stands well above what single precision does.
    let limit = Kind::CpuF32.error_limit(400, deformation);
    assert!(mutant > limit && single < 0.1 * mutant, "mutant {mutant:e}, single precision {single:e}");
}

/// Requirement: the report of time steps agrees with an independent program in the critical step of the assembled
/// wheel; the shortest edge over the wave speed allows less.
#[test]
fn critical_steps_of_the_wheel() {
    let wheel = Wheel { elements: 880, element: "q1p0", contact: true, viscosity: None };
    let [rest, pressed] = critical::steps(&wheel).unwrap();
    let c = ((KAPPA + 4.0 / 3.0 * G) / DENSITY).sqrt();
    let chord = 2.0 * INNER_RADIUS * (std::f64::consts::PI / 44.0).sin();
    assert!((rest.edge_over_speed / (chord / c) - 1.0).abs() < 1e-9, "{rest:?}");
    assert!(rest.element_bound < rest.assembled, "{rest:?}");
    reference("at-rest.dt").assert(rest.assembled);
    // The mode that limits the step sits at the rim, where elements are short along the ring: pressing the tread hardly
    // moves it. The eigenvalue is known to 1e-3, the step to half of that.
    assert!((pressed.assembled / rest.assembled - 1.0).abs() < 0.05, "{rest:?} {pressed:?}");
    assert!(pressed.edge_over_speed <= rest.edge_over_speed, "the shortest edges are the rim's");
}

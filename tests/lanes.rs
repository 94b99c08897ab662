//! The lanes compute what plain numbers do.
//!
//! One source of physics is compiled for several widths and instruction sets (src/physics/lanes). Requirement: every
//! level this machine has gives the forces and the motion of the portable one up to rounding, with the elements in any
//! order, and its reciprocal cube root is exact to the last digits.

use hexroll::cpu::{Precision, engine_at};
use hexroll::model::Model;
use hexroll::model::mesh::Mesh;
use hexroll::physics::lanes::{Array, InLanes, Instructions, Lanes, Level};
use hexroll::physics::scalar::{Real, Scalar};
use hexroll::scene::Scene;
use hexroll_lab::rig::{ELEMENTS, block, laws, relative};

/// Runs a check on the lanes of every level in both precisions, and on arrays.
macro_rules! on_all_lanes {
    ($check:ident) => {
        for level in Level::available() {
            level.call::<f64, _>($check);
            level.call::<f32, _>($check);
        }
        InLanes::<f64>::run::<Array<f64, 2>>($check);
        InLanes::<f32>::run::<Array<f32, 4>>($check);
    };
}

/// Positions stretched and sheared smoothly by about a tenth, velocities alike.
fn deformed(mesh: &Mesh) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
    let size = mesh.axle.iter().fold(0.0f64, |m, a| m.max(a.abs()));
    let wave = |x: &[f64; 3], k: f64| [0, 1, 2].map(|d| (k + 3.0 * x[(d + 1) % 3] / size).sin());
    let x = mesh.nodes.iter().map(|x| [0, 1, 2].map(|d| x[d] + 0.05 * size * wave(x, 0.3)[d])).collect();
    let v = mesh.nodes.iter().map(|x| wave(x, 1.1)).collect();
    (x, v)
}

fn cases() -> Vec<Scene> {
    let mut cases = Vec::new();
    for element in ELEMENTS {
        for law in laws() {
            for viscosity in [None, Some(20.0)] {
                // 7 elements a row: no lane count divides it, so full, crossing and partial batches all occur.
                let mut case = block([0.07, 0.03, 0.02], [7, 3, 2]);
                (case.body.element, case.body.law, case.body.viscosity) = (element, law, viscosity);
                cases.push(case);
            }
        }
    }
    cases
}

#[test]
fn every_level_computes_the_portable_forces() {
    for case in cases() {
        let model = Model::new(&case).unwrap();
        let (x, v) = deformed(&model.mesh);
        for (precision, tolerance) in [(Precision::F64, 1e-13), (Precision::F32, 3e-5)] {
            // Rounding of the stress relative to its deviator: 1e-16 (6e-8) times kappa/G and a few digits of sums.
            let of = |level| engine_at(&model, &case, precision, 1, level).unwrap().force(&x, &v).unwrap();
            let portable = of(Level::PORTABLE);
            for level in Level::available() {
                let error = relative(&portable, &of(level));
                assert!(error < tolerance, "{level:?} {precision:?} {:?}: {error:e}", case.body.element);
            }
        }
    }
}

#[test]
fn the_order_of_elements_and_nodes_does_not_matter() {
    let case = block([0.07, 0.03, 0.02], [7, 3, 2]);
    let model = Model::new(&case).unwrap();
    let mut mesh = model.mesh.clone();
    // A fixed shuffle: node n becomes number[n], elements are taken with a stride prime to their count.
    let count = mesh.nodes.len();
    let number: Vec<usize> = (0..count).map(|n| (n * 37 + 5) % count).collect();
    for (n, &to) in number.iter().enumerate() {
        mesh.nodes[to] = model.mesh.nodes[n];
    }
    let elements = mesh.hexes.len();
    let renumber = |hex: [u32; 8]| hex.map(|n| number[n as usize] as u32);
    mesh.hexes = (0..elements).map(|e| renumber(model.mesh.hexes[(e * 11 + 3) % elements])).collect();
    mesh.facets = mesh.facets.iter().map(|f| f.map(|n| number[n as usize] as u32)).collect();
    mesh.surface = mesh.surface.iter().map(|n| number[*n as usize] as u32).collect();
    mesh.surface.sort_unstable();
    let shuffled = Model::from_mesh(mesh, &case.body).unwrap();
    let (x, v) = deformed(&model.mesh);
    let mut mixed = (x.clone(), v.clone());
    for (n, &to) in number.iter().enumerate() {
        (mixed.0[to], mixed.1[to]) = (x[n], v[n]);
    }
    for level in Level::available() {
        let straight = engine_at(&model, &case, Precision::F64, 1, level).unwrap().force(&x, &v).unwrap();
        let shuffled =
            engine_at(&shuffled, &case, Precision::F64, 1, level).unwrap().force(&mixed.0, &mixed.1).unwrap();
        let back: Vec<[f64; 3]> = number.iter().map(|&to| shuffled[to]).collect();
        // Sums in another order.
        assert!(relative(&straight, &back) < 1e-13, "{level:?}");
    }
}

#[test]
fn the_reciprocal_cube_root_is_exact_to_the_last_digits() {
    // Two steps from 4 %: below the rounding of the last one, about two units in the last place.
    on_all_lanes!(RecipCbrt);
}

#[derive(Clone, Copy)]
struct RecipCbrt;

impl<T: Real> InLanes<T> for RecipCbrt {
    type Output = ();
    #[inline(always)]
    fn run<N: Lanes<Real = T>>(self) {
        let digits = if T::SINGLE { 5e-7 } else { 8e-16 };
        for i in 0..4000 {
            let x = 10.0f64.powf(-3.0 + 6.0 * f64::from(i) / 4000.0);
            let x = T::from_f64(x).to_f64();
            let root = N::splat(T::from_f64(x)).recip_cbrt().lane(N::WIDTH - 1).to_f64();
            assert!((root * x.cbrt() - 1.0).abs() < digits, "{x}: {root}");
        }
    }
}

/// Everything that moves or compares lanes, against what it says of each lane.
#[test]
fn lanes_move_and_compare_as_they_say() {
    on_all_lanes!(MoveAndCompare);
}

#[derive(Clone, Copy)]
struct MoveAndCompare;

impl<T: Real> InLanes<T> for MoveAndCompare {
    type Output = ();
    #[inline(always)]
    fn run<N: Lanes<Real = T>>(self) {
        let real = |v: f64| <N::Real as Scalar>::from_f64(v);
        let all = |f: &dyn Fn(usize) -> f64| (0..N::WIDTH).map(|i| real(f(i))).collect::<Vec<N::Real>>();
        let of = |v: &[N::Real]| unsafe { N::load(v.as_ptr(), 0) };
        let list = |n: N| (0..N::WIDTH).map(|i| n.lane(i).to_f64()).collect::<Vec<f64>>();
        let (a, b) = (all(&|i| i as f64 + 1.0), all(&|i| 0.5 - i as f64));
        let (x, y) = (of(&a), of(&b));
        let width = N::WIDTH;
        let mut moved = vec![b[width - 1].to_f64()];
        moved.extend(a[..width - 1].iter().map(|v| v.to_f64()));
        assert_eq!(list(x.moved_up(y)), moved);
        for mask in [0u32, 1, 2, (1 << width) - 2, (1 << width) - 1] {
            let chosen = |i: usize| if mask >> i & 1 == 1 { a[i].to_f64() } else { b[i].to_f64() };
            let expected: Vec<f64> = (0..width).map(chosen).collect();
            assert_eq!(list(x.choose(y, mask)), expected, "{mask:b}");
            assert_eq!(list(unsafe { y.load_over(a.as_ptr(), mask) }), expected, "{mask:b}");
            let mut to = b.clone();
            unsafe { x.store_where(to.as_mut_ptr(), mask) };
            assert_eq!(to.iter().map(|v| v.to_f64()).collect::<Vec<f64>>(), expected, "{mask:b}");
        }
        let mut sums = vec![1.0f64; width];
        unsafe { x.add_to(sums.as_mut_ptr()) };
        assert_eq!(sums, list(x).iter().map(|v| v + 1.0).collect::<Vec<f64>>());
        assert_eq!(y.negative(), (0..width).filter(|i| *i > 0).map(|i| 1 << i).sum::<u32>());
        assert!(!x.any_not_positive() && y.any_not_positive());
        for bad in [0.0, -1.0, f64::NAN] {
            let last = all(&|i| if i + 1 == width { bad } else { 1.0 });
            assert!(of(&last).any_not_positive(), "{bad}");
        }
        // A NaN of either stays, so that no failure is lost.
        let nan = of(&all(&|_| f64::NAN));
        assert!(list(nan.min(x)).iter().all(|v| v.is_nan()));
        assert_eq!(list(x.min(y)), list(y));
        let triple =
            [(x.mul_add(y, x), 1.0, 1.0), (x.mul_sub(y, x), 1.0, -1.0), (x.neg_mul_add(y, x), -1.0, 1.0)];
        for (got, product, sum) in triple {
            let one = |i: usize| product * a[i].to_f64() * b[i].to_f64() + sum * a[i].to_f64();
            assert_eq!(list(got), (0..width).map(one).collect::<Vec<f64>>());
        }
        assert_eq!(list(-x), list(x).iter().map(|v| -v).collect::<Vec<f64>>());
        assert_eq!(list((x - y) / x * x + y), list(x));
    }
}

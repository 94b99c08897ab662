//! The node pass, several nodes at a time: gather, acceleration, contact projection, integration, and the
//! book-keeping of every force.

use super::batches::{NodeBatch, NodeKind};
use super::state::View;
use crate::engine::{SurfaceSum, Works};
use crate::physics::contact::{self, Touch};
use crate::physics::friction::AnyFriction;
use crate::physics::lanes::{Array, Lanes, Level};
use crate::physics::node::{self, Loads, Prediction, StepSize};
use crate::physics::road::Plane;
use crate::physics::scalar::{Real, Scalar};
use crate::physics::tensor::{Vec3, add, axpy, combined, cross, dot, scale, sub};
use std::ops::Range;

/// Batches whose sums are kept together, so that totals do not depend on the number of threads.
pub const CHUNK: usize = 16;
/// Surface index of a node that cannot touch.
pub const NO_SURFACE: u32 = u32::MAX;

/// Constant data of the node pass; arrays by node are padded for lanes.
pub struct Nodes<T> {
    pub batches: Vec<NodeBatch>,
    pub mass: Vec<T>,
    pub inverse_mass: Vec<T>,
    pub corner_start: Vec<u32>,
    pub corners: Vec<u32>,
    /// Index among the surface nodes.
    pub surface_of: Vec<u32>,
    /// Rim nodes' positions relative to the axle in the reference orientation, by component.
    pub rim_arms: [Vec<T>; 3],
    /// One over the area of each surface node [1/m2], as of the last sample; empty unless friction looks at pressure.
    pub inverse_area: Vec<T>,
    pub level: Level,
}

impl<T: Real> Nodes<T> {
    /// Internal force of a node: its corners' slots in fixed order.
    ///
    /// # Safety
    /// No thread writes slots.
    #[inline(always)]
    pub unsafe fn gather(&self, n: usize, view: &View<T>) -> Vec3<T> {
        let row = self.corner_start[n] as usize..self.corner_start[n + 1] as usize;
        let mut f = [T::zero(); 3];
        for &slot in &self.corners[row] {
            let (element, corner) = ((slot >> 3) as usize, (slot & 7) as usize);
            for d in 0..3 {
                f[d] += unsafe { *view.slots.add(view.slot(corner, d) + element) };
            }
        }
        f
    }
}

/// Everything that is the same for all nodes of a step.
#[derive(Debug, Clone, Copy)]
pub struct Conditions<T> {
    pub step: StepSize<T>,
    pub loads: Loads<T>,
    pub road: Option<Plane<T>>,
    pub friction: Option<AnyFriction<T>>,
    /// Axle at the end of the step in the engine's frame and its mean velocity, rotation at the end and its mean rate
    /// (columns), axle at the start.
    pub axle: Vec3<T>,
    pub axle_velocity: Vec3<T>,
    pub rotation: [Vec3<T>; 3],
    pub rotation_rate: [Vec3<T>; 3],
    pub axle_before: Vec3<T>,
    /// Work of a force: f . (before v(n-1/2) + after v(n+1/2)).
    pub weights: [T; 2],
    /// Number of the step, which touching nodes remember.
    pub number: u64,
}

/// Sums over a chunk of batches.
#[derive(Debug, Clone, Copy, Default)]
pub struct NodeSums {
    /// `internal` holds the work of the whole internal force, the viscous part included.
    pub works: Works,
    pub rim_impulse: [f64; 3],
    pub rim_moment_impulse: [f64; 3],
    pub mixed_kinetic: f64,
    pub net_force2: f64,
    pub internal_force2: f64,
}

/// The same in lanes, while a chunk is worked on.
#[derive(Clone, Copy)]
struct LaneSums<N> {
    internal: N,
    body_force: N,
    damping: N,
    rim: N,
    impulse: Vec3<N>,
    moment: Vec3<N>,
    mixed_kinetic: N,
    net_force2: N,
    internal_force2: N,
}

/// Window sums of the surface nodes and chunk sums, as raw as [`View`].
#[derive(Debug, Clone, Copy)]
pub struct Books {
    pub surface: *mut SurfaceSum,
    /// Last step in which a surface node touched (and whether it stuck), plus one; 0: never.
    pub last_touch: *mut u64,
    pub sums: *mut NodeSums,
}
// SAFETY: as for View.
unsafe impl Send for Books {}
unsafe impl Sync for Books {}

/// Constants of a step in every lane.
struct LaneConditions<N> {
    dt: N,
    prediction: Prediction<N>,
    loads: Loads<N>,
    weights: [N; 2],
    inverse_dtm: N,
}

#[inline(always)]
fn splat3<N: Lanes>(v: Vec3<N::Real>) -> Vec3<N> {
    [N::splat(v[0]), N::splat(v[1]), N::splat(v[2])]
}

/// Loads the valid lanes only (the next nodes may be another thread's); the others are zero.
#[inline(always)]
unsafe fn load3<N: Lanes>(field: &[*mut N::Real; 3], at: usize, count: usize) -> Vec3<N> {
    unsafe {
        if count == N::WIDTH {
            return [N::load(field[0], at), N::load(field[1], at), N::load(field[2], at)];
        }
        let mut some = [[<N::Real as Scalar>::zero(); 16]; 3];
        for d in 0..3 {
            for lane in 0..count {
                some[d][lane] = *field[d].add(at + lane);
            }
        }
        [N::load(some[0].as_ptr(), 0), N::load(some[1].as_ptr(), 0), N::load(some[2].as_ptr(), 0)]
    }
}

/// Stores the valid lanes only: the next nodes may be another thread's.
#[inline(always)]
unsafe fn store3<N: Lanes>(v: Vec3<N>, field: &[*mut N::Real; 3], at: usize, count: usize) {
    for d in 0..3 {
        unsafe {
            if count == N::WIDTH {
                v[d].store(field[d], at);
            } else {
                for lane in 0..count {
                    *field[d].add(at + lane) = v[d].lane(lane);
                }
            }
        }
    }
}

#[inline(always)]
unsafe fn gather_batch<N: Lanes>(nodes: &Nodes<N::Real>, batch: &NodeBatch, view: &View<N::Real>) -> Vec3<N> {
    if let Some(runs) = &batch.runs {
        let mut f = [N::zero(); 3];
        for &(corner, element) in runs {
            for d in 0..3 {
                f[d] += unsafe { N::load(view.slots, view.slot(corner, d) + element) };
            }
        }
        return f;
    }
    // Lane by lane through memory; 16 is the widest.
    let mut lanes = [[<N::Real as Scalar>::zero(); 16]; 3];
    for lane in 0..batch.count {
        let f = unsafe { nodes.gather(batch.first + lane, view) };
        for d in 0..3 {
            lanes[d][lane] = f[d];
        }
    }
    unsafe { [N::load(lanes[0].as_ptr(), 0), N::load(lanes[1].as_ptr(), 0), N::load(lanes[2].as_ptr(), 0)] }
}

/// A force without its held components, which whatever holds them takes.
#[inline(always)]
fn moving<N: Lanes>(held: u8, f: Vec3<N>) -> Vec3<N> {
    if held == 0 {
        return f;
    }
    let mut f = f;
    for d in 0..3 {
        if held >> d & 1 == 1 {
            f[d] = N::zero();
        }
    }
    f
}

/// New velocity and position of the lanes.
#[derive(Clone, Copy)]
struct Moved<N> {
    x: Vec3<N>,
    v: Vec3<N>,
}

#[inline(always)]
unsafe fn pass_in<N: Lanes, const PROBE: bool>(
    nodes: &Nodes<N::Real>,
    c: &Conditions<N::Real>,
    chunks: Range<usize>,
    view: &View<N::Real>,
    books: &Books,
) {
    let s = N::splat;
    let loads = Loads { gravity: splat3(c.loads.gravity), alpha: s(c.loads.alpha) };
    let lanes = LaneConditions {
        dt: s(c.step.dt),
        prediction: Prediction::new(&loads, StepSize { dt: s(c.step.dt), dtm: s(c.step.dtm) }),
        loads,
        weights: [s(c.weights[0]), s(c.weights[1])],
        inverse_dtm: s(<N::Real as Scalar>::one() / c.step.dtm),
    };
    for chunk in chunks {
        let zero = N::zero();
        let mut sums = LaneSums {
            internal: zero,
            body_force: zero,
            damping: zero,
            rim: zero,
            impulse: [zero; 3],
            moment: [zero; 3],
            mixed_kinetic: zero,
            net_force2: zero,
            internal_force2: zero,
        };
        let end = ((chunk + 1) * CHUNK).min(nodes.batches.len());
        for batch in &nodes.batches[chunk * CHUNK..end] {
            unsafe {
                let whole = gather_batch::<N>(nodes, batch, view);
                let f_int = moving::<N>(batch.held, whole);
                if PROBE && batch.held != 0 {
                    // What holds a node pushes back, as a road does: it belongs to the scale of forces.
                    let one = valid::<N>(batch.count);
                    sums.internal_force2 += one * (dot(whole, whole) - dot(f_int, f_int));
                }
                let x = load3::<N>(&view.x, batch.first, batch.count);
                let v = load3::<N>(&view.v, batch.first, batch.count);
                let mass = N::load(nodes.mass.as_ptr(), batch.first);
                let moved = match batch.kind {
                    NodeKind::Rim(k) => carried::<N>(nodes, c, k),
                    kind => {
                        let w = N::load(nodes.inverse_mass.as_ptr(), batch.first);
                        let v_star = lanes.prediction.velocity(w, f_int, v);
                        let free = Moved { x: axpy(v_star, lanes.dt, x), v: v_star };
                        match (kind, &c.road) {
                            (NodeKind::Surface, Some(road)) => {
                                touch::<N, PROBE>(nodes, c, road, batch, x, v, free, books, chunk)
                            }
                            _ => free,
                        }
                    }
                };
                book::<N, PROBE>(&mut sums, c, &lanes, batch, mass, f_int, x, v, &moved);
                if !PROBE {
                    store3(moved.x, &view.x, batch.first, batch.count);
                    store3(moved.v, &view.v, batch.first, batch.count);
                }
            }
        }
        fold(unsafe { &mut *books.sums.add(chunk) }, &sums, c.step.dtm.to_f64());
    }
}

/// Rim nodes go where the rim puts them.
#[inline(always)]
unsafe fn carried<N: Lanes>(nodes: &Nodes<N::Real>, c: &Conditions<N::Real>, first: usize) -> Moved<N> {
    let arms = &nodes.rim_arms;
    let arm = unsafe {
        [N::load(arms[0].as_ptr(), first), N::load(arms[1].as_ptr(), first), N::load(arms[2].as_ptr(), first)]
    };
    let r = [splat3::<N>(c.rotation[0]), splat3(c.rotation[1]), splat3(c.rotation[2])];
    let rate = [splat3::<N>(c.rotation_rate[0]), splat3(c.rotation_rate[1]), splat3(c.rotation_rate[2])];
    Moved {
        x: add(splat3(c.axle), combined(&r, arm[0], arm[1], arm[2])),
        v: add(splat3(c.axle_velocity), combined(&rate, arm[0], arm[1], arm[2])),
    }
}

/// Puts the nodes that would end inside the road back on it, one by one: few do.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // a batch in full
unsafe fn touch<N: Lanes, const PROBE: bool>(
    nodes: &Nodes<N::Real>,
    c: &Conditions<N::Real>,
    road: &Plane<N::Real>,
    batch: &NodeBatch,
    x: Vec3<N>,
    v: Vec3<N>,
    free: Moved<N>,
    books: &Books,
    chunk: usize,
) -> Moved<N> {
    if !road.gap_in_lanes(free.x).any_negative() {
        return free;
    }
    let mut moved = [[<N::Real as Scalar>::zero(); 16]; 6];
    for d in 0..3 {
        unsafe {
            free.x[d].store(moved[d].as_mut_ptr(), 0);
            free.v[d].store(moved[3 + d].as_mut_ptr(), 0);
        }
    }
    for lane in 0..batch.count {
        let n = batch.first + lane;
        let k = nodes.surface_of[n];
        if k == NO_SURFACE {
            continue;
        }
        let old = [x[0].lane(lane), x[1].lane(lane), x[2].lane(lane)];
        let before = [v[0].lane(lane), v[1].lane(lane), v[2].lane(lane)];
        let v_star = [moved[3][lane], moved[4][lane], moved[5][lane]];
        let inertia = node::inertia(&c.loads, c.step, nodes.mass[n]);
        let area = || nodes.inverse_area.get(k as usize).copied().unwrap_or(<N::Real as Scalar>::zero());
        let Some(t) =
            contact::project_any(road, c.friction.as_ref(), area, inertia, c.step, old, before, v_star)
        else {
            continue;
        };
        for d in 0..3 {
            moved[d][lane] = t.x[d];
            moved[3 + d][lane] = t.v[d];
        }
        unsafe { book_touch::<N::Real, PROBE>(c, k as usize, &t, before, books, chunk) };
    }
    let at = |r: usize| unsafe { N::load(moved[r].as_ptr(), 0) };
    Moved { x: [at(0), at(1), at(2)], v: [at(3), at(4), at(5)] }
}

/// Works of a touching node and, where the step is taken, its window sums.
#[inline(always)]
unsafe fn book_touch<T: Real, const PROBE: bool>(
    c: &Conditions<T>,
    k: usize,
    t: &Touch<T>,
    before: Vec3<T>,
    books: &Books,
    chunk: usize,
) {
    let way = axpy(t.v, c.weights[1], scale(before, c.weights[0]));
    let works = unsafe { &mut (*books.sums.add(chunk)).works };
    let friction_work = dot(t.tangential_force, way).to_f64();
    works.normal += dot(t.normal_force, way).to_f64();
    works.friction += friction_work;
    if PROBE {
        return;
    }
    let sum = unsafe { &mut *books.surface.add(k) };
    for d in 0..3 {
        sum.impulse[d] += (t.normal_force[d] + t.tangential_force[d]).to_f64() * c.step.dtm.to_f64();
    }
    sum.friction_work += friction_work;
    sum.touching += 1;
    sum.sticking += u32::from(t.sticks);
    sum.sticks = t.sticks;
    unsafe { *books.last_touch.add(k) = c.number + 1 };
}

/// Adds a batch's works and, for rim nodes, what the rim does to the rubber.
#[allow(clippy::too_many_arguments)] // a batch's whole step
#[inline(always)]
fn book<N: Lanes, const PROBE: bool>(
    sums: &mut LaneSums<N>,
    c: &Conditions<N::Real>,
    lanes: &LaneConditions<N>,
    batch: &NodeBatch,
    mass: N,
    f_int: Vec3<N>,
    x: Vec3<N>,
    v: Vec3<N>,
    moved: &Moved<N>,
) {
    // Lanes beyond the count hold other nodes: they count nothing.
    let one = valid::<N>(batch.count);
    let way = scale(axpy(moved.v, lanes.weights[1], scale(v, lanes.weights[0])), one);
    let gravity = lanes.loads.gravity;
    sums.internal -= dot(f_int, way);
    sums.body_force += mass * dot(gravity, way);
    if PROBE {
        sums.mixed_kinetic += one * (mass * dot(v, moved.v));
    }
    if let NodeKind::Rim(_) = batch.kind {
        let net = scale(sub(moved.v, v), mass * lanes.inverse_dtm);
        sums.rim += dot(sub(add(net, f_int), scale(gravity, mass)), way);
        let arm = sub(x, splat3(c.axle_before));
        let f = scale(f_int, one);
        sums.impulse = add(sums.impulse, f);
        sums.moment = add(sums.moment, cross(arm, f));
        return;
    }
    sums.damping += dot(node::damping_force(&lanes.loads, mass, v, moved.v), way);
    if PROBE {
        let net = scale(sub(moved.v, v), mass * lanes.inverse_dtm * one);
        sums.net_force2 += dot(net, net);
        sums.internal_force2 += one * dot(f_int, f_int);
    }
}

/// One in the lanes below `count`, zero beyond.
#[inline(always)]
fn valid<N: Lanes>(count: usize) -> N {
    if count == N::WIDTH {
        return N::one();
    }
    let mut ones = [<N::Real as Scalar>::zero(); 16];
    for one in ones.iter_mut().take(count) {
        *one = <N::Real as Scalar>::one();
    }
    unsafe { N::load(ones.as_ptr(), 0) }
}

fn across<N: Lanes>(value: N) -> f64 {
    (0..N::WIDTH).map(|lane| value.lane(lane).to_f64()).sum()
}

/// Adds a chunk's lanes to its sums in double precision.
#[inline(always)]
fn fold<N: Lanes>(chunk: &mut NodeSums, lanes: &LaneSums<N>, dtm: f64) {
    chunk.works.internal += across(lanes.internal);
    chunk.works.body_force += across(lanes.body_force);
    chunk.works.damping += across(lanes.damping);
    chunk.works.rim += across(lanes.rim);
    for d in 0..3 {
        chunk.rim_impulse[d] += dtm * across(lanes.impulse[d]);
        chunk.rim_moment_impulse[d] += dtm * across(lanes.moment[d]);
    }
    chunk.mixed_kinetic += 0.5 * across(lanes.mixed_kinetic);
    chunk.net_force2 += across(lanes.net_force2);
    chunk.internal_force2 += across(lanes.internal_force2);
}

/// The node pass of a precision, in the lanes of a level.
pub trait NodePass: Real {
    /// Steps the nodes of some chunks; `probe`: only books what the step would do.
    ///
    /// # Safety
    /// No other thread touches these chunks' nodes, surface entries or sums, nor writes slots.
    unsafe fn node_pass(
        nodes: &Nodes<Self>,
        c: &Conditions<Self>,
        chunks: Range<usize>,
        view: &View<Self>,
        books: &Books,
        probe: bool,
    );
}

macro_rules! node_pass {
    ($real:ty, $portable:ty, $avx2:ident, $avx512:ident) => {
        impl NodePass for $real {
            unsafe fn node_pass(
                nodes: &Nodes<Self>,
                c: &Conditions<Self>,
                chunks: Range<usize>,
                view: &View<Self>,
                books: &Books,
                probe: bool,
            ) {
                #[inline(always)]
                unsafe fn either<N: Lanes<Real = $real>>(
                    nodes: &Nodes<$real>,
                    c: &Conditions<$real>,
                    chunks: Range<usize>,
                    view: &View<$real>,
                    books: &Books,
                    probe: bool,
                ) {
                    unsafe {
                        if probe {
                            pass_in::<N, true>(nodes, c, chunks, view, books)
                        } else {
                            pass_in::<N, false>(nodes, c, chunks, view, books)
                        }
                    }
                }
                #[cfg(target_arch = "x86_64")]
                {
                    #[target_feature(enable = "avx2,fma")]
                    unsafe fn avx2(
                        nodes: &Nodes<$real>,
                        c: &Conditions<$real>,
                        chunks: Range<usize>,
                        view: &View<$real>,
                        books: &Books,
                        probe: bool,
                    ) {
                        use crate::physics::lanes::$avx2;
                        unsafe { either::<$avx2>(nodes, c, chunks, view, books, probe) }
                    }
                    #[target_feature(enable = "avx512f,fma")]
                    unsafe fn avx512(
                        nodes: &Nodes<$real>,
                        c: &Conditions<$real>,
                        chunks: Range<usize>,
                        view: &View<$real>,
                        books: &Books,
                        probe: bool,
                    ) {
                        use crate::physics::lanes::$avx512;
                        unsafe { either::<$avx512>(nodes, c, chunks, view, books, probe) }
                    }
                    match nodes.level {
                        Level::Avx512 => return unsafe { avx512(nodes, c, chunks, view, books, probe) },
                        Level::Avx2 => return unsafe { avx2(nodes, c, chunks, view, books, probe) },
                        Level::Portable => {}
                    }
                }
                unsafe { either::<$portable>(nodes, c, chunks, view, books, probe) }
            }
        }
    };
}
node_pass!(f64, Array<f64, 2>, F64x4, F64x8);
node_pass!(f32, Array<f32, 4>, F32x8, F32x16);

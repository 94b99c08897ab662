//! The node pass, several nodes at a time: gather, acceleration, contact projection, integration, and the
//! book-keeping of every force.

use super::layout::{Line, NodeBatch};
use super::state::{Aligned, Field, View};
use crate::engine::SurfaceSum;
use crate::physics::contact::{self, Touch};
use crate::physics::friction::Friction;
use crate::physics::lanes::{InLanes, Instructions, Lanes, Level, WIDEST};
use crate::physics::node::{self, Loads, Prediction, StepSize};
use crate::physics::road::Road;
use crate::physics::scalar::{Real, Scalar};
use crate::physics::tensor::{Vec3, add, axpy, combined, cross, dot, scale, sub};

/// Surface index of a node that cannot touch.
pub const NO_SURFACE: u32 = u32::MAX;

/// Constant data of the node pass.
pub struct Nodes<T> {
    pub lines: Vec<Line>,
    /// By place.
    pub mass: Aligned<T>,
    pub inverse_mass: Aligned<T>,
    /// Index among the surface nodes; this and the arms by [`NodeBatch::boundary`] and lane.
    pub surface_of: Vec<u32>,
    /// Rim nodes' positions relative to the axle in the reference orientation; zero for others.
    pub rim_arms: Field<T>,
    /// One over the area of each surface node [1/m2], as of the last sample; empty unless friction looks at pressure.
    pub inverse_area: Vec<T>,
    pub level: Level,
}

/// Everything that is the same for all nodes of a step.
#[derive(Debug, Clone, Copy)]
pub struct Conditions<T> {
    pub step: StepSize<T>,
    pub loads: Loads<T>,
    pub prediction: Prediction<T>,
    /// Seen from the engine's frame, and whether it moves.
    pub road: Option<Road>,
    pub road_moves: bool,
    pub friction: Option<Friction>,
    /// Axle at the end of the step in the engine's frame and its mean velocity, rotation at the end and its mean rate
    /// (columns), axle at the start.
    pub axle: Vec3<T>,
    pub axle_velocity: Vec3<T>,
    pub rotation: [Vec3<T>; 3],
    pub rotation_rate: [Vec3<T>; 3],
    pub axle_before: Vec3<T>,
    /// Work of a force: f . (before v(n-1/2) + after v(n+1/2)).
    pub weights: [T; 2],
    /// Whether there is a body force, and mass damping: neither is booked otherwise.
    pub has_gravity: bool,
    pub has_damping: bool,
    /// Number of the step, which touching nodes remember.
    pub number: u64,
}

/// Sums of a line over the steps of a window, in double precision; arrays have one sum a lane.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub struct LineSums {
    /// Work of the whole internal force, the viscous part included.
    pub internal: [f64; WIDEST],
    pub body_force: [f64; WIDEST],
    pub damping: [f64; WIDEST],
    pub rim: [f64; WIDEST],
    /// Internal force on rim nodes and its moment about the axle, times the mean step.
    pub rim_impulse: [[f64; WIDEST]; 3],
    pub rim_moment_impulse: [[f64; WIDEST]; 3],
    pub mixed_kinetic: [f64; WIDEST],
    pub net_force2: [f64; WIDEST],
    pub internal_force2: [f64; WIDEST],
    pub normal: f64,
    pub friction: f64,
}

impl Default for LineSums {
    fn default() -> Self {
        let none = [0.0; WIDEST];
        LineSums {
            internal: none,
            body_force: none,
            damping: none,
            rim: none,
            rim_impulse: [none; 3],
            rim_moment_impulse: [none; 3],
            mixed_kinetic: none,
            net_force2: none,
            internal_force2: none,
            normal: 0.0,
            friction: 0.0,
        }
    }
}

/// The same in lanes, while a line is worked on.
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

/// Contact of a line in one step.
#[derive(Debug, Clone, Copy, Default)]
pub struct LineContact {
    pub force: [f64; 3],
    pub touching: u32,
    /// Of those: nodes that were free the step before, and nodes that changed between stick and slip.
    pub entered: u32,
    pub switched: u32,
}

/// Window sums of the surface nodes and of lines, as raw as [`View`].
#[derive(Debug, Clone, Copy)]
pub struct Books {
    pub surface: *mut SurfaceSum,
    /// Last step in which a surface node touched, plus one; 0: never.
    pub last_touch: *mut u64,
    pub sums: *mut LineSums,
    /// By line that can touch.
    pub contact: *mut LineContact,
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

#[inline(always)]
unsafe fn load3<N: Lanes>(field: &[*mut N::Real; 3], at: usize) -> Vec3<N> {
    unsafe { [N::load(field[0], at), N::load(field[1], at), N::load(field[2], at)] }
}

#[inline(always)]
unsafe fn store3<N: Lanes>(v: Vec3<N>, field: &[*mut N::Real; 3], at: usize) {
    unsafe {
        v[0].store(field[0], at);
        v[1].store(field[1], at);
        v[2].store(field[2], at);
    }
}

#[inline(always)]
fn choose3<N: Lanes>(a: Vec3<N>, other: Vec3<N>, mask: u32) -> Vec3<N> {
    [a[0].choose(other[0], mask), a[1].choose(other[1], mask), a[2].choose(other[2], mask)]
}

/// Internal force of a batch: its slots, first to last. Slots that are added to lane by lane are cleared.
#[inline(always)]
unsafe fn internal_force<N: Lanes>(line: &Line, view: &View<N::Real>, offset: usize) -> Vec3<N> {
    let mut f = [N::zero(); 3];
    for (k, &slot) in line.slots.iter().enumerate() {
        unsafe {
            let part = load3::<N>(&view.f, slot + offset);
            f = if k == 0 { part } else { add(f, part) };
            if line.loose {
                store3([N::zero(); 3], &view.f, slot + offset);
            }
        }
    }
    f
}

/// A force without its held components, which whatever holds them takes; `held`: lanes by component.
#[inline(always)]
fn moving<N: Lanes>(held: [u32; 3], f: Vec3<N>) -> Vec3<N> {
    if held == [0; 3] {
        return f;
    }
    let zero = N::zero();
    [zero.choose(f[0], held[0]), zero.choose(f[1], held[1]), zero.choose(f[2], held[2])]
}

/// New velocity and position of the lanes.
#[derive(Clone, Copy)]
struct Moved<N> {
    x: Vec3<N>,
    v: Vec3<N>,
}

/// A line of nodes that nothing but the internal force and the road acts on: one step. What most lines are, and short
/// enough to stay in registers.
#[inline(always)]
unsafe fn plain_line<N: Lanes>(
    nodes: &Nodes<N::Real>,
    c: &Conditions<N::Real>,
    number: usize,
    view: &View<N::Real>,
    books: &Books,
) {
    let line = unsafe { nodes.lines.get_unchecked(number) };
    let lanes = LaneConditions::<N>::new(c);
    let road = c.road.as_ref().filter(|_| line.surface.is_some());
    let mut internal = N::zero();
    let mut contact = LineContact::default();
    for (b, batch) in line.batches.iter().enumerate() {
        let (offset, at) = (b * N::WIDTH, line.start + b * N::WIDTH);
        unsafe {
            let f_int = internal_force::<N>(line, view, offset);
            let x = load3::<N>(&view.x, at);
            let v = load3::<N>(&view.v, at);
            let w = N::load(nodes.inverse_mass.slice().as_ptr(), at);
            let v_star = lanes.prediction.velocity(w, f_int, v);
            let mut moved = Moved { x: axpy(v_star, lanes.dt, x), v: v_star };
            if let (true, Some(road)) = (batch.surface != 0, road) {
                let sums = &mut *books.sums.add(number);
                moved =
                    touch::<N, false>(nodes, c, road, (at, batch), x, v, moved, books, sums, &mut contact);
            }
            internal -= dot(f_int, axpy(moved.v, lanes.weights[1], scale(v, lanes.weights[0])));
            store3(moved.x, &view.x, at);
            store3(moved.v, &view.v, at);
        }
    }
    unsafe {
        end_of_line(line, view);
        if let Some(k) = line.surface {
            *books.contact.add(k) = contact;
        }
        internal.add_to((*books.sums.add(number)).internal.as_mut_ptr());
    }
}

/// Behind the last node of a closed line stands its first.
#[inline(always)]
unsafe fn end_of_line<T: Real>(line: &Line, view: &View<T>) {
    if !line.closed {
        return;
    }
    let end = line.start + line.nodes.len();
    for d in 0..3 {
        unsafe {
            *view.x[d].add(end) = *view.x[d].add(line.start);
            *view.v[d].add(end) = *view.v[d].add(line.start);
        }
    }
}

/// A line of nodes: one step, or (`PROBE`) only what it would do.
#[inline(always)]
unsafe fn line_in<N: Lanes, const PROBE: bool>(
    nodes: &Nodes<N::Real>,
    c: &Conditions<N::Real>,
    number: usize,
    view: &View<N::Real>,
    books: &Books,
) {
    let line = unsafe { nodes.lines.get_unchecked(number) };
    let lanes = LaneConditions::<N>::new(c);
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
    let mut contact = LineContact::default();
    for (b, batch) in line.batches.iter().enumerate() {
        let (offset, at) = (b * N::WIDTH, line.start + b * N::WIDTH);
        unsafe {
            let whole = internal_force::<N>(line, view, offset);
            let f_int = moving::<N>(batch.held, whole);
            if PROBE && batch.held != [0; 3] {
                // What holds a node pushes back, as a road does: it belongs to the scale of forces.
                let held = dot(whole, whole) - dot(f_int, f_int);
                sums.internal_force2 += N::zero().choose(held, batch.rim);
            }
            let x = load3::<N>(&view.x, at);
            let v = load3::<N>(&view.v, at);
            let mass = N::load(nodes.mass.slice().as_ptr(), at);
            let w = N::load(nodes.inverse_mass.slice().as_ptr(), at);
            let v_star = lanes.prediction.velocity(w, f_int, v);
            let mut moved = Moved { x: axpy(v_star, lanes.dt, x), v: v_star };
            if let (true, Some(road)) = (batch.surface != 0, &c.road) {
                let sums = &mut *books.sums.add(number);
                moved =
                    touch::<N, PROBE>(nodes, c, road, (at, batch), x, v, moved, books, sums, &mut contact);
            }
            if batch.rim != 0 {
                let carried = carried::<N>(nodes, c, batch.boundary as usize);
                moved.x = choose3(carried.x, moved.x, batch.rim);
                moved.v = choose3(carried.v, moved.v, batch.rim);
            }
            book::<N, PROBE>(&mut sums, c, &lanes, batch.rim, mass, f_int, x, v, &moved);
            if !PROBE {
                store3(moved.x, &view.x, at);
                store3(moved.v, &view.v, at);
            }
        }
    }
    unsafe {
        if !PROBE {
            end_of_line(line, view);
        }
        if let (Some(k), false) = (line.surface, PROBE) {
            *books.contact.add(k) = contact;
        }
        fold::<N, PROBE>(&mut *books.sums.add(number), &sums, c, line.has_rim);
    }
}

impl<N: Lanes> LaneConditions<N> {
    #[inline(always)]
    fn new(c: &Conditions<N::Real>) -> Self {
        let loads = Loads { gravity: splat3(c.loads.gravity), alpha: N::splat(c.loads.alpha) };
        LaneConditions {
            dt: N::splat(c.step.dt),
            prediction: c.prediction.in_lanes(),
            loads,
            weights: [N::splat(c.weights[0]), N::splat(c.weights[1])],
            inverse_dtm: N::splat(<N::Real as Scalar>::one() / c.step.dtm),
        }
    }
}

/// Rim nodes go where the rim puts them.
#[inline(always)]
unsafe fn carried<N: Lanes>(nodes: &Nodes<N::Real>, c: &Conditions<N::Real>, boundary: usize) -> Moved<N> {
    let arms = [0, 1, 2].map(|d| nodes.rim_arms.component(d).as_ptr());
    let arm = unsafe { arms.map(|arm| N::load(arm, boundary)) };
    let r = [splat3::<N>(c.rotation[0]), splat3(c.rotation[1]), splat3(c.rotation[2])];
    let rate = [splat3::<N>(c.rotation_rate[0]), splat3(c.rotation_rate[1]), splat3(c.rotation_rate[2])];
    Moved {
        x: add(splat3(c.axle), combined(&r, arm[0], arm[1], arm[2])),
        v: add(splat3(c.axle_velocity), combined(&rate, arm[0], arm[1], arm[2])),
    }
}

/// Old and new positions and velocities of a batch, number by number, where the compiler keeps vectors on whole cache lines.
#[repr(align(64))]
struct Unpacked<T> {
    x: [[T; WIDEST]; 3],
    v: [[T; WIDEST]; 3],
    new_x: [[T; WIDEST]; 3],
    new_v: [[T; WIDEST]; 3],
}

/// Puts the nodes that would end inside the road back on it.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // a batch in full
unsafe fn touch<N: Lanes, const PROBE: bool>(
    nodes: &Nodes<N::Real>,
    c: &Conditions<N::Real>,
    road: &Road,
    (at, batch): (usize, &NodeBatch),
    x: Vec3<N>,
    v: Vec3<N>,
    free: Moved<N>,
    books: &Books,
    sums: &mut LineSums,
    contact: &mut LineContact,
) -> Moved<N> {
    let inside = road.gap(free.x).negative() & batch.surface;
    if inside == 0 {
        return free;
    }
    let zeros = [[<N::Real as Scalar>::zero(); WIDEST]; 3];
    let places = (at, batch.boundary as usize);
    let mut batch = Unpacked { x: zeros, v: zeros, new_x: zeros, new_v: zeros };
    for d in 0..3 {
        unsafe {
            x[d].store(batch.x[d].as_mut_ptr(), 0);
            v[d].store(batch.v[d].as_mut_ptr(), 0);
            free.x[d].store(batch.new_x[d].as_mut_ptr(), 0);
            free.v[d].store(batch.new_v[d].as_mut_ptr(), 0);
        }
    }
    unsafe { touch_each::<N::Real, PROBE>(nodes, c, road, places, inside, &mut batch, books, sums, contact) };
    let load = |field: &[[N::Real; WIDEST]; 3], d: usize| unsafe { N::load(field[d].as_ptr(), 0) };
    Moved {
        x: [load(&batch.new_x, 0), load(&batch.new_x, 1), load(&batch.new_x, 2)],
        v: [load(&batch.new_v, 0), load(&batch.new_v, 1), load(&batch.new_v, 2)],
    }
}

/// The nodes of the lanes `inside`, one by one: few are. A function of its own, so that what friction laws need is not kept
/// ready for every line.
#[inline(never)]
#[allow(clippy::too_many_arguments)] // a batch in full
unsafe fn touch_each<T: Real, const PROBE: bool>(
    nodes: &Nodes<T>,
    c: &Conditions<T>,
    road: &Road,
    (at, boundary): (usize, usize),
    mut inside: u32,
    batch: &mut Unpacked<T>,
    books: &Books,
    sums: &mut LineSums,
    contact: &mut LineContact,
) {
    let lane_of = |field: &[[T; WIDEST]; 3], lane: usize| [field[0][lane], field[1][lane], field[2][lane]];
    while inside != 0 {
        let lane = inside.trailing_zeros() as usize;
        inside &= inside - 1;
        let before = lane_of(&batch.v, lane);
        let k = nodes.surface_of[boundary + lane] as usize;
        let inertia = node::inertia(&c.loads, c.step, nodes.mass.slice()[at + lane]);
        let area = || nodes.inverse_area.get(k).copied().unwrap_or(T::zero());
        let (x, v_star) = (lane_of(&batch.x, lane), lane_of(&batch.new_v, lane));
        let node = contact::Node { inertia, x, v: before, v_star };
        let Some(t) = contact::project(road, c.friction.as_ref(), area, c.step, &node) else { continue };
        for d in 0..3 {
            batch.new_x[d][lane] = t.x[d];
            batch.new_v[d][lane] = t.v[d];
        }
        unsafe { book_touch::<T, PROBE>(c, road, k, &t, before, books, sums, contact) };
    }
}

/// Works of a touching node and, where the step is taken, its window sums.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // a touch in full
unsafe fn book_touch<T: Real, const PROBE: bool>(
    c: &Conditions<T>,
    road: &Road,
    k: usize,
    t: &Touch<T>,
    before: Vec3<T>,
    books: &Books,
    sums: &mut LineSums,
    contact: &mut LineContact,
) {
    let way = axpy(t.v, c.weights[1], scale(before, c.weights[0]));
    let friction_work = dot(t.tangential_force, way).to_f64();
    sums.normal += dot(t.normal_force, way).to_f64();
    sums.friction += friction_work;
    if PROBE {
        return;
    }
    let (sum, last) = unsafe { (&mut *books.surface.add(k), &mut *books.last_touch.add(k)) };
    for d in 0..3 {
        let force = (t.normal_force[d] + t.tangential_force[d]).to_f64();
        sum.impulse[d] += force * c.step.dtm.to_f64();
        contact.force[d] += force;
    }
    if c.road_moves {
        let (force, surface) = (add(t.normal_force, t.tangential_force), road.velocity(t.x));
        sum.road_work += (dot(force, surface) * c.step.dtm).to_f64();
    }
    let stays = *last == c.number && c.number > 0;
    contact.touching += 1;
    contact.entered += u32::from(!stays);
    contact.switched += u32::from(stays && sum.sticks != t.sticks);
    sum.friction_work += friction_work;
    sum.touching += 1;
    sum.sticking += u32::from(t.sticks);
    sum.sticks = t.sticks;
    *last = c.number + 1;
}

/// Adds a batch's works and, for rim nodes, what the rim does to the rubber. Lanes that hold no node have neither mass
/// nor force.
#[allow(clippy::too_many_arguments)] // a batch's whole step
#[inline(always)]
fn book<N: Lanes, const PROBE: bool>(
    sums: &mut LaneSums<N>,
    c: &Conditions<N::Real>,
    lanes: &LaneConditions<N>,
    rim: u32,
    mass: N,
    f_int: Vec3<N>,
    x: Vec3<N>,
    v: Vec3<N>,
    moved: &Moved<N>,
) {
    let way = axpy(moved.v, lanes.weights[1], scale(v, lanes.weights[0]));
    let gravity = lanes.loads.gravity;
    sums.internal -= dot(f_int, way);
    if c.has_gravity {
        sums.body_force += mass * dot(gravity, way);
    }
    if PROBE {
        sums.mixed_kinetic += mass * dot(v, moved.v);
    }
    let zero = N::zero();
    if rim != 0 {
        let net = scale(sub(moved.v, v), mass * lanes.inverse_dtm);
        let work = dot(sub(add(net, f_int), scale(gravity, mass)), way);
        sums.rim += work.choose(zero, rim);
        let arm = sub(x, splat3(c.axle_before));
        let f = choose3(f_int, [zero; 3], rim);
        sums.impulse = add(sums.impulse, f);
        sums.moment = add(sums.moment, cross(arm, f));
    }
    if c.has_damping {
        let work = dot(node::damping_force(&lanes.loads, mass, v, moved.v), way);
        sums.damping += zero.choose(work, rim);
    }
    if PROBE {
        let net = scale(sub(moved.v, v), mass * lanes.inverse_dtm);
        sums.net_force2 += zero.choose(dot(net, net), rim);
        sums.internal_force2 += zero.choose(dot(f_int, f_int), rim);
    }
}

/// Adds a line's lanes to its sums in double precision.
#[inline(always)]
unsafe fn fold<N: Lanes, const PROBE: bool>(
    line: &mut LineSums,
    lanes: &LaneSums<N>,
    c: &Conditions<N::Real>,
    has_rim: bool,
) {
    unsafe {
        lanes.internal.add_to(line.internal.as_mut_ptr());
        if c.has_gravity {
            lanes.body_force.add_to(line.body_force.as_mut_ptr());
        }
        if c.has_damping {
            lanes.damping.add_to(line.damping.as_mut_ptr());
        }
        if has_rim {
            let dtm = N::splat(c.step.dtm);
            lanes.rim.add_to(line.rim.as_mut_ptr());
            for d in 0..3 {
                (lanes.impulse[d] * dtm).add_to(line.rim_impulse[d].as_mut_ptr());
                (lanes.moment[d] * dtm).add_to(line.rim_moment_impulse[d].as_mut_ptr());
            }
        }
        if PROBE {
            (lanes.mixed_kinetic * N::from_f64(0.5)).add_to(line.mixed_kinetic.as_mut_ptr());
            lanes.net_force2.add_to(line.net_force2.as_mut_ptr());
            lanes.internal_force2.add_to(line.internal_force2.as_mut_ptr());
        }
    }
}

/// Steps the nodes of a line; `probe`: only books what the step would do.
///
/// # Safety
/// No other thread touches the line's nodes, slots, surface entries or sums.
pub unsafe fn node_pass<T: Real>(
    nodes: &Nodes<T>,
    conditions: &Conditions<T>,
    line: usize,
    view: &View<T>,
    books: &Books,
    probe: bool,
) {
    nodes.level.call(Pass { nodes, conditions, line, view, books, probe });
}

/// The pass over a line; made by [`node_pass`] alone, whose safety contract it is under.
struct Pass<'a, T> {
    nodes: &'a Nodes<T>,
    conditions: &'a Conditions<T>,
    line: usize,
    view: &'a View<T>,
    books: &'a Books,
    probe: bool,
}

impl<T: Real> InLanes<T> for Pass<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes<Real = T>>(self) {
        let Pass { nodes, conditions: c, line, view, books, probe } = self;
        // SAFETY: the contract of `node_pass`; the line is one of these nodes'.
        unsafe {
            if probe {
                line_in::<N, true>(nodes, c, line, view, books)
            } else if nodes.lines.get_unchecked(line).plain && !c.has_gravity && !c.has_damping {
                plain_line::<N>(nodes, c, line, view, books)
            } else {
                line_in::<N, false>(nodes, c, line, view, books)
            }
        }
    }
}

//! The element pass, several elements at a time: forces onto the node lines.

use super::layout::{Item, Loose};
use super::rows::{Batch, Row, Rows};
use super::state::{Aligned, View};
use crate::model::Model;
use crate::model::chains::{BACK, FRONT};
use crate::physics::element::{Compose, Corners, Formulation, LaneShapes};
use crate::physics::lanes::{InLanes, Instructions, Lanes, WIDEST, first};
use crate::physics::material::{Hyperelastic, Viscosity};
use crate::physics::scalar::{Real, Scalar};
use crate::physics::tensor::Vec3;
use std::cell::Cell;
use std::marker::PhantomData;
use std::ops::Range;

/// Constant data of the element passes.
pub struct Elements<T> {
    pub items: Vec<Item>,
    /// Reference geometry by lanes, an entry of [`Class::NUMBERS`] vectors each.
    pub shapes: Aligned<T>,
}

/// What an item reports: its first element whose det F is not positive.
#[derive(Debug, Clone, Copy, Default)]
pub struct Failed(pub Option<usize>);

/// Viscous power: where its sums are, one f64 a lane, and what it counts.
#[derive(Debug, Clone, Copy)]
pub struct Power {
    pub sums: *mut f64,
    pub weight: f64,
}

/// An element pass, composed for one formulation, law and viscosity.
pub trait Kernel<T>: Send + Sync {
    /// Corner forces of an item onto the slots of its lines; viscous power [W] times the weight added to its sums.
    ///
    /// # Safety
    /// No other thread touches the slots of the item's group or these sums, nor writes the item's nodes.
    unsafe fn forces(&self, elements: &Elements<T>, item: usize, view: &View<T>, power: Power) -> Failed;

    /// The numbers of a class that it reads: [`Formulation::NUMBERS`].
    fn numbers(&self) -> Range<usize>;
}

/// Composes the kernel that a model needs, for these instructions.
pub fn compose<T: Real>(model: &Model, instructions: impl Instructions) -> Box<dyn Kernel<T>> {
    let build = Build { instructions, kind: PhantomData };
    model.composition().visit_fastest(model.is_extruded(), build)
}

struct Build<T, I> {
    instructions: I,
    kind: PhantomData<T>,
}

impl<T: Real, I: Instructions> Compose for Build<T, I> {
    type Output = Box<dyn Kernel<T>>;

    fn with<F: Formulation, L: Hyperelastic, V: Viscosity>(self, law: L, viscosity: V) -> Self::Output {
        Box::new(Composed::<F, L, V, I> {
            law,
            viscosity,
            instructions: self.instructions,
            kind: PhantomData,
        })
    }
}

struct Composed<F, L, V, I> {
    law: L,
    viscosity: V,
    instructions: I,
    kind: PhantomData<F>,
}

impl<T: Real, F: Formulation, L: Hyperelastic, V: Viscosity, I: Instructions> Kernel<T>
    for Composed<F, L, V, I>
{
    fn numbers(&self) -> Range<usize> {
        F::NUMBERS
    }

    unsafe fn forces(&self, elements: &Elements<T>, item: usize, view: &View<T>, power: Power) -> Failed {
        let Composed { law, viscosity, .. } = *self;
        let kind = PhantomData::<F>;
        self.instructions.call(Pass { law, viscosity, elements, item, view, power, kind })
    }
}

/// The pass over an item; made by [`Kernel::forces`] alone, whose safety contract it is under.
struct Pass<'a, T, F, L, V> {
    law: L,
    viscosity: V,
    elements: &'a Elements<T>,
    item: usize,
    view: &'a View<T>,
    power: Power,
    kind: PhantomData<F>,
}

impl<T: Real, F: Formulation, L: Hyperelastic, V: Viscosity> InLanes<T> for Pass<'_, T, F, L, V> {
    type Output = Failed;

    #[inline(always)]
    fn run<N: Lanes<Real = T>>(self) -> Failed {
        // SAFETY: the contract of `Kernel::forces`.
        unsafe {
            forces_in::<N, F, L, V>(
                &self.law,
                &self.viscosity,
                self.elements,
                self.item,
                self.view,
                self.power,
            )
        }
    }
}

/// Corners of a batch copied together, with nothing in common: vector c of a component holds corner c of every lane.
/// On cache lines: what is stored is loaded again at once.
#[repr(align(64))]
struct Copied<T> {
    x: [[T; 8 * WIDEST]; 3],
    v: [[T; 8 * WIDEST]; 3],
    f: [[T; 8 * WIDEST]; 3],
}

impl Default for Copied<f64> {
    fn default() -> Self {
        let zero = [[0.0; 8 * WIDEST]; 3];
        Copied { x: zero, v: zero, f: zero }
    }
}

impl<T: Real> Copied<T> {
    /// # Safety
    /// No thread writes the nodes of `loose`.
    unsafe fn read(&mut self, loose: &Loose, view: &View<T>, width: usize, velocities: bool) {
        for (c, nodes) in loose.nodes.iter().enumerate() {
            for (lane, &n) in nodes[..width].iter().enumerate() {
                for d in 0..3 {
                    unsafe {
                        self.x[d][c * width + lane] = *view.x[d].add(n as usize);
                        if velocities {
                            self.v[d][c * width + lane] = *view.v[d].add(n as usize);
                        }
                    }
                }
            }
        }
    }

    /// Adds the forces of the elements, lane by lane.
    ///
    /// # Safety
    /// No other thread touches the slots of `loose`.
    unsafe fn add(&self, loose: &Loose, view: &View<T>, width: usize) {
        for (c, slots) in loose.f.iter().enumerate() {
            for (lane, &slot) in slots[..loose.elements.len()].iter().enumerate() {
                for d in 0..3 {
                    unsafe {
                        let to = view.f[d].add(slot as usize);
                        *to += self.f[d][c * width + lane];
                    }
                }
            }
        }
    }
}

thread_local! {
    /// What a thread copies loose elements to. On the stack it would lie between the values of the force routine, which
    /// cost one build half of its speed.
    static COPY: Cell<Option<Box<Copied<f64>>>> = const { Cell::new(None) };
}

/// The same memory for numbers that need no more of it.
#[inline(always)]
fn in_precision<T: Real>(copy: &mut Copied<f64>) -> &mut Copied<T> {
    const { assert!(size_of::<Copied<T>>() <= size_of::<Copied<f64>>() && align_of::<T>() <= align_of::<f64>()) };
    // SAFETY: it is large enough and aligned, and any bits are numbers (`Real` is plain data).
    unsafe { &mut *std::ptr::from_mut(copy).cast() }
}

/// Where the corners of a batch lie: a vector a corner and direction, `at[corner]` numbers from the start of the
/// direction's array.
#[derive(Clone, Copy)]
struct Places {
    at: [usize; 8],
}

impl Places {
    /// On the lines of a row.
    #[inline(always)]
    fn on_row(row: &Row, batch: &Batch) -> Places {
        let mut at = [0; 8];
        for k in 0..4 {
            at[BACK[k]] = row.x[k] + batch.at();
            at[FRONT[k]] = row.x[k] + batch.at() + 1;
        }
        Places { at }
    }

    /// In a copy.
    #[inline(always)]
    fn copied(width: usize) -> Places {
        Places { at: std::array::from_fn(|c| c * width) }
    }

    /// Loaded without a branch between: in branches all of them would be kept at once, twice as many as there are
    /// registers.
    #[inline(always)]
    unsafe fn load<N: Lanes>(&self, field: &[*const N::Real; 3]) -> Corners<N> {
        let mut x = [[N::zero(); 3]; 8];
        for c in 0..8 {
            for d in 0..3 {
                x[c][d] = unsafe { N::load(field[d], self.at[c]) };
            }
        }
        x
    }
}

/// Copies the corners of a batch that goes on into the next row: vectors of the lines of its row and, in the lanes behind its last
/// element, of the next row's. Few batches do.
#[inline(always)]
unsafe fn copy_across<N: Lanes>(
    rows: &Rows,
    batch: &Batch,
    field: &[*mut N::Real; 3],
    copy: &mut [[N::Real; 8 * WIDEST]; 3],
) {
    unsafe {
        let row = rows.rows.get_unchecked(batch.row());
        let next = rows.rows.get_unchecked(batch.row() + 1);
        let mask = next_lanes(batch);
        for (field, copy) in field.iter().zip(copy) {
            for k in 0..4 {
                let from = field.wrapping_add(next.x[k]).wrapping_sub(batch.lanes());
                let back = N::load(*field, row.x[k] + batch.at()).load_over(from, mask);
                let front = N::load(*field, row.x[k] + batch.at() + 1).load_over(from.wrapping_add(1), mask);
                back.store(copy.as_mut_ptr(), BACK[k] * N::WIDTH);
                front.store(copy.as_mut_ptr(), FRONT[k] * N::WIDTH);
            }
        }
    }
}

/// Lanes of a batch that are elements of the next row.
#[inline(always)]
fn next_lanes(batch: &Batch) -> u32 {
    first(batch.lanes() + batch.next()) & !first(batch.lanes())
}

/// Reference geometry of a batch's lanes.
#[inline(always)]
fn shape_at<N: Lanes, F: Formulation>(elements: &Elements<N::Real>, entry: u32) -> LaneShapes<'_, N::Real> {
    let length = F::NUMBERS.len() * N::WIDTH;
    LaneShapes {
        numbers: &elements.shapes.slice()[entry as usize * length..][..length],
        first: F::NUMBERS.start,
    }
}

/// An item in lanes `N`, batch by batch; inlined into a function that has their instructions.
///
/// What the elements of a row's batch give their front corners is carried into the next batch, so that a node gets the
/// force of both its neighbours in the row at once.
#[inline(always)]
unsafe fn forces_in<N: Lanes, F: Formulation, L: Hyperelastic, V: Viscosity>(
    law: &L,
    viscosity: &V,
    elements: &Elements<N::Real>,
    item: usize,
    view: &View<N::Real>,
    power: Power,
) -> Failed {
    let viscous = V::ON;
    let item = &elements.items[item];
    let mut held = COPY.take().unwrap_or_default();
    let copy: &mut Copied<N::Real> = in_precision(&mut held);
    if let Item::Loose(loose) = item {
        unsafe { copy.read(loose, view, N::WIDTH, viscous) };
    }
    let mut failed = Failed(None);
    let mut carry = [[N::zero(); 3]; 4];
    let mut power_sum = N::zero();
    let all = item.elements().len();
    for (b, &shape) in item.shapes().iter().enumerate() {
        let at = b * N::WIDTH;
        let count = N::WIDTH.min(all - at);
        unsafe {
            let shape = shape_at::<N, F>(elements, shape);
            let copies = |field: &[[N::Real; 8 * WIDEST]; 3]| field.each_ref().map(|c| c.as_ptr());
            let (places, x, v) = match item {
                Item::Rows(rows) => {
                    let batch = rows.batches.get_unchecked(b);
                    if batch.next() > 0 {
                        copy_across::<N>(rows, batch, &view.x, &mut copy.x);
                        if viscous {
                            copy_across::<N>(rows, batch, &view.v, &mut copy.v);
                        }
                        (Places::copied(N::WIDTH), copies(&copy.x), copies(&copy.v))
                    } else {
                        let row = rows.rows.get_unchecked(batch.row());
                        (
                            Places::on_row(row, batch),
                            view.x.map(|x| x.cast_const()),
                            view.v.map(|v| v.cast_const()),
                        )
                    }
                }
                Item::Loose(_) => (Places::copied(N::WIDTH), copies(&copy.x), copies(&copy.v)),
            };
            let v = if viscous { places.load::<N>(&v) } else { [[N::zero(); 3]; 8] };
            let force = F::force(law, viscosity, &shape, &places.load::<N>(&x), &v);
            match item {
                Item::Rows(rows) => {
                    add_to_rows(rows, rows.batches.get_unchecked(b), view, &force.f, &mut carry);
                }
                Item::Loose(_) => {
                    for c in 0..8 {
                        for d in 0..3 {
                            force.f[c][d].store(copy.f[d].as_mut_ptr(), c * N::WIDTH);
                        }
                    }
                }
            }
            // Lanes beyond the last element compute with other nodes: they say nothing.
            if viscous {
                power_sum += force.viscous_power.choose(N::zero(), first(count));
            }
            let min_j = force.min_j.choose(N::one(), first(count));
            if min_j.any_not_positive() && failed.0.is_none() {
                failed.0 = first_failed(min_j, &item.elements()[at..at + count]);
            }
        }
    }
    unsafe {
        if let Item::Loose(loose) = item {
            copy.add(loose, view, N::WIDTH);
        }
        if viscous {
            (power_sum * N::from_f64(power.weight)).add_to(power.sums);
        }
    }
    COPY.set(Some(held));
    failed
}

/// Adds a batch's forces to the lines of its row and of the next; `carry`: what the elements in the lanes of the batch before
/// give their front corners.
#[inline(always)]
unsafe fn add_to_rows<N: Lanes>(
    rows: &Rows,
    batch: &Batch,
    view: &View<N::Real>,
    f: &Corners<N>,
    carry: &mut [Vec3<N>; 4],
) {
    unsafe {
        let row = rows.rows.get_unchecked(batch.row());
        add_to_row(row, view, batch, f, carry);
        if batch.at() + batch.lanes() < row.count {
            return;
        }
        end_of_row(row, view, batch.lanes(), carry);
        if batch.next() > 0 {
            start_of_row(rows.rows.get_unchecked(batch.row() + 1), view, batch, f);
        } else {
            *carry = [[N::zero(); 3]; 4];
        }
    }
}

/// Adds the forces of the lanes on a row to its lines.
#[inline(always)]
unsafe fn add_to_row<N: Lanes>(
    row: &Row,
    view: &View<N::Real>,
    batch: &Batch,
    f: &Corners<N>,
    carry: &mut [Vec3<N>; 4],
) {
    let count = batch.lanes();
    for k in 0..4 {
        for d in 0..3 {
            let to = row.f[k] + batch.at();
            let (mut back, front) = (f[BACK[k]][d], f[FRONT[k]][d]);
            if count < N::WIDTH {
                back = back.choose(N::zero(), first(count));
            }
            let mut sum = back + front.moved_up(carry[k][d]);
            carry[k][d] = front;
            if count < N::WIDTH {
                // An open row's last node has its force of the element before it alone.
                sum = sum.choose(N::zero(), first(count + usize::from(!row.closed)));
            }
            unsafe {
                if row.add[k] {
                    sum += N::load(view.f[d], to);
                }
                sum.store(view.f[d], to);
            }
        }
    }
}

/// What the last element of a row, in lane `lanes` - 1 of `carry`, gives its front corners: to the first nodes of a closed
/// row, else to a node more, which has its force already unless the batch is full.
#[inline(always)]
unsafe fn end_of_row<N: Lanes>(row: &Row, view: &View<N::Real>, lanes: usize, carry: &[Vec3<N>; 4]) {
    for k in 0..4 {
        for d in 0..3 {
            unsafe {
                if row.closed {
                    let start = view.f[d].add(row.f[k]);
                    *start += carry[k][d].lane(lanes - 1);
                } else if lanes == N::WIDTH {
                    let mut last = N::zero().moved_up(carry[k][d]);
                    if row.add[k] {
                        last += N::load(view.f[d], row.f[k] + row.count);
                    }
                    last.store(view.f[d], row.f[k] + row.count);
                }
            }
        }
    }
}

/// Adds the forces of the lanes on the next row to the start of its lines, whose first nodes have nothing from a lane before.
/// What the lines before have in those lanes is left alone.
#[inline(always)]
unsafe fn start_of_row<N: Lanes>(row: &Row, view: &View<N::Real>, batch: &Batch, f: &Corners<N>) {
    let mask = next_lanes(batch);
    let behind = mask & !(1 << batch.lanes());
    for k in 0..4 {
        for d in 0..3 {
            let to = view.f[d].wrapping_add(row.f[k]).wrapping_sub(batch.lanes());
            let front = f[FRONT[k]][d].moved_up(N::zero()).choose(N::zero(), behind);
            let mut sum = f[BACK[k]][d] + front;
            unsafe {
                if row.add[k] {
                    sum += N::zero().load_over(to, mask);
                }
                sum.store_where(to, mask);
            }
        }
    }
}

/// The lowest of `elements` that failed.
#[cold]
#[inline(never)]
fn first_failed<N: Lanes>(min_j: N, elements: &[u32]) -> Option<usize> {
    let bad = |lane: &usize| {
        min_j.lane(*lane).partial_cmp(&<N::Real as Scalar>::zero()) != Some(std::cmp::Ordering::Greater)
    };
    (0..elements.len()).filter(bad).map(|lane| elements[lane] as usize).min()
}

//! The element pass, several elements at a time: forces onto the node lines.

use super::family::{LawFamily, ViscosityFamily};
use super::layout::{Item, Loose};
use super::rows::{Batch, Row, Rows};
use super::state::{Aligned, View};
use crate::model::Model;
use crate::model::chains::{BACK, FRONT};
use crate::physics::element::{
    Class, Corners, ExtrudedFull, ExtrudedQ1p0, ExtrudedUniformGradient, Formulation, Full, LaneShapes, Q1p0,
    UniformGradient,
};
use crate::physics::lanes::{Lanes, Level, Portable32, Portable64, WIDEST, first};
use crate::physics::material::{Law, Viscosity};
use crate::physics::scalar::{Real, Scalar};
use crate::physics::tensor::Vec3;
use crate::scene;
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

struct Composed<F, L, V> {
    law: scene::Law,
    eta: f64,
    #[cfg_attr(test, expect(dead_code))] // see `Level::detect`
    level: Level,
    kind: PhantomData<(F, L, V)>,
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
unsafe fn forces_in<N: Lanes, F: Formulation, L: LawFamily, V: ViscosityFamily>(
    composed: &Composed<F, L, V>,
    elements: &Elements<N::Real>,
    item: usize,
    view: &View<N::Real>,
    power: Power,
) -> Failed {
    let law = <L::Law<N> as Law<N>>::new(&composed.law);
    let viscosity = <V::Viscosity<N> as Viscosity<N>>::new(composed.eta);
    let viscous = <V::Viscosity<N> as Viscosity<N>>::ON;
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
            let force = F::force(&law, &viscosity, &shape, &places.load::<N>(&x), &v);
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

/// One implementation a precision: which lane type each level of instructions uses.
macro_rules! dispatched {
    ($real:ty, $portable:ty, $avx2:ident, $avx512:ident) => {
        impl<F: Formulation, L: LawFamily, V: ViscosityFamily> Kernel<$real> for Composed<F, L, V> {
            fn numbers(&self) -> Range<usize> {
                F::NUMBERS
            }

            unsafe fn forces(
                &self,
                elements: &Elements<$real>,
                item: usize,
                view: &View<$real>,
                power: Power,
            ) -> Failed {
                // See `Level::detect`.
                #[cfg(all(target_arch = "x86_64", not(test)))]
                {
                    #[target_feature(enable = "avx2,fma")]
                    unsafe fn avx2<F: Formulation, L: LawFamily, V: ViscosityFamily>(
                        this: &Composed<F, L, V>,
                        elements: &Elements<$real>,
                        item: usize,
                        view: &View<$real>,
                        power: Power,
                    ) -> Failed {
                        use crate::physics::lanes::$avx2;
                        unsafe { forces_in::<$avx2, F, L, V>(this, elements, item, view, power) }
                    }
                    #[target_feature(enable = "avx512f,fma")]
                    unsafe fn avx512<F: Formulation, L: LawFamily, V: ViscosityFamily>(
                        this: &Composed<F, L, V>,
                        elements: &Elements<$real>,
                        item: usize,
                        view: &View<$real>,
                        power: Power,
                    ) -> Failed {
                        use crate::physics::lanes::$avx512;
                        unsafe { forces_in::<$avx512, F, L, V>(this, elements, item, view, power) }
                    }
                    match self.level {
                        Level::Avx512 => return unsafe { avx512(self, elements, item, view, power) },
                        Level::Avx2 => return unsafe { avx2(self, elements, item, view, power) },
                        Level::Portable => {}
                    }
                }
                unsafe { forces_in::<$portable, F, L, V>(self, elements, item, view, power) }
            }
        }
    };
}
dispatched!(f64, Portable64, F64x4, F64x8);
dispatched!(f32, Portable32, F32x8, F32x16);

/// Lanes of a level, for elements and nodes alike.
pub fn width(level: Level, single: bool) -> usize {
    let doubles = match level {
        Level::Avx512 => 8,
        Level::Avx2 => 4,
        Level::Portable => 2,
    };
    if single { 2 * doubles } else { doubles }
}

/// Composes the kernel a model needs.
pub fn compose<T>(model: &Model, level: Level) -> Box<dyn Kernel<T>>
where
    T: 'static,
    Composable: Build<T>,
{
    Composable::build(model, level)
}

/// Builds kernels of a precision.
pub trait Build<T> {
    fn build(model: &Model, level: Level) -> Box<dyn Kernel<T>>;
}

/// Carrier of [`Build`].
pub struct Composable;

macro_rules! build {
    ($real:ty) => {
        impl Build<$real> for Composable {
            fn build(model: &Model, level: Level) -> Box<dyn Kernel<$real>> {
                use super::family::*;
                let (law, viscosity) = (model.law, model.viscosity);
                fn boxed<F: Formulation, L: LawFamily, V: ViscosityFamily>(
                    law: scene::Law,
                    eta: f64,
                    level: Level,
                ) -> Box<dyn Kernel<$real>> {
                    Box::new(Composed::<F, L, V> { law, eta, level, kind: PhantomData })
                }
                fn with_law<F: Formulation, L: LawFamily>(
                    law: scene::Law,
                    viscosity: Option<f64>,
                    level: Level,
                ) -> Box<dyn Kernel<$real>> {
                    match viscosity {
                        None => boxed::<F, L, NoViscosity>(law, 0.0, level),
                        Some(eta) => boxed::<F, L, ShearViscosity>(law, eta, level),
                    }
                }
                fn with_formulation<F: Formulation>(
                    law: scene::Law,
                    viscosity: Option<f64>,
                    level: Level,
                ) -> Box<dyn Kernel<$real>> {
                    match law {
                        scene::Law::NeoHookean { .. } => with_law::<F, NeoHookeanLaw>(law, viscosity, level),
                        scene::Law::MooneyRivlin { .. } => {
                            with_law::<F, MooneyRivlinLaw>(law, viscosity, level)
                        }
                        scene::Law::MooneyRivlinEq4 { .. } => {
                            with_law::<F, MooneyRivlinEq4Law>(law, viscosity, level)
                        }
                    }
                }
                match model.element {
                    scene::Element::Q1p0 if model.is_extruded() => {
                        with_formulation::<ExtrudedQ1p0>(law, viscosity, level)
                    }
                    scene::Element::Q1p0 => with_formulation::<Q1p0>(law, viscosity, level),
                    scene::Element::Full if model.is_extruded() => {
                        with_formulation::<ExtrudedFull>(law, viscosity, level)
                    }
                    scene::Element::Full => with_formulation::<Full>(law, viscosity, level),
                    scene::Element::UniformGradient { .. } if model.is_extruded() => {
                        with_formulation::<ExtrudedUniformGradient>(law, viscosity, level)
                    }
                    scene::Element::UniformGradient { .. } => {
                        with_formulation::<UniformGradient>(law, viscosity, level)
                    }
                }
            }
        }
    };
}
build!(f64);
build!(f32);

/// Internal force of one element of a shape class in f64, at any corner positions and velocities.
pub fn element_forces(model: &Model, class: usize, x: &Corners<f64>, v: &Corners<f64>) -> Corners<f64> {
    single(model, &model.classes[class], x, v)
}

/// The same with plain numbers of any kind: the one place where a model's choices meet a scalar type.
fn single<S: Scalar>(model: &Model, class: &Class<S>, x: &Corners<S>, v: &Corners<S>) -> Corners<S> {
    use super::family::*;
    fn with<S: Scalar, F: Formulation, L: LawFamily>(
        model: &Model,
        class: &Class<S>,
        x: &Corners<S>,
        v: &Corners<S>,
    ) -> Corners<S> {
        let law = <L::Law<S> as Law<S>>::new(&model.law);
        match model.viscosity {
            None => {
                let none = <<NoViscosity as ViscosityFamily>::Viscosity<S> as Viscosity<S>>::new(0.0);
                F::force(&law, &none, class, x, v).f
            }
            Some(eta) => {
                let shear = <<ShearViscosity as ViscosityFamily>::Viscosity<S> as Viscosity<S>>::new(eta);
                F::force(&law, &shear, class, x, v).f
            }
        }
    }
    fn with_formulation<S: Scalar, F: Formulation>(
        model: &Model,
        class: &Class<S>,
        x: &Corners<S>,
        v: &Corners<S>,
    ) -> Corners<S> {
        match model.law {
            scene::Law::NeoHookean { .. } => with::<S, F, NeoHookeanLaw>(model, class, x, v),
            scene::Law::MooneyRivlin { .. } => with::<S, F, MooneyRivlinLaw>(model, class, x, v),
            scene::Law::MooneyRivlinEq4 { .. } => with::<S, F, MooneyRivlinEq4Law>(model, class, x, v),
        }
    }
    match model.element {
        scene::Element::Q1p0 => with_formulation::<S, Q1p0>(model, class, x, v),
        scene::Element::Full => with_formulation::<S, Full>(model, class, x, v),
        scene::Element::UniformGradient { .. } => with_formulation::<S, UniformGradient>(model, class, x, v),
    }
}

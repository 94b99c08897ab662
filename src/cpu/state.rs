//! The engine's arrays, one component a vector, padded so that lanes may read past the last item.

/// A vector field by components.
#[derive(Debug, Clone)]
pub struct Field<T> {
    pub components: [Vec<T>; 3],
}

/// Items that lanes may read beyond the end: the widest has 16.
pub const PADDING: usize = 16;

impl<T: Copy + crate::physics::scalar::Real> Field<T> {
    pub fn new(values: impl Iterator<Item = [f64; 3]> + Clone) -> Self {
        let component = |d: usize| {
            let padding = std::iter::repeat_n(T::zero(), PADDING);
            values.clone().map(|v| T::from_f64(v[d])).chain(padding).collect()
        };
        Field { components: [component(0), component(1), component(2)] }
    }

    pub fn get(&self, n: usize) -> [f64; 3] {
        [0, 1, 2].map(|d| self.components[d][n].to_f64())
    }

    pub fn pointers(&mut self) -> [*mut T; 3] {
        self.components.each_mut().map(|c| c.as_mut_ptr())
    }
}

/// Raw access for the threads of a step. Each writes its own elements' slots, then its own nodes; barriers between.
#[derive(Debug, Clone, Copy)]
pub struct View<T> {
    pub x: [*mut T; 3],
    pub v: [*mut T; 3],
    /// Corner forces: component d of corner c of element e at `slot(c, d) + e`.
    pub slots: *mut T,
    pub stride: usize,
}

// SAFETY: the passes that dereference these pointers are unsafe functions whose callers keep threads apart.
unsafe impl<T> Send for View<T> {}
unsafe impl<T> Sync for View<T> {}

impl<T> View<T> {
    /// Start of a column of slots.
    #[inline(always)]
    pub fn slot(&self, corner: usize, d: usize) -> usize {
        (corner * 3 + d) * self.stride
    }
}

/// Slots of `elements` elements: their stride and total length.
pub fn slot_sizes(elements: usize) -> (usize, usize) {
    // An odd number of cache lines: 24 columns a power of two apart would share cache sets.
    let stride = (elements + PADDING).div_ceil(16) | 1;
    (16 * stride, 24 * 16 * stride + PADDING)
}

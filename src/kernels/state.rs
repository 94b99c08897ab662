//! The engine's arrays, by component, aligned and padded so that lanes load whole vectors.

use crate::physics::lanes::WIDEST;
use crate::physics::scalar::Real;

/// A cache line.
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
struct CacheLine([u64; 8]);

/// Numbers that start on a cache line.
#[derive(Debug, Clone)]
pub struct Aligned<T> {
    lines: Vec<CacheLine>,
    kind: std::marker::PhantomData<T>,
}

impl<T: Real> Aligned<T> {
    /// At least `length` zeros, and what a whole vector may read beyond.
    pub fn zeros(length: usize) -> Self {
        let lines = (length + WIDEST).div_ceil(64 / size_of::<T>());
        // Pages that nothing is written to then take no memory.
        Aligned { lines: bytemuck::zeroed_vec(lines), kind: std::marker::PhantomData }
    }

    #[inline(always)]
    pub fn slice(&self) -> &[T] {
        bytemuck::cast_slice(&self.lines)
    }

    #[inline(always)]
    pub fn slice_mut(&mut self) -> &mut [T] {
        bytemuck::cast_slice_mut(&mut self.lines)
    }

    #[inline(always)]
    pub fn pointer(&mut self) -> *mut T {
        self.lines.as_mut_ptr().cast()
    }
}

/// A vector field: three components, one behind the other.
#[derive(Debug, Clone)]
pub struct Field<T> {
    all: Aligned<T>,
    stride: usize,
}

impl<T: Real> Field<T> {
    pub fn zeros(length: usize) -> Self {
        // Components a third of a page apart, modulo pages: at equal distances they would share cache sets.
        let per_line = 64 / size_of::<T>();
        let lines = (length + WIDEST).div_ceil(per_line);
        let stride = (lines + (64 + 21 - lines % 64) % 64) * per_line;
        Field { all: Aligned::zeros(3 * stride), stride }
    }

    #[inline(always)]
    pub fn component(&self, d: usize) -> &[T] {
        &self.all.slice()[d * self.stride..(d + 1) * self.stride]
    }

    pub fn component_mut(&mut self, d: usize) -> &mut [T] {
        let range = d * self.stride..(d + 1) * self.stride;
        &mut self.all.slice_mut()[range]
    }

    /// Becomes a copy of a field of the same length, in the memory it has.
    pub fn copy_from(&mut self, other: &Field<T>) {
        self.all.slice_mut().copy_from_slice(other.all.slice());
    }

    pub fn get(&self, at: usize) -> [f64; 3] {
        [0, 1, 2].map(|d| self.component(d)[at].to_f64())
    }

    pub fn set(&mut self, at: usize, value: [f64; 3]) {
        for d in 0..3 {
            self.component_mut(d)[at] = T::from_f64(value[d]);
        }
    }

    pub fn pointers(&mut self) -> [*mut T; 3] {
        let all = self.all.pointer();
        // SAFETY: within the allocation.
        [0, 1, 2].map(|d| unsafe { all.add(d * self.stride) })
    }
}

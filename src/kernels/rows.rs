//! Rows of elements, and how batches of lanes go along them.

use crate::physics::element::hex8::{BACK, FRONT};
use crate::physics::lanes::first;

/// A chain of elements on four node lines.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    pub count: usize,
    pub closed: bool,
    /// Lines of the corners 0-1, 3-2, 4-5, 7-6: where they start among the nodes, and among the forces.
    pub x: [usize; 4],
    pub f: [usize; 4],
    /// Whether the slot holds forces of an earlier row already.
    pub add: [bool; 4],
}

impl Row {
    /// Places of the corners of its element number `i`.
    pub fn corners(&self, i: usize) -> [u32; 8] {
        let mut places = [0; 8];
        for k in 0..4 {
            places[BACK[k]] = (self.x[k] + i) as u32;
            places[FRONT[k]] = (self.x[k] + i + 1) as u32;
        }
        places
    }
}

/// Lanes of one batch: consecutive elements of a row, and behind its last one the first elements of the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Batch {
    // Small: there is one for every few elements.
    row: u32,
    at: u32,
    lanes: u8,
    next: u8,
}

impl Batch {
    fn new([row, at, lanes, next]: [usize; 4]) -> Batch {
        Batch { row: row as u32, at: at as u32, lanes: lanes as u8, next: next as u8 }
    }

    #[inline(always)]
    pub fn row(&self) -> usize {
        self.row as usize
    }

    /// Element of the row in lane 0.
    #[inline(always)]
    pub fn at(&self) -> usize {
        self.at as usize
    }

    /// Lanes on the row.
    #[inline(always)]
    pub fn lanes(&self) -> usize {
        self.lanes as usize
    }

    /// Lanes on the next row.
    #[inline(always)]
    pub fn next(&self) -> usize {
        self.next as usize
    }

    /// A mask of the lanes on the next row.
    #[inline(always)]
    pub fn next_lanes(&self) -> u32 {
        first(self.lanes() + self.next()) & !first(self.lanes())
    }
}

/// Rows that batches run through from the first element to the last: the lanes that one would leave empty at its end take
/// elements of the next.
#[derive(Debug, Clone)]
pub struct Rows {
    pub rows: Vec<Row>,
    /// Elements of all rows, in order.
    pub elements: Vec<u32>,
    pub batches: Vec<Batch>,
    /// Entry of the table of shapes, by batch.
    pub shapes: Vec<u32>,
}

impl Rows {
    /// The row of a batch, without a look at bounds.
    ///
    /// # Safety
    /// The batch is one of these rows'.
    #[inline(always)]
    pub unsafe fn row_of(&self, batch: &Batch) -> &Row {
        // SAFETY: `Rows::new` makes batches of its own rows.
        unsafe { self.rows.get_unchecked(batch.row()) }
    }

    /// The row that a batch goes on into.
    ///
    /// # Safety
    /// The batch is one of these rows', and has lanes on the next row.
    #[inline(always)]
    pub unsafe fn row_after(&self, batch: &Batch) -> &Row {
        // SAFETY: `Rows::new` lets batches go on where there is a row.
        unsafe { self.rows.get_unchecked(batch.row() + 1) }
    }

    /// Rows in batches of `width` lanes. Only the last row may be shorter than a batch: none meets more than two.
    pub fn new(rows: Vec<Row>, elements: Vec<u32>, width: usize, shape: impl FnMut(&[u32]) -> u32) -> Rows {
        let mut batches = Vec::new();
        let (mut row, mut at) = (0, 0);
        while row < rows.len() {
            let lanes = (rows[row].count - at).min(width);
            let next = rows.get(row + 1).map_or(0, |next| next.count.min(width - lanes));
            batches.push(Batch::new([row, at, lanes, next]));
            at += lanes;
            if at == rows[row].count {
                (row, at) = (row + 1, next);
                if rows.get(row).is_some_and(|r| r.count == at) {
                    (row, at) = (row + 1, 0);
                }
            }
        }
        let shapes = elements.chunks(width).map(shape).collect();
        Rows { rows, elements, batches, shapes }
    }
}

/// How many of the rows that follow each other, of `counts` elements each, batches of `width` should run through: as few as
/// leave no lane empty, else all if that leaves fewer; rows shorter than a batch stay alone.
pub fn runs(counts: &[usize], width: usize) -> Vec<usize> {
    let batches = |counts: &[usize]| counts.iter().map(|n| n.div_ceil(width)).sum::<usize>();
    let mut runs = Vec::new();
    let mut rest = counts;
    while let Some(&first) = rest.first() {
        let long = rest.iter().take_while(|n| **n >= width).count();
        let whole = (1..=long).find(|&k| rest[..k].iter().sum::<usize>().is_multiple_of(width));
        let all: usize = rest[..long].iter().sum();
        let taken = match whole {
            Some(k) => k,
            None if first >= width && all.div_ceil(width) < batches(&rest[..long]) => long,
            None => 1,
        };
        runs.push(taken);
        rest = &rest[taken..];
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(count: usize) -> Row {
        Row { count, closed: true, x: [0; 4], f: [0; 4], add: [false; 4] }
    }

    #[test]
    fn batches_take_every_element_once_and_are_full_but_the_last() {
        for (counts, width) in [
            (vec![44; 4], 16),
            (vec![44; 2], 8),
            (vec![9, 13, 8], 8),
            (vec![16, 16], 16),
            (vec![3], 8),
            (vec![9, 2], 8),
        ] {
            let all: usize = counts.iter().sum();
            let rows: Vec<Row> = counts.iter().map(|n| row(*n)).collect();
            let rows = Rows::new(rows, (0..all as u32).collect(), width, |chunk| chunk.len() as u32);
            assert_eq!(rows.batches.len(), all.div_ceil(width), "{counts:?} {rows:?}");
            let mut taken = 0;
            for (b, shape) in rows.batches.iter().zip(&rows.shapes) {
                let (row, end) = (b.row(), b.at() + b.lanes());
                let before: usize = counts[..row].iter().sum();
                assert_eq!(
                    (before + b.at(), b.lanes() + b.next()),
                    (taken, *shape as usize),
                    "{counts:?} {b:?}"
                );
                assert!(end <= counts[row], "{counts:?} {b:?}");
                assert!(b.next() == 0 || end == counts[row], "{counts:?} {b:?}");
                taken += b.lanes() + b.next();
            }
            assert_eq!(taken, all, "{counts:?}");
        }
    }

    #[test]
    fn rows_are_joined_where_that_fills_lanes() {
        assert_eq!(runs(&[44; 4], 16), [4]);
        assert_eq!(runs(&[44; 4], 8), [2, 2]);
        assert_eq!(runs(&[44; 4], 4), [1; 4]);
        assert_eq!(runs(&[88; 3], 16), [2, 1]);
        // Three rows of 45 in 17 batches for 18; short rows alone.
        assert_eq!(runs(&[45, 45, 45, 6, 6], 8), [3, 1, 1]);
        assert_eq!(runs(&[47; 2], 16), [1, 1]);
    }
}

//! The table of shapes: reference geometry by lane, an entry for every distinct combination that a batch has.

use crate::physics::lanes::WIDEST;
use std::collections::HashMap;

/// Classes by lane.
pub type Lanes = [u32; WIDEST];

/// Entries in the order in which batches first need them.
pub struct Shapes<'a> {
    class_of: &'a [u32],
    entries: Vec<Lanes>,
    numbers: HashMap<Lanes, u32>,
}

impl<'a> Shapes<'a> {
    /// An empty table; `class_of`: shape class of every element.
    pub fn new(class_of: &'a [u32]) -> Self {
        Shapes { class_of, entries: Vec::new(), numbers: HashMap::new() }
    }

    /// The entry for these elements, one a lane; lanes beyond the last repeat it.
    pub fn entry(&mut self, batch: &[u32]) -> u32 {
        let class = |lane: usize| self.class_of[batch[lane.min(batch.len() - 1)] as usize];
        let lanes = std::array::from_fn(class);
        *self.numbers.entry(lanes).or_insert_with(|| {
            self.entries.push(lanes);
            self.entries.len() as u32 - 1
        })
    }

    pub fn into_entries(self) -> Vec<Lanes> {
        self.entries
    }
}

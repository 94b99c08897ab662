//! Who does what in a step.
//!
//! A node moves as soon as the last element that it belongs to has given its force, while both are in the cache: no
//! later element reads it. Lines between two threads' elements, and those of the rim, wait until all forces are there.

use super::layout::Layout;
use std::ops::Range;

/// A piece of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Task {
    /// Forces of an item.
    Forces(u32),
    /// The nodes of a line.
    Move(u32),
}

/// The work of one thread in every step.
#[derive(Debug, Clone, Default)]
pub struct Share {
    pub early: Vec<Task>,
    /// Lines that move after the threads have met; those of the rim are among them.
    pub late: Vec<u32>,
}

/// Shares of `members` threads.
pub fn shares(layout: &Layout, members: usize) -> Vec<Share> {
    let owned = owned_items(layout, members);
    let mut shares = vec![Share::default(); members];
    let mut ready = vec![Vec::new(); layout.items.len()];
    let mut late = Vec::new();
    for (l, line) in layout.lines.iter().enumerate() {
        let (first, last) = line.items;
        let alone = owned.iter().any(|o| o.contains(&first) && o.contains(&last));
        if alone && !line.has_rim { ready[last].push(l as u32) } else { late.push(l as u32) }
    }
    for (share, items) in shares.iter_mut().zip(owned) {
        for i in items {
            share.early.push(Task::Forces(i as u32));
            share.early.extend(ready[i].iter().map(|l| Task::Move(*l)));
        }
    }
    for (member, share) in shares.iter_mut().enumerate() {
        let of = |m: usize| late.len() * m / members;
        share.late = late[of(member)..of(member + 1)].to_vec();
    }
    shares
}

/// Whole groups, contiguous, as equal in elements as they go.
fn owned_items(layout: &Layout, members: usize) -> Vec<Range<usize>> {
    let size = |g: &Range<usize>| layout.items[g.clone()].iter().map(|i| i.elements().len()).sum::<usize>();
    let all: usize = layout.groups.iter().map(size).sum();
    let mut owned = vec![0..0; members];
    let (mut before, mut start) = (0, 0);
    for (member, items) in owned.iter_mut().enumerate() {
        let goal = all * (member + 1) / members;
        let mut end = start;
        for group in layout.groups.iter().filter(|g| g.start >= start) {
            let elements = size(group);
            // The group goes to whoever gets its larger half.
            if member + 1 < members && before + elements / 2 > goal {
                break;
            }
            before += elements;
            end = group.end;
        }
        *items = start..end;
        start = end;
    }
    owned
}

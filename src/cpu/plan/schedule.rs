//! Third stage: who does what in a step.
//!
//! A node moves as soon as the last element that it belongs to has given its force, while both are in the cache: no
//! later element reads it. Lines between two threads' elements, and those of the rim, wait until all forces are there.

use super::groups::Groups;
use super::roles::LineRoles;
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

/// Shares of `members` threads; `roles`: of every line.
pub fn shares(groups: &Groups, roles: &[LineRoles], members: usize) -> Vec<Share> {
    let owned = owned_items(groups, members);
    let mut ready = vec![Vec::new(); groups.items.len()];
    let mut late = Vec::new();
    for (l, (span, roles)) in groups.spans.iter().zip(roles).enumerate() {
        let alone = span.filter(|(first, last)| owned.iter().any(|o| o.contains(first) && o.contains(last)));
        match alone {
            Some((_, last)) if !roles.has_rim => ready[last].push(l as u32),
            _ => late.push(l as u32),
        }
    }
    let cut = |m: usize| late.len() * m / members;
    let share = |(member, items): (usize, Range<usize>)| {
        let tasks = |i: usize| {
            std::iter::once(Task::Forces(i as u32)).chain(ready[i].iter().map(|line| Task::Move(*line)))
        };
        Share { early: items.flat_map(tasks).collect(), late: late[cut(member)..cut(member + 1)].to_vec() }
    };
    owned.into_iter().enumerate().map(share).collect()
}

/// Whole groups, contiguous, as equal in elements as they go.
fn owned_items(groups: &Groups, members: usize) -> Vec<Range<usize>> {
    let size = |g: &Range<usize>| groups.items[g.clone()].iter().map(|i| i.element_count()).sum::<usize>();
    let all: usize = groups.groups.iter().map(size).sum();
    let mut owned = vec![0..0; members];
    let (mut before, mut start) = (0, 0);
    for (member, items) in owned.iter_mut().enumerate() {
        let goal = all * (member + 1) / members;
        let mut end = start;
        for group in groups.groups.iter().filter(|g| g.start >= start) {
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

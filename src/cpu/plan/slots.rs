//! Fourth stage: where the forces of a step lie.
//!
//! The slots of a line are needed from the first row that touches it to the step of its nodes. Where that is one thread's
//! business ([`Task::Move`]), another line takes them afterwards: a thread's forces stay in its cache, and a body needs
//! memory for a few layers of forces instead of for all.

use super::groups::Groups;
use super::lines::NodeLine;
use super::schedule::{Share, Task};
use crate::physics::lanes::WIDEST;
use std::collections::HashMap;

/// Slots by line.
#[derive(Debug, Clone)]
pub struct Slots {
    /// Where the slots of each line begin among the forces: one for every group that touches it, ascending, and one for a
    /// line that no group touches.
    pub of_lines: Vec<Vec<usize>>,
    /// Whether the forces of a line come lane by lane: its slots must be zero before a step.
    pub loose: Vec<bool>,
    /// Length of the force arrays.
    pub length: usize,
    /// The groups that touch each line.
    met: Vec<Vec<usize>>,
}

impl Slots {
    pub fn new(lines: &[NodeLine], groups: &Groups, shares: &[Share]) -> Slots {
        let mut met: Vec<Vec<usize>> = vec![Vec::new(); lines.len()];
        let mut loose = vec![false; lines.len()];
        for ((item, touched), group) in groups.items.iter().zip(&groups.touched).zip(&groups.group_of) {
            for &l in touched {
                if met[l].last() != Some(group) {
                    met[l].push(*group);
                }
                loose[l] |= item.is_loose();
            }
        }
        // A node of no element: nobody writes its slot.
        loose.iter_mut().zip(&met).for_each(|(loose, met)| *loose |= met.is_empty());
        let passing = passing(&loose, shares);
        let mut next = 0;
        let own = |l: usize| if passing[l] { 0 } else { met[l].len().max(1) };
        let mut of_line = |l: usize| {
            let slots: Vec<usize> = (0..own(l)).map(|k| next + k * lines[l].length).collect();
            next += slots.len() * lines[l].length;
            slots
        };
        let mut of_lines: Vec<Vec<usize>> = (0..lines.len()).map(&mut of_line).collect();
        for share in shares {
            next = lend(lines, groups, share, &passing, next, &mut of_lines);
        }
        Slots { of_lines, loose, length: next, met }
    }

    /// Number of the slot that a group adds to, among those of a line that it touches.
    pub fn number(&self, line: usize, group: usize) -> usize {
        self.met[line].iter().position(|met| *met == group).expect("the group touches the line")
    }
}

/// Lines whose slots pass on to others: those that one thread finishes. Lines that wait for all threads, or are added to
/// lane by lane and cleared for the next step, have theirs for good.
fn passing(loose: &[bool], shares: &[Share]) -> Vec<bool> {
    let mut passing = vec![false; loose.len()];
    for task in shares.iter().flat_map(|share| &share.early) {
        if let Task::Move(line) = *task {
            passing[line as usize] = !loose[line as usize];
        }
    }
    passing
}

/// Lends slots to the `passing` lines of one thread, from `next` on, in the order in which it works; returns where they end.
fn lend(
    lines: &[NodeLine],
    groups: &Groups,
    share: &Share,
    passing: &[bool],
    next: usize,
    of_lines: &mut [Vec<usize>],
) -> usize {
    // Two threads' slots share no vector.
    let mut next = next.next_multiple_of(WIDEST);
    // Of lines alike: what stands behind their last node is zero and is never written.
    let mut free: HashMap<(usize, bool), Vec<usize>> = HashMap::new();
    let kind = |l: usize| (lines[l].nodes.len(), lines[l].closed);
    let mut last_group = vec![usize::MAX; lines.len()];
    for task in &share.early {
        match *task {
            Task::Forces(item) => {
                let group = groups.group_of[item as usize];
                for &l in &groups.touched[item as usize] {
                    if !passing[l] || last_group[l] == group {
                        continue;
                    }
                    last_group[l] = group;
                    let again = free.get_mut(&kind(l)).and_then(Vec::pop);
                    of_lines[l].push(again.unwrap_or(next));
                    if again.is_none() {
                        next += lines[l].length;
                    }
                }
            }
            Task::Move(line) if passing[line as usize] => {
                free.entry(kind(line as usize)).or_default().extend(&of_lines[line as usize]);
            }
            Task::Move(_) => {}
        }
    }
    next
}

#[cfg(test)]
mod tests {
    use super::super::tests::body;
    use super::super::{Plan, Task};
    use super::*;
    use crate::kernels::{Item, Line};

    /// Lanes of the layouts: neither 44 nor 45 nodes fill them.
    const WIDTH: usize = 8;

    /// The line that starts at a place.
    fn line_at(lines: &[Line], place: usize) -> usize {
        lines.binary_search_by_key(&place, |line| line.start).expect("rows start where lines do")
    }

    /// Goes through a step of every share in turn and fails where two lines, or two threads, would write the same number,
    /// or a line's forces are gone before its nodes have moved.
    fn check(elements: [usize; 3], threads: usize) -> (usize, usize) {
        let model = body("lat100_straight", elements);
        let Plan { items, lines, shares, forces: total, .. } = Plan::new(&model, true, WIDTH, threads);
        assert!(items.iter().all(|item| matches!(item, Item::Rows(_))), "a ring is rows alone");
        let mut owner = vec![None; total];
        let mut territory = vec![None; total];
        for (member, share) in shares.iter().enumerate() {
            for task in &share.early {
                match *task {
                    Task::Forces(item) => {
                        let Item::Rows(rows) = &items[item as usize] else { unreachable!() };
                        for (row, k) in rows.rows.iter().flat_map(|row| (0..4).map(move |k| (row, k))) {
                            let l = line_at(&lines, row.x[k]);
                            for at in row.f[k]..row.f[k] + lines[l].length {
                                assert_eq!(
                                    owner[at],
                                    row.add[k].then_some(l),
                                    "{at} of item {item}, line {l}"
                                );
                                owner[at] = Some(l);
                            }
                        }
                    }
                    Task::Move(line) => {
                        let l = line as usize;
                        for slot in &lines[l].slots {
                            for at in *slot..slot + lines[l].length {
                                assert_eq!(owner[at].take(), Some(l), "{at} at the end of line {l}");
                                assert_eq!(*territory[at].get_or_insert(member), member, "{at}");
                            }
                        }
                    }
                }
            }
        }
        for line in shares.iter().flat_map(|share| &share.late) {
            let l = *line as usize;
            for slot in &lines[l].slots {
                assert!(owner[*slot..slot + lines[l].length].iter().all(|o| *o == Some(l)), "line {l}");
            }
        }
        let all = lines.iter().map(|line| line.slots.len() * line.length).sum();
        (total, all)
    }

    #[test]
    fn a_slot_is_one_lines_until_its_nodes_have_moved() {
        for threads in [1, 2, 3, 7] {
            for elements in [[44, 4, 5], [45, 6, 9], [44, 1, 1], [30, 12, 14]] {
                let (total, all) = check(elements, threads);
                assert!(total <= all + threads * WIDEST, "{elements:?}, {threads} threads: {total} of {all}");
            }
        }
    }

    /// Layers of forces, not all of them: of 40 some three (one that ends, one that begins, the rim's).
    #[test]
    fn slots_are_taken_again() {
        let (total, all) = check([40, 40, 4], 1);
        assert!(10 * total < all, "{total} of {all}");
    }
}

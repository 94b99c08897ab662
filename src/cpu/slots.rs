//! Where the forces of a step lie.
//!
//! The slots of a line are needed from the first row that touches it to the step of its nodes. Where that is one thread's
//! business ([`Task::Move`]), another line takes them afterwards: a thread's forces stay in its cache, and a body needs
//! memory for a few layers of forces instead of for all.

use super::layout::{Item, Line};
use super::schedule::{Share, Task};
use crate::physics::lanes::WIDEST;
use std::collections::HashMap;
use std::ops::Range;

/// Gives every line a slot for every group that touches it, and tells the items where to put their forces; returns the
/// length of the force arrays. `lengths`: of a slot, by line.
pub fn lay(
    items: &mut [Item],
    lines: &mut [Line],
    groups: &[Range<usize>],
    shares: &[Share],
    lengths: &[usize],
) -> usize {
    let mut group_of = vec![0; items.len()];
    for (g, range) in groups.iter().enumerate() {
        group_of[range.clone()].fill(g);
    }
    // Groups by line, ascending.
    let mut met: Vec<Vec<usize>> = vec![Vec::new(); lines.len()];
    for (item, &group) in items.iter().zip(&group_of) {
        for l in touched(item, lines) {
            if met[l].last() != Some(&group) {
                met[l].push(group);
            }
        }
    }
    let mut next = lasting(lines, &met, shares, lengths);
    for share in shares {
        next = passing(items, lines, &group_of, share, lengths, next);
    }
    let mut begun: Vec<Vec<bool>> = met.iter().map(|groups| vec![false; groups.len()]).collect();
    for (item, group) in items.iter_mut().zip(&group_of) {
        let of_group = |l: usize| met[l].iter().position(|g| g == group).expect("the item meets the line");
        match item {
            Item::Rows(rows) => {
                for row in &mut rows.rows {
                    for k in 0..4 {
                        let l = row.lines[k];
                        let slot = of_group(l);
                        row.f[k] = lines[l].slots[slot];
                        row.add[k] = std::mem::replace(&mut begun[l][slot], true) || lines[l].loose;
                    }
                }
            }
            Item::Loose(loose) => {
                for (slots, places) in loose.f.iter_mut().zip(&loose.nodes) {
                    for (slot, &place) in slots.iter_mut().zip(places) {
                        let l = line_of(lines, place);
                        *slot = (lines[l].slots[of_group(l)] + place as usize - lines[l].start) as u32;
                    }
                }
            }
        }
    }
    next
}

/// Slots that are a line's own: lines that wait for all threads or are added to lane by lane (and cleared for the next
/// step), and nodes of no element.
fn lasting(lines: &mut [Line], met: &[Vec<usize>], shares: &[Share], lengths: &[usize]) -> usize {
    let mut early = vec![false; lines.len()];
    for task in shares.iter().flat_map(|share| &share.early) {
        if let Task::Move(line) = *task {
            early[line as usize] = true;
        }
    }
    let mut next = 0;
    for (l, line) in lines.iter_mut().enumerate() {
        // A node of no element: nobody writes its slot.
        line.loose |= met[l].is_empty();
        if line.loose || !early[l] {
            for _ in 0..met[l].len().max(1) {
                line.slots.push(next);
                next += lengths[l];
            }
        }
    }
    next
}

/// Slots of the lines that one thread finishes, from `next` on, in the order in which it works; returns where they end.
fn passing(
    items: &[Item],
    lines: &mut [Line],
    group_of: &[usize],
    share: &Share,
    lengths: &[usize],
    next: usize,
) -> usize {
    // Two threads' slots share no vector.
    let mut next = next.next_multiple_of(WIDEST);
    // Of lines alike: what stands behind their last node is zero and is never written.
    let mut free: HashMap<(usize, bool), Vec<usize>> = HashMap::new();
    let mut last_group = vec![usize::MAX; lines.len()];
    let mut passes = vec![false; lines.len()];
    for task in &share.early {
        if let Task::Move(line) = *task {
            passes[line as usize] = lines[line as usize].slots.is_empty();
        }
    }
    for task in &share.early {
        match *task {
            Task::Forces(item) => {
                let group = group_of[item as usize];
                for l in touched(&items[item as usize], lines) {
                    if !passes[l] || last_group[l] == group {
                        continue;
                    }
                    last_group[l] = group;
                    let line = &mut lines[l];
                    let again = free.get_mut(&(line.nodes.len(), line.closed)).and_then(Vec::pop);
                    line.slots.push(again.unwrap_or(next));
                    if again.is_none() {
                        next += lengths[l];
                    }
                }
            }
            Task::Move(line) if passes[line as usize] => {
                let line = &lines[line as usize];
                free.entry((line.nodes.len(), line.closed)).or_default().extend(&line.slots);
            }
            Task::Move(_) => {}
        }
    }
    next
}

/// Lines that an item touches.
fn touched(item: &Item, lines: &[Line]) -> Vec<usize> {
    match item {
        Item::Rows(rows) => rows.rows.iter().flat_map(|row| row.lines).collect(),
        Item::Loose(loose) => loose.nodes.iter().flatten().map(|&place| line_of(lines, place)).collect(),
    }
}

/// The line of a place: lines lie in order.
fn line_of(lines: &[Line], place: u32) -> usize {
    lines.partition_point(|line| line.start <= place as usize) - 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cpu::layout::Layout;
    use crate::cpu::schedule::shares;
    use crate::model::Model;
    use crate::report::bench::wheel;

    /// Lanes of the layouts: neither 44 nor 45 nodes fill them.
    const WIDTH: usize = 8;

    /// Goes through a step of every share in turn and fails where two lines, or two threads, would write the same number.
    fn check(elements: [usize; 3], threads: usize) -> (usize, usize) {
        let model = Model::new(&wheel(elements, 1.0)).unwrap();
        let layout = Layout::new(&model, true, WIDTH);
        assert!(layout.items.iter().all(|item| matches!(item, Item::Rows(_))), "a ring is rows alone");
        let shares = shares(&layout, threads);
        let Layout { mut items, mut lines, groups, .. } = layout;
        let lengths: Vec<usize> = lines.iter().map(|line| line.length(WIDTH)).collect();
        let total = lay(&mut items, &mut lines, &groups, &shares, &lengths);
        let mut owner = vec![None; total];
        let mut territory = vec![None; total];
        for (member, share) in shares.iter().enumerate() {
            for task in &share.early {
                match *task {
                    Task::Forces(item) => {
                        let Item::Rows(rows) = &items[item as usize] else { unreachable!() };
                        for (row, k) in rows.rows.iter().flat_map(|row| (0..4).map(move |k| (row, k))) {
                            let (l, expected) = (row.lines[k], row.add[k].then_some(row.lines[k]));
                            for at in row.f[k]..row.f[k] + lengths[l] {
                                assert_eq!(owner[at], expected, "{at} of item {item}, line {l}");
                                owner[at] = Some(l);
                            }
                        }
                    }
                    Task::Move(line) => {
                        let l = line as usize;
                        for slot in &lines[l].slots {
                            for at in *slot..slot + lengths[l] {
                                assert_eq!(owner[at].take(), Some(l), "{at} at the end of line {l}");
                                assert_eq!(*territory[at].get_or_insert(member), member, "{at}");
                            }
                        }
                    }
                }
            }
        }
        for &l in shares.iter().flat_map(|share| &share.late) {
            for slot in &lines[l as usize].slots {
                assert!(owner[*slot..slot + lengths[l as usize]].iter().all(|o| *o == Some(l as usize)));
            }
        }
        let all = lines.iter().zip(&lengths).map(|(line, length)| line.slots.len() * length).sum();
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

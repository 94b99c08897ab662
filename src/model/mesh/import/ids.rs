//! From the numbers of a file to places in arrays.

/// Ids of a list, to be looked up.
#[derive(Debug, Default)]
pub struct Ids {
    /// Place plus one of an id below the length; zero: no such id.
    dense: Vec<u32>,
    /// The rest, ascending.
    sparse: Vec<(u64, u32)>,
}

impl Ids {
    /// `Err`: the places of an id that is there twice.
    pub fn new(ids: &[u64]) -> Result<Ids, [usize; 2]> {
        // A table while most of it is used, and a search for what lies beyond.
        let end = 8 * ids.len() as u64 + 1024;
        let largest = ids.iter().copied().filter(|&id| id < end).max();
        let mut dense = vec![0; largest.map_or(0, |id| id as usize + 1)];
        let mut sparse = Vec::new();
        for (place, &id) in ids.iter().enumerate() {
            match dense.get_mut(id as usize) {
                Some(entry) if *entry > 0 => return Err([*entry as usize - 1, place]),
                Some(entry) => *entry = place as u32 + 1,
                None => sparse.push((id, place as u32)),
            }
        }
        sparse.sort_unstable();
        match sparse.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            Some(pair) => Err([pair[0].1 as usize, pair[1].1 as usize]),
            None => Ok(Ids { dense, sparse }),
        }
    }

    pub fn get(&self, id: u64) -> Option<u32> {
        match usize::try_from(id).ok().and_then(|id| self.dense.get(id)) {
            Some(&entry) => entry.checked_sub(1),
            None => self.sparse.binary_search_by_key(&id, |e| e.0).ok().map(|at| self.sparse[at].1),
        }
    }

    /// Places of the ids first, first + step, .. last that are there, in this order.
    pub fn range(&self, [first, last, step]: [u64; 3]) -> Vec<u32> {
        let step = step.max(1);
        let known = self.dense.len() as u64;
        let below = (first..=last.min(known.saturating_sub(1))).step_by(step as usize);
        let low = below.filter(|_| first < known).filter_map(|id| self.get(id));
        let from = self.sparse.partition_point(|e| e.0 < first);
        let high =
            self.sparse[from..].iter().take_while(|e| e.0 <= last).filter(|e| (e.0 - first) % step == 0);
        low.chain(high.map(|e| e.1)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_found_wherever_they_lie() {
        let list = [7, 1, u64::MAX - 3, 3_000_000_000, 12];
        let ids = Ids::new(&list).unwrap();
        for (place, id) in list.into_iter().enumerate() {
            assert_eq!(ids.get(id), Some(place as u32));
        }
        for id in [0, 2, 13, 3_000_000_001, u64::MAX] {
            assert_eq!(ids.get(id), None, "{id}");
        }
        assert!(ids.dense.len() < 2000, "a large id makes no large table");
    }

    #[test]
    fn ids_that_are_there_twice_are_named() {
        assert_eq!(Ids::new(&[5, 6, 5]).unwrap_err(), [0, 2]);
        assert_eq!(Ids::new(&[1 << 40, 6, 1 << 40]).unwrap_err(), [0, 2]);
    }

    /// A range of a hostile file costs what is there, not what it says.
    #[test]
    fn ranges_have_what_is_there() {
        let ids = Ids::new(&[1, 3, 4, 9, 1 << 40]).unwrap();
        assert_eq!(ids.range([1, u64::MAX, 1]), [0, 1, 2, 3, 4]);
        assert_eq!(ids.range([1, 9, 2]), [0, 1, 3]);
        assert_eq!(ids.range([2, 8, 0]), [1, 2]);
        assert!(ids.range([9, 2, 1]).is_empty());
        assert_eq!(ids.range([0, 1 << 41, 1 << 40]), [4]);
        assert!(ids.range([5000, 6000, 1]).is_empty());
    }
}

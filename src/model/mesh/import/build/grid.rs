//! Points sorted into boxes, to be found by where they are.

/// As many boxes as points, about.
pub struct Grid<'a> {
    points: &'a [[f64; 3]],
    low: [f64; 3],
    size: f64,
    counts: [usize; 3],
    /// Points by box (compressed rows).
    start: Vec<u32>,
    items: Vec<u32>,
}

impl<'a> Grid<'a> {
    /// Of the points `of` by number.
    pub fn new(points: &'a [[f64; 3]], of: &[u32]) -> Grid<'a> {
        let bound = |d: usize, pick: fn(f64, f64) -> f64, from: f64| {
            of.iter().fold(from, |m, &n| pick(m, points[n as usize][d]))
        };
        let low: [f64; 3] = std::array::from_fn(|d| bound(d, f64::min, f64::INFINITY));
        let extent: [f64; 3] =
            std::array::from_fn(|d| (bound(d, f64::max, f64::NEG_INFINITY) - low[d]).max(0.0));
        // Boxes of equal sides, so that a flat body has no more of them than a thick one.
        let longest = extent.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let volume: f64 = extent.iter().map(|e| (e / longest).max(1e-3)).product();
        let size = longest * (volume / of.len().max(1) as f64).cbrt();
        let counts = extent.map(|e| (e / size) as usize + 1);
        let mut grid = Grid { points, low, size, counts, start: Vec::new(), items: vec![0; of.len()] };
        let mut start = vec![0_u32; counts.iter().product::<usize>() + 1];
        of.iter().for_each(|&n| start[grid.index(grid.place(points[n as usize])) + 1] += 1);
        (1..start.len()).for_each(|i| start[i] += start[i - 1]);
        let mut next = start.clone();
        for &n in of {
            let at = &mut next[grid.index(grid.place(points[n as usize]))];
            grid.items[*at as usize] = n;
            *at += 1;
        }
        grid.start = start;
        grid
    }

    fn place(&self, x: [f64; 3]) -> [usize; 3] {
        // A cast takes what is below zero, or not a number, to zero.
        std::array::from_fn(|d| (((x[d] - self.low[d]) / self.size) as usize).min(self.counts[d] - 1))
    }

    fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.counts[1] + j) * self.counts[0] + i
    }

    /// Calls `each` for every point in a box.
    pub fn within(&self, [low, high]: [[f64; 3]; 2], mut each: impl FnMut(u32)) {
        let (from, to) = (self.place(low), self.place(high));
        for k in from[2]..=to[2] {
            for j in from[1]..=to[1] {
                let row = [self.index([from[0], j, k]), self.index([to[0], j, k])];
                for &n in &self.items[self.start[row[0]] as usize..self.start[row[1] + 1] as usize] {
                    let x = self.points[n as usize];
                    if (0..3).all(|d| low[d] <= x[d] && x[d] <= high[d]) {
                        each(n);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a search in boxes finds is what a search through all finds.
    #[test]
    fn points_in_a_box_are_found() {
        let point = |i: usize| [(i * 37 % 101) as f64, (i * 53 % 89) as f64 * 1e-3, (i * 71 % 97) as f64];
        let points: Vec<_> = (0..500).map(point).collect();
        let all: Vec<u32> = (0..500).collect();
        let grid = Grid::new(&points, &all);
        for at in &points {
            let [low, high] = [at.map(|c| c - 7.5), at.map(|c| c + 3.2)];
            let mut found = Vec::new();
            grid.within([low, high], |n| found.push(n));
            found.sort_unstable();
            let inside = |n: &u32| (0..3).all(|d| (low[d]..=high[d]).contains(&points[*n as usize][d]));
            assert_eq!(found, all.iter().copied().filter(inside).collect::<Vec<_>>());
        }
    }
}

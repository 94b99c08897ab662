//! Logical grids of meshes that are lattices, and coarser ones made of every other of their nodes.

use crate::model::mesh::{Lattice, SIGNS};

/// Nodes along a logical direction, by their place in elements of the finest mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Axis {
    at: Vec<usize>,
    /// Finest elements once around, where the direction closes on itself.
    round: Option<usize>,
}

/// What a coarse place gives to a fine one between two of them.
#[derive(Debug, Clone, Copy)]
pub struct Part {
    pub coarse: usize,
    pub weight: f64,
    /// Way from the coarse place to the fine one, in finest elements.
    pub ahead: isize,
}

impl Axis {
    fn new(elements: usize, wraps: bool) -> Axis {
        let nodes = if wraps { elements } else { elements + 1 };
        Axis { at: (0..nodes).collect(), round: wraps.then_some(elements) }
    }

    fn elements(&self) -> usize {
        self.at.len() - usize::from(self.round.is_none())
    }

    /// Every other node, and the last: an odd number of elements leaves one that is not doubled. Where that would
    /// leave fewer elements than `least`, the same.
    fn coarser(&self, least: usize) -> Axis {
        if self.elements().div_ceil(2) < least {
            return self.clone();
        }
        let mut at: Vec<usize> = self.at.iter().copied().step_by(2).collect();
        if self.round.is_none() && at.last() != self.at.last() {
            at.extend(self.at.last());
        }
        Axis { at, round: self.round }
    }

    /// Linear interpolation at a finer axis' node.
    fn parts(&self, place: usize) -> Vec<Part> {
        let below = self.at.partition_point(|&a| a <= place) - 1;
        let way = place - self.at[below];
        if way == 0 {
            return vec![Part { coarse: below, weight: 1.0, ahead: 0 }];
        }
        let above = (below + 1) % self.at.len();
        let end = if above == 0 { self.round.expect("inside the axis") } else { self.at[above] };
        let length = (end - self.at[below]) as f64;
        let left = end - place;
        vec![
            Part { coarse: below, weight: left as f64 / length, ahead: way as isize },
            Part { coarse: above, weight: way as f64 / length, ahead: -(left as isize) },
        ]
    }
}

/// A logical grid, numbered as [`crate::model::mesh`] does: i fastest, then j, then k.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Grid {
    axes: [Axis; 3],
}

/// Elements that a ring keeps: with fewer, its elements' sides are no longer anything like arcs.
const RING: usize = 8;

impl Grid {
    /// The grid of a lattice; in a closed one direction i is a turn about the axle.
    pub fn new(lattice: &Lattice) -> Grid {
        let [ni, nj, nk] = lattice.elements;
        Grid { axes: [Axis::new(ni, lattice.closed), Axis::new(nj, false), Axis::new(nk, false)] }
    }

    /// The next coarser grid. `None`: nothing can be left out any more.
    pub fn coarser(&self) -> Option<Grid> {
        let least = |a: &Axis| if a.round.is_some() { RING } else { 1 };
        let axes = std::array::from_fn(|d| self.axes[d].coarser(least(&self.axes[d])));
        let coarser = Grid { axes };
        (coarser != *self).then_some(coarser)
    }

    pub fn elements(&self) -> [usize; 3] {
        std::array::from_fn(|d| self.axes[d].elements())
    }

    pub fn node_count(&self) -> usize {
        self.axes.iter().map(|a| a.at.len()).product()
    }

    /// Finest elements once around a ring.
    pub fn round(&self) -> Option<usize> {
        self.axes[0].round
    }

    pub fn node(&self, i: usize, j: usize, k: usize) -> usize {
        let [ni, nj, _] = self.axes.each_ref().map(|a| a.at.len());
        (k * nj + j) * ni + i % ni
    }

    /// Nodes of every element, in the corner order of [`crate::model::mesh`].
    pub fn hexes(&self) -> Vec<[u32; 8]> {
        let [ni, nj, nk] = self.elements();
        let mut hexes = Vec::with_capacity(ni * nj * nk);
        for k in 0..nk {
            for j in 0..nj {
                for i in 0..ni {
                    hexes.push(SIGNS.map(|s| {
                        let up = |d: usize| usize::from(s[d] > 0.0);
                        self.node(i + up(0), j + up(1), k + up(2)) as u32
                    }));
                }
            }
        }
        hexes
    }

    /// For every node of this grid, in order, what every direction's places of a coarser grid give to it.
    pub fn each_node(&self, coarser: &Grid, mut f: impl FnMut([&[Part]; 3])) {
        let parts: [Vec<Vec<Part>>; 3] = std::array::from_fn(|d| {
            self.axes[d].at.iter().map(|&place| coarser.axes[d].parts(place)).collect()
        });
        for k in &parts[2] {
            for j in &parts[1] {
                for i in &parts[0] {
                    f([i, j, k]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::mesh::Mesh;
    use crate::scene::MeshSpec;

    #[test]
    fn grids_are_numbered_as_the_generators_do() {
        for spec in [
            MeshSpec::Ring { outer_radius: 0.04, inner_radius: 0.02, width: 0.02, elements: [9, 2, 3] },
            MeshSpec::Block { size: [1.0; 3], elements: [2, 3, 4] },
        ] {
            let mesh = Mesh::generate(&spec);
            let grid = Grid::new(&mesh.lattice().unwrap());
            assert_eq!(grid.hexes(), mesh.hexes);
            assert_eq!(grid.node_count(), mesh.nodes.len());
        }
    }

    #[test]
    fn odd_numbers_of_elements_leave_one_as_it_is() {
        let axis = Axis::new(5, false);
        let half = axis.coarser(1);
        assert_eq!(half.at, [0, 2, 4, 5]);
        assert_eq!(half.coarser(1).at, [0, 4, 5]);
        assert_eq!(half.coarser(1).coarser(1).at, [0, 5]);
        assert_eq!(Axis::new(11, true).coarser(6).at, [0, 2, 4, 6, 8, 10]);
        assert_eq!(Axis::new(11, true).coarser(8).elements(), 11);
        let [below, above] = half.coarser(1).coarser(1).parts(4)[..] else { panic!() };
        assert_eq!((below.weight, above.weight, below.ahead, above.ahead), (0.2, 0.8, 4, -1));
        // The last element of a ring ends at its first node.
        let [below, above] = Axis::new(12, true).coarser(1).parts(11)[..] else { panic!() };
        assert_eq!((below.coarse, above.coarse, below.ahead, above.ahead), (5, 0, 1, -1));
    }
}

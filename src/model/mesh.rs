//! Eight-node hexahedral meshes: generators, node sets by construction, boundary facets.

use std::f64::consts::TAU;

pub use crate::physics::element::hex8::{FACES, SIGNS};
use crate::scene::{Grading, Hold, MeshSpec, NodeSet};

/// A mesh of hexahedra in its reference shape.
#[derive(Debug, Clone)]
pub struct Mesh {
    /// Reference positions [m], shape `[node_count]`.
    pub nodes: Vec<[f64; 3]>,
    /// Corner nodes, shape `[element_count]`.
    pub hexes: Vec<[u32; 8]>,
    /// Outer boundary quadrilaterals, counter-clockwise seen from outside, shape `[facet_count]`.
    pub facets: Vec<[u32; 4]>,
    /// Rigid nodes, ascending (empty without a rim), and the body's point that the rim turns about [m].
    pub rim: Vec<u32>,
    pub axle: [f64; 3],
    /// Nodes that can touch the road: boundary nodes that are not rim nodes, ascending.
    pub surface: Vec<u32>,
    /// Held components of each node, bit d for component d; empty where nothing is held. Rim nodes have none.
    pub held: Vec<u8>,
}

impl Mesh {
    /// Builds the mesh a scene describes, translated by `offset`.
    pub fn generate(spec: &MeshSpec, offset: [f64; 3], rim: Option<NodeSet>) -> Mesh {
        Mesh::graded(spec, &Grading::default(), offset, rim, &[])
    }

    /// The same with elements of unequal size and held components.
    pub fn graded(
        spec: &MeshSpec,
        grading: &Grading,
        offset: [f64; 3],
        rim: Option<NodeSet>,
        holds: &[Hold],
    ) -> Mesh {
        let (grid, axle) = match *spec {
            MeshSpec::Ring { outer_radius, inner_radius, width, elements } => {
                (ring(outer_radius, inner_radius, width, elements, grading), [0.0, 0.0, outer_radius])
            }
            MeshSpec::Block { size, elements } => (block(size, elements, grading), size.map(|s| 0.5 * s)),
        };
        grid.into_mesh(offset, axle, rim, holds)
    }
}

/// A logically rectangular grid of nodes; `wrap`: the first direction closes on itself.
struct Grid {
    counts: [usize; 3],
    wrap: bool,
    /// Position of logical node (i, j, k).
    nodes: Vec<[f64; 3]>,
}

/// Logical directions: i along the circumference, j along the width, k along the radius, so that rows around the ring
/// are contiguous, layers of equal shape too, and (i, j, k) is right-handed.
fn ring(outer: f64, inner: f64, width: f64, [nc, nr, nw]: [usize; 3], grading: &Grading) -> Grid {
    let [around, through, across] = grading.ratio;
    let mut nodes = Vec::with_capacity(nc * (nr + 1) * (nw + 1));
    for k in 0..=nr {
        let radius = inner + (outer - inner) * share(k, nr, through);
        for j in 0..=nw {
            let y = width * (share_from_ends(j, nw, across) - 0.5);
            for i in 0..nc {
                // Node 0 at the bottom, then towards -x: a turn about +y.
                let (sin, cos) = (TAU * turn(i, nc, around, grading.fine_arc)).sin_cos();
                nodes.push([-radius * sin, y, outer - radius * cos]);
            }
        }
    }
    Grid { counts: [nc, nw, nr], wrap: true, nodes }
}

fn block(size: [f64; 3], counts: [usize; 3], grading: &Grading) -> Grid {
    let [nx, ny, nz] = counts;
    let mut nodes = Vec::with_capacity((nx + 1) * (ny + 1) * (nz + 1));
    for k in 0..=nz {
        for j in 0..=ny {
            for i in 0..=nx {
                let at = |c: usize, d: usize| size[d] * share(c, counts[d], grading.ratio[d]);
                nodes.push([at(i, 0), at(j, 1), at(k, 2)]);
            }
        }
    }
    Grid { counts, wrap: false, nodes }
}

/// Share of the length before node i of n, sizes growing by `ratio` from end to end.
fn share(i: usize, n: usize, ratio: f64) -> f64 {
    let s = i as f64 / n as f64;
    grown(s, ratio)
}

fn grown(s: f64, ratio: f64) -> f64 {
    // Elements that hardly grow: the formula below would divide zero by zero.
    if (ratio - 1.0).abs() < 1e-12 { s } else { (ratio.powf(s) - 1.0) / (ratio - 1.0) }
}

/// The same for sizes that grow from both ends to the middle.
fn share_from_ends(i: usize, n: usize, ratio: f64) -> f64 {
    let s = i as f64 / n as f64;
    if s <= 0.5 { 0.5 * grown(2.0 * s, ratio) } else { 1.0 - 0.5 * grown(2.0 * (1.0 - s), ratio) }
}

/// Share of a turn before node i of n round a ring: equal elements within `arc` [rad] about node 0, sizes that grow by
/// `ratio` from there to the far side.
fn turn(i: usize, n: usize, ratio: f64, arc: f64) -> f64 {
    let s = i as f64 / n as f64;
    if (ratio - 1.0).abs() < 1e-12 {
        return s;
    }
    // Half a turn is the unit: `equal` of it has equal elements, which take the share `index` of the numbers;
    // sizes agree where the parts meet.
    let equal = (arc / TAU).min(1.0);
    let index = 1.0 / (1.0 + (1.0 - equal) / equal * ratio.ln() / (ratio - 1.0));
    let half = |t: f64| match t <= index {
        true if equal > 0.0 => equal * t / index,
        _ => equal + (1.0 - equal) * grown((t - index) / (1.0 - index), ratio),
    };
    if s <= 0.5 { 0.5 * half(2.0 * s) } else { 1.0 - 0.5 * half(2.0 * (1.0 - s)) }
}

impl Grid {
    /// Index of logical node (i, j, k): i fastest, then j, then k.
    fn node(&self, i: usize, j: usize, k: usize) -> u32 {
        let [ni, nj, _] = self.counts;
        let row = if self.wrap { ni } else { ni + 1 };
        ((k * (nj + 1) + j) * row + i % row) as u32
    }

    fn into_mesh(self, offset: [f64; 3], axle: [f64; 3], rim: Option<NodeSet>, holds: &[Hold]) -> Mesh {
        let [ni, nj, nk] = self.counts;
        let mut hexes = Vec::with_capacity(ni * nj * nk);
        let mut facets = Vec::new();
        for k in 0..nk {
            for j in 0..nj {
                for i in 0..ni {
                    let hex = SIGNS.map(|s| {
                        let up = |d: usize| usize::from(s[d] > 0.0);
                        self.node(i + up(0), j + up(1), k + up(2))
                    });
                    let open = |at: usize, n: usize| [at == 0, at + 1 == n];
                    let [i0, i1] = if self.wrap { [false; 2] } else { open(i, ni) };
                    let ([j0, j1], [k0, k1]) = (open(j, nj), open(k, nk));
                    for (face, outside) in FACES.iter().zip([i0, i1, j0, j1, k0, k1]) {
                        if outside {
                            facets.push(face.map(|c| hex[c]));
                        }
                    }
                    hexes.push(hex);
                }
            }
        }
        let rim_nodes = rim.map(|set| self.set(set)).unwrap_or_default();
        let mut surface: Vec<u32> = facets.iter().flatten().copied().collect();
        surface.sort_unstable();
        surface.dedup();
        surface.retain(|n| rim_nodes.binary_search(n).is_err());
        let held = self.held(holds, &rim_nodes);
        let shift = |p: [f64; 3]| std::array::from_fn(|d| p[d] + offset[d]);
        Mesh {
            nodes: self.nodes.iter().map(|&p| shift(p)).collect(),
            hexes,
            facets,
            rim: rim_nodes,
            axle: shift(axle),
            surface,
            held,
        }
    }

    /// Held components of every node; empty without holds.
    fn held(&self, holds: &[Hold], rim: &[u32]) -> Vec<u8> {
        if holds.is_empty() {
            return Vec::new();
        }
        let mut held = vec![0; self.nodes.len()];
        for hold in holds {
            let bits = (0..3).filter(|&d| hold.components[d]).fold(0, |bits, d| bits | 1 << d);
            self.set(hold.nodes).iter().for_each(|&n| held[n as usize] |= bits);
        }
        rim.iter().for_each(|&n| held[n as usize] = 0);
        held
    }

    /// Nodes of a set, ascending.
    fn set(&self, set: NodeSet) -> Vec<u32> {
        let [ni, nj, nk] = self.counts;
        let (direction, at) = match set {
            NodeSet::XMin => (0, 0),
            NodeSet::XMax => (0, ni),
            NodeSet::YMin => (1, 0),
            NodeSet::YMax => (1, nj),
            NodeSet::Inner | NodeSet::ZMin => (2, 0),
            NodeSet::Outer | NodeSet::ZMax => (2, nk),
            NodeSet::All => return (0..self.nodes.len() as u32).collect(),
        };
        let rows = if self.wrap { ni } else { ni + 1 };
        let mut nodes = Vec::new();
        for k in 0..=nk {
            for j in 0..=nj {
                for i in 0..rows {
                    if [i, j, k][direction] == at {
                        nodes.push(self.node(i, j, k));
                    }
                }
            }
        }
        nodes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(elements: [usize; 3], ratio: [f64; 3], fine_arc: f64) -> Mesh {
        let spec = MeshSpec::Ring { outer_radius: 2.0, inner_radius: 1.0, width: 0.5, elements };
        Mesh::graded(&spec, &Grading { ratio, fine_arc }, [0.0; 3], None, &[])
    }

    /// Angles from the bottom of the outermost row at y-min, ascending, in one turn.
    fn angles(mesh: &Mesh, around: usize) -> Vec<f64> {
        let first = mesh.nodes.len() - 2 * around;
        let angle = |n: &[f64; 3]| (-n[0]).atan2(2.0 - n[2]).rem_euclid(TAU);
        mesh.nodes[first..first + around].iter().map(angle).collect()
    }

    #[test]
    fn sizes_grow_by_the_ratio() {
        let spec = MeshSpec::Block { size: [1.0, 2.0, 3.0], elements: [40, 1, 8] };
        let mesh =
            Mesh::graded(&spec, &Grading { ratio: [4.0, 1.0, 0.5], fine_arc: 0.0 }, [0.0; 3], None, &[]);
        let x: Vec<f64> = (0..=40).map(|i| mesh.nodes[i][0]).collect();
        let sizes: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
        for pair in sizes.windows(2) {
            assert!((pair[1] / pair[0] - 4.0f64.powf(1.0 / 40.0)).abs() < 1e-12, "geometric");
        }
        assert!((x[40] - 1.0).abs() < 1e-15 && x[0] == 0.0);
    }

    #[test]
    fn a_mesh_of_half_as_many_elements_has_every_other_node() {
        let spec = |elements| MeshSpec::Block { size: [1.0; 3], elements };
        let grading = Grading { ratio: [7.0, 0.3, 2.0], fine_arc: 0.0 };
        let [fine, coarse] =
            [[8, 4, 6], [4, 2, 3]].map(|e| Mesh::graded(&spec(e), &grading, [0.0; 3], None, &[]));
        for x in &coarse.nodes {
            let near = |y: &[f64; 3]| (0..3).all(|d| (x[d] - y[d]).abs() < 1e-14);
            assert!(fine.nodes.iter().any(near), "{x:?}");
        }
        let [fine, coarse] = [96, 48].map(|n| angles(&ring([n, 1, 1], [9.0, 1.0, 1.0], 0.6), n));
        coarse.iter().zip(fine.iter().step_by(2)).for_each(|(a, b)| assert!((a - b).abs() < 1e-12));
    }

    #[test]
    fn a_ring_is_fine_within_its_arc_and_symmetric() {
        let (n, arc) = (90, 0.8);
        let angles = angles(&ring([n, 1, 1], [10.0, 1.0, 1.0], arc), n);
        let sizes: Vec<f64> = angles.windows(2).map(|w| w[1] - w[0]).collect();
        let fine: Vec<f64> = angles.windows(2).filter(|w| w[1] < 0.5 * arc).map(|w| w[1] - w[0]).collect();
        assert!(fine.len() > 5 && fine.iter().all(|s| (s / fine[0] - 1.0).abs() < 1e-9));
        // The element at the top is nearly ten times as long: it ends half an element's growth before the top.
        assert!((8.5..10.1).contains(&(sizes[n / 2 - 1] / fine[0])), "{}", sizes[n / 2 - 1] / fine[0]);
        for i in 1..n {
            assert!((angles[i] + angles[n - i] - TAU).abs() < 1e-12, "left is right");
        }
        let largest = sizes.windows(2).map(|w| (w[1] / w[0]).max(w[0] / w[1])).fold(0.0, f64::max);
        assert!(largest < 1.12, "no jump: {largest}");
    }

    #[test]
    fn rim_nodes_have_no_held_components() {
        let spec = MeshSpec::Block { size: [1.0; 3], elements: [2; 3] };
        let hold = Hold { nodes: NodeSet::All, components: [false, true, false] };
        let both = Hold { nodes: NodeSet::XMin, components: [true, false, false] };
        let mesh = Mesh::graded(&spec, &Grading::default(), [0.0; 3], Some(NodeSet::ZMax), &[hold, both]);
        for (n, x) in mesh.nodes.iter().enumerate() {
            let expected = if x[2] == 1.0 { 0 } else { 2 | u8::from(x[0] == 0.0) };
            assert_eq!(mesh.held[n], expected, "{x:?}");
        }
        assert!(Mesh::generate(&spec, [0.0; 3], None).held.is_empty());
    }
}

//! Eight-node hexahedral meshes: generators, node sets by construction, boundary facets.
//!
//! Corner numbering of an element (xi, eta, zeta = -1 or +1):
//!
//! ```text
//!        7--------6        corner a: xi   = + for 1 2 5 6
//!       /|       /|                  eta  = + for 2 3 6 7
//!      4--------5 |                  zeta = + for 4 5 6 7
//!      | 3------|-2
//!      |/       |/         zeta eta
//!      0--------1             |/_ xi
//! ```

use crate::scene::{MeshSpec, NodeSet};

/// Corners of the six faces, counter-clockwise seen from outside.
pub const FACES: [[usize; 4]; 6] =
    [[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1], [4, 5, 6, 7]];

/// Signs of (xi, eta, zeta) at the eight corners.
pub const SIGNS: [[f64; 3]; 8] = [
    [-1., -1., -1.],
    [1., -1., -1.],
    [1., 1., -1.],
    [-1., 1., -1.],
    [-1., -1., 1.],
    [1., -1., 1.],
    [1., 1., 1.],
    [-1., 1., 1.],
];

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
}

impl Mesh {
    /// Builds the mesh a scene describes, translated by `offset`.
    pub fn generate(spec: &MeshSpec, offset: [f64; 3], rim: Option<NodeSet>) -> Mesh {
        let (grid, axle) = match *spec {
            MeshSpec::Ring { outer_radius, inner_radius, width, elements } => {
                (ring(outer_radius, inner_radius, width, elements), [0.0, 0.0, outer_radius])
            }
            MeshSpec::Block { size, elements } => (block(size, elements), size.map(|s| 0.5 * s)),
        };
        grid.into_mesh(offset, axle, rim)
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
fn ring(outer: f64, inner: f64, width: f64, [nc, nr, nw]: [usize; 3]) -> Grid {
    let mut nodes = Vec::with_capacity(nc * (nr + 1) * (nw + 1));
    for k in 0..=nr {
        let radius = inner + (outer - inner) * k as f64 / nr as f64;
        for j in 0..=nw {
            let y = width * (j as f64 / nw as f64 - 0.5);
            for i in 0..nc {
                // Node 0 at the bottom, then towards -x: a turn about +y.
                let (sin, cos) = (std::f64::consts::TAU * i as f64 / nc as f64).sin_cos();
                nodes.push([-radius * sin, y, outer - radius * cos]);
            }
        }
    }
    Grid { counts: [nc, nw, nr], wrap: true, nodes }
}

fn block(size: [f64; 3], counts: [usize; 3]) -> Grid {
    let [nx, ny, nz] = counts;
    let mut nodes = Vec::with_capacity((nx + 1) * (ny + 1) * (nz + 1));
    for k in 0..=nz {
        for j in 0..=ny {
            for i in 0..=nx {
                let at = |c: usize, n: usize, s: f64| s * c as f64 / n as f64;
                nodes.push([at(i, nx, size[0]), at(j, ny, size[1]), at(k, nz, size[2])]);
            }
        }
    }
    Grid { counts, wrap: false, nodes }
}

impl Grid {
    /// Index of logical node (i, j, k): i fastest, then j, then k.
    fn node(&self, i: usize, j: usize, k: usize) -> u32 {
        let [ni, nj, _] = self.counts;
        let row = if self.wrap { ni } else { ni + 1 };
        ((k * (nj + 1) + j) * row + i % row) as u32
    }

    fn into_mesh(self, offset: [f64; 3], axle: [f64; 3], rim: Option<NodeSet>) -> Mesh {
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
        let shift = |p: [f64; 3]| std::array::from_fn(|d| p[d] + offset[d]);
        Mesh {
            nodes: self.nodes.iter().map(|&p| shift(p)).collect(),
            hexes,
            facets,
            rim: rim_nodes,
            axle: shift(axle),
            surface,
        }
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
            NodeSet::ZMax => (2, nk),
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

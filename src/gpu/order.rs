//! Numbers of nodes and elements on the device: a lattice's where the mesh is one under other names, else such that
//! neighbours stand near each other.

use super::lattice::Lattice;
use crate::model::Model;
use crate::model::chains::{BACK, FRONT, chains};
use crate::model::mesh::Mesh;
use std::borrow::Cow;
use std::collections::HashMap;

/// A model as the device numbers it.
pub struct Ordered<'m> {
    pub model: Cow<'m, Model>,
    /// Of each of the device's nodes and elements, its number in the model as given; `None`: the same.
    pub order: Option<Order>,
}

/// Old numbers by new ones.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Order {
    pub nodes: Vec<u32>,
    pub elements: Vec<u32>,
}

impl Order {
    /// What stands by node in the model's order, in the device's.
    pub fn to_device<T: Copy>(&self, by_node: &[T]) -> Vec<T> {
        self.nodes.iter().map(|&n| by_node[n as usize]).collect()
    }

    /// The reverse.
    pub fn to_model<T: Copy + Default>(&self, by_node: &[T]) -> Vec<T> {
        let mut all = vec![T::default(); by_node.len()];
        self.nodes.iter().zip(by_node).for_each(|(&n, value)| all[n as usize] = *value);
        all
    }

    /// The model with new numbers. Lists of rim and surface nodes keep their order.
    fn apply(&self, model: &Model) -> Model {
        let mut new = vec![0; self.nodes.len()];
        self.nodes.iter().enumerate().for_each(|(to, &from)| new[from as usize] = to as u32);
        let renamed = |n: &u32| new[*n as usize];
        let old = &model.mesh;
        let mesh = Mesh {
            nodes: self.to_device(&old.nodes),
            hexes: self.elements.iter().map(|&e| old.hexes[e as usize].map(|n| renamed(&n))).collect(),
            facets: old.facets.iter().map(|f| f.map(|n| renamed(&n))).collect(),
            rim: old.rim.iter().map(renamed).collect(),
            axle: old.axle,
            surface: old.surface.iter().map(renamed).collect(),
            held: if old.held.is_empty() { Vec::new() } else { self.to_device(&old.held) },
            // Nobody on the device's side asks for names.
            ..Mesh::default()
        };
        Model {
            mesh,
            mass: self.to_device(&model.mass),
            class_of: self.elements.iter().map(|&e| model.class_of[e as usize]).collect(),
            // Nobody on the device's side asks for them.
            corner_start: Vec::new(),
            corners: Vec::new(),
            ..model.clone()
        }
    }
}

/// The model in the device's numbers.
pub fn ordered(model: &Model) -> Ordered<'_> {
    if Lattice::of(&model.mesh).is_some() {
        return Ordered { model: Cow::Borrowed(model), order: None };
    }
    let order = lattice_order(&model.mesh).unwrap_or_else(|| near_order(&model.mesh));
    Ordered { model: Cow::Owned(order.apply(model)), order: Some(order) }
}

/// Corners of the faces towards smaller and larger eta, and zeta, as [`BACK`] and [`FRONT`] are for xi.
const FACES: [[[usize; 4]; 2]; 3] =
    [[BACK, FRONT], [[0, 1, 4, 5], [3, 2, 7, 6]], [[0, 1, 2, 3], [4, 5, 6, 7]]];

/// The neighbour of each element in one direction, upwards and downwards.
fn neighbours(hexes: &[[u32; 8]], [low, high]: [[usize; 4]; 2]) -> [Vec<Option<u32>>; 2] {
    let by_low: HashMap<[u32; 4], u32> =
        hexes.iter().enumerate().map(|(e, hex)| (low.map(|c| hex[c]), e as u32)).collect();
    let up: Vec<Option<u32>> = hexes.iter().map(|h| by_low.get(&high.map(|c| h[c])).copied()).collect();
    let mut down = vec![None; hexes.len()];
    up.iter().enumerate().for_each(|(e, next)| {
        if let Some(next) = next {
            down[*next as usize] = Some(e as u32);
        }
    });
    [up, down]
}

/// Elements from `first` on, one step after the other, until there is none or it is `first` again.
fn line(first: u32, next: &[Option<u32>]) -> Vec<u32> {
    let mut all = vec![first];
    let mut at = next[first as usize];
    while let Some(e) = at.filter(|&e| e != first && all.len() <= next.len()) {
        all.push(e);
        at = next[e as usize];
    }
    all
}

/// The numbering that makes a lattice of the mesh, if its elements stand in one, corner by corner.
fn lattice_order(mesh: &Mesh) -> Option<Order> {
    let hexes = &mesh.hexes;
    let [along, across, up] = FACES.map(|faces| neighbours(hexes, faces));
    let end = |e: u32, down: &[Option<u32>]| *line(e, down).last().expect("it has the first");
    let first = end(end(end(0, &up[1]), &across[1]), &along[1]);
    let mut elements = Vec::with_capacity(hexes.len());
    for layer in line(first, &up[0]) {
        for row in line(layer, &across[0]) {
            elements.extend(line(row, &along[0]));
        }
    }
    if elements.len() != hexes.len() {
        return None;
    }
    let columns = line(first, &along[0]).len();
    let closed = along[1][first as usize].is_some();
    let (rows, tall) = (line(first, &across[0]).len(), line(first, &up[0]).len());
    let row = if closed { columns } else { columns + 1 };
    let mut nodes = vec![u32::MAX; row * (rows + 1) * (tall + 1)];
    for (e, &element) in elements.iter().enumerate() {
        let [i, j, k] = [e % columns, e / columns % rows, e / columns / rows];
        for (c, &n) in hexes[element as usize].iter().enumerate() {
            let [right, high, above] =
                [[1, 2, 5, 6], [2, 3, 6, 7], [4, 5, 6, 7]].map(|s| usize::from(s.contains(&c)));
            nodes[((k + above) * (rows + 1) + j + high) * row + (i + right) % row] = n;
        }
    }
    let order = Order { nodes, elements };
    order.is_whole(mesh).then_some(order)
}

impl Order {
    /// Whether every node and element is there once, and the mesh is a lattice in this order.
    fn is_whole(&self, mesh: &Mesh) -> bool {
        let once = |all: &[u32], count: usize| {
            let mut met = vec![false; count];
            all.len() == count
                && all.iter().all(|&n| met.get_mut(n as usize).is_some_and(|m| !std::mem::replace(m, true)))
        };
        if !once(&self.nodes, mesh.nodes.len()) || !once(&self.elements, mesh.hexes.len()) {
            return false;
        }
        let mut new = vec![0; self.nodes.len()];
        self.nodes.iter().enumerate().for_each(|(to, &from)| new[from as usize] = to as u32);
        let hexes = self.elements.iter().map(|&e| mesh.hexes[e as usize].map(|n| new[n as usize])).collect();
        let bare = Mesh { hexes, ..mesh.clone() };
        Lattice::of(&bare).is_some()
    }
}

/// Rows of elements that share nodes one after the other, and nodes as the rows meet them.
fn near_order(mesh: &Mesh) -> Order {
    let mut met = vec![false; mesh.nodes.len()];
    let mut order = Order { nodes: Vec::with_capacity(met.len()), elements: Vec::new() };
    for chain in chains(&mesh.hexes, mesh.nodes.len()) {
        for corner in 0..8 {
            for &e in &chain.elements {
                let n = mesh.hexes[e as usize][corner];
                if !std::mem::replace(&mut met[n as usize], true) {
                    order.nodes.push(n);
                }
            }
        }
        order.elements.extend(chain.elements);
    }
    // Nodes of no element, if there are any.
    order.nodes.extend((0..met.len() as u32).filter(|&n| !met[n as usize]));
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::shuffle::shuffled;
    use crate::scene::Scene;
    use std::path::Path;

    /// More rows than the finder of chains leaves in the order in which they come.
    fn ring() -> (Scene, Model) {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lat100_straight.toml");
        let scene = Scene::load(&file, &["body.mesh.elements=[11, 8, 9]".into()]).unwrap();
        let model = Model::new(&scene).unwrap();
        (scene, model)
    }

    #[test]
    fn a_generated_mesh_stays_as_it_is() {
        assert!(ordered(&ring().1).order.is_none());
    }

    /// Places, masses and shapes go with the numbers, and there and back is the same.
    #[test]
    fn a_shuffled_ring_is_a_lattice_again() {
        let (scene, model) = ring();
        let other = shuffled(&model, &scene.body);
        let found = ordered(&other);
        let order = found.order.unwrap();
        assert!(Lattice::of(&found.model.mesh).is_some());
        for (to, &from) in order.nodes.iter().enumerate() {
            assert_eq!(found.model.mesh.nodes[to], other.mesh.nodes[from as usize]);
            assert_eq!(found.model.mass[to], other.mass[from as usize]);
        }
        for (to, &from) in order.elements.iter().enumerate() {
            assert_eq!(found.model.class_of[to], other.class_of[from as usize]);
            let back = found.model.mesh.hexes[to].map(|n| order.nodes[n as usize]);
            assert_eq!(back, other.mesh.hexes[from as usize]);
        }
        for (new, old) in found.model.mesh.rim.iter().zip(&other.mesh.rim) {
            assert_eq!(order.nodes[*new as usize], *old);
        }
        assert_eq!(order.to_model(&order.to_device(&other.mass)), other.mass);
    }

    /// A ring that lacks an element is no lattice; everything is met once all the same.
    #[test]
    fn other_meshes_keep_neighbours_near() {
        let (scene, model) = ring();
        let mut other = shuffled(&model, &scene.body);
        other.mesh.hexes.pop();
        let order = near_order(&other.mesh);
        assert!(lattice_order(&other.mesh).is_none());
        for (all, count) in [(&order.nodes, other.node_count()), (&order.elements, other.mesh.hexes.len())] {
            let mut sorted = all.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..count as u32).collect::<Vec<u32>>());
        }
        // Within two diagonals of the 9 x 10 rows of 11 nodes, 220 of 990; at random 7/9 of all.
        let mut new = vec![0; order.nodes.len()];
        order.nodes.iter().enumerate().for_each(|(to, &from)| new[from as usize] = to as i64);
        let width = |h: &[u32; 8]| {
            let at = h.map(|n| new[n as usize]);
            at.iter().max().unwrap() - at.iter().min().unwrap()
        };
        let mean = other.mesh.hexes.iter().map(width).sum::<i64>() / other.mesh.hexes.len() as i64;
        assert!(mean < 330, "{mean}");
    }
}

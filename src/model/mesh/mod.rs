//! Eight-node hexahedral meshes: what everything after a generator takes, and all that it may ask of one.
//!
//! A mesh states its nodes, elements, boundary faces, named sets and axle. What follows from those is found when it is
//! asked for, and is an option where a mesh may not have it: its [`Lattice`], and the rows round its axle ([`Ring`]).
//! So a mesh that is read from a file, or renumbered, answers as one that was generated does.

use std::sync::Arc;

mod boundary;
mod driven;
mod faces;
mod generate;
pub mod import;
mod labels;
mod lattice;
pub mod quality;
mod ring;
mod sets;

pub use boundary::boundary;
pub use driven::Driven;
pub use labels::{Labels, Numbers};
pub use lattice::Lattice;
pub use ring::Ring;
pub use sets::{NamedNodes, NodeSets, UnknownSet};

pub use crate::physics::element::hex8::{FACES, SIGNS};

/// A mesh of hexahedra in its reference shape, and what the scene asks of its nodes.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// Reference positions [m], shape `[node_count]`.
    pub nodes: Vec<[f64; 3]>,
    /// Corner nodes, shape `[element_count]`.
    pub hexes: Vec<[u32; 8]>,
    /// Outer boundary quadrilaterals, counter-clockwise seen from outside, shape `[facet_count]`.
    pub facets: Vec<[u32; 4]>,
    /// Nodes by name.
    pub sets: NodeSets,
    /// The body's point that the rim turns about [m]; the axle is along y there.
    pub axle: [f64; 3],
    /// One line that says what the mesh is, for people.
    pub description: String,
    /// Rigid nodes, ascending (empty without a rim).
    pub rim: Vec<u32>,
    /// Nodes that can touch the road: boundary nodes that are not rim nodes, ascending.
    pub surface: Vec<u32>,
    /// Numbers that a file gives to nodes and elements; none of a generated mesh.
    pub labels: Option<Arc<Labels>>,
    /// What a user must know of the file that the mesh is from.
    pub notes: Vec<String>,
    /// Held components of each node, bit d for component d; empty where nothing is held. Rim nodes have none.
    pub held: Vec<u8>,
    /// Sets whose components follow a motion (those are held too), and sets at rest whose reaction is recorded.
    pub driven: Vec<Driven>,
}

/// See [`Mesh::element_name`].
pub fn element_name(labels: Option<&Labels>, element: usize) -> String {
    labels.map_or_else(|| element.to_string(), |labels| labels.elements.text(element))
}

impl Mesh {
    /// Translated by `offset` [m].
    pub fn moved(mut self, offset: [f64; 3]) -> Mesh {
        let shift = |p: &mut [f64; 3]| (0..3).for_each(|d| p[d] += offset[d]);
        self.nodes.iter_mut().for_each(shift);
        shift(&mut self.axle);
        self
    }

    /// With the nodes of a set as the rim: no surface nodes any more, and nothing of them is held.
    ///
    /// # Errors
    /// [`UnknownSet`] where the mesh has no set of that name.
    pub fn with_rim(mut self, set: &str) -> Result<Mesh, UnknownSet> {
        self.rim = self.set(set)?;
        let rim = &self.rim;
        self.surface.retain(|n| rim.binary_search(n).is_err());
        if !self.held.is_empty() {
            rim.iter().for_each(|&n| self.held[n as usize] = 0);
        }
        Ok(self)
    }

    /// With components x, y, z of a set's nodes held, as far as they are not the rim's, besides those that are already.
    ///
    /// # Errors
    /// [`UnknownSet`] where the mesh has no set of that name.
    pub fn with_held(mut self, set: &str, components: [bool; 3]) -> Result<Mesh, UnknownSet> {
        let bits = (0..3).filter(|&d| components[d]).fold(0, |bits, d| bits | 1 << d);
        let nodes = self.set(set)?;
        self.held.resize(self.nodes.len(), 0);
        for n in nodes.into_iter().filter(|n| self.rim.binary_search(n).is_err()) {
            self.held[n as usize] |= bits;
        }
        Ok(self)
    }

    /// Nodes of a set, ascending; `all` has every node.
    ///
    /// # Errors
    /// [`UnknownSet`] where the mesh has no set of that name.
    pub fn set(&self, name: &str) -> Result<Vec<u32>, UnknownSet> {
        match self.sets.get(name) {
            Some(set) => Ok(set.nodes.clone()),
            None if name == sets::ALL => Ok((0..self.nodes.len() as u32).collect()),
            None => Err(UnknownSet { name: name.into(), known: self.sets.names() }),
        }
    }

    /// When every driven set has come to rest [s]; infinite where one never does.
    pub fn driven_end(&self) -> f64 {
        self.driven.iter().map(|set| set.motion.end()).fold(0.0, f64::max)
    }

    /// What people know an element by: its number in the file that the mesh is from, or its place.
    pub fn element_name(&self, element: usize) -> String {
        element_name(self.labels.as_deref(), element)
    }

    /// The lattice that nodes and elements are numbered by, if there is one.
    pub fn lattice(&self) -> Option<Lattice> {
        Lattice::of(&self.hexes, self.nodes.len())
    }

    /// Rows of nodes round the axle, if the outermost nodes stand in such rows.
    pub fn ring(&self) -> Option<Ring> {
        Ring::of(self)
    }

    /// Boundary nodes, ascending.
    fn boundary_nodes(facets: &[[u32; 4]]) -> Vec<u32> {
        let mut nodes: Vec<u32> = facets.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::MeshSpec;

    fn block() -> Mesh {
        Mesh::generate(&MeshSpec::Block { size: [1.0; 3], elements: [2; 3] })
    }

    #[test]
    fn rim_nodes_have_no_held_components() {
        let hold = |mesh: Mesh| {
            let mesh = mesh.with_held("all", [false, true, false]).unwrap();
            mesh.with_held("x-min", [true, false, false]).unwrap()
        };
        let rim = |mesh: Mesh| mesh.with_rim("z-max").unwrap();
        for mesh in [hold(rim(block())), rim(hold(block()))] {
            for (n, x) in mesh.nodes.iter().enumerate() {
                let expected = if x[2] == 1.0 { 0 } else { 2 | u8::from(x[0] == 0.0) };
                assert_eq!(mesh.held[n], expected, "{x:?}");
            }
        }
        assert!(block().held.is_empty());
    }

    #[test]
    fn rim_nodes_are_no_surface_nodes() {
        let mesh = block();
        assert_eq!(mesh.surface.len(), 26, "all but the middle one");
        let rimmed = mesh.with_rim("y-min").unwrap();
        assert_eq!((rimmed.rim.len(), rimmed.surface.len()), (9, 17));
        assert!(rimmed.rim.iter().all(|&n| rimmed.nodes[n as usize][1] == 0.0));
    }

    #[test]
    fn an_unknown_set_is_answered_with_those_there_are() {
        let UnknownSet { name, known } = block().with_rim("inner").unwrap_err();
        assert_eq!(name, "inner");
        assert_eq!(known, ["all", "x-min", "x-max", "y-min", "y-max", "z-min", "z-max"]);
    }
}

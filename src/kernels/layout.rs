//! What the passes read: items of elements, and lines of nodes, with the places of their numbers in memory. Made by
//! whoever lays out a body, constant afterwards.

use super::rows::Rows;
use super::state::{Aligned, Field};
use crate::physics::lanes::WIDEST;
use crate::physics::tensor::{Mat3, Vec3};

/// At most as many elements as there are lanes, with nothing in common.
#[derive(Debug, Clone)]
pub struct Loose {
    pub elements: Vec<u32>,
    /// Places of the corners among the nodes and the forces, by corner and lane; lanes beyond the last element repeat it.
    pub nodes: [[u32; WIDEST]; 8],
    pub f: [[u32; WIDEST]; 8],
    pub shape: u32,
}

/// What the element pass takes at a time.
#[derive(Debug, Clone)]
pub enum Item {
    Rows(Rows),
    Loose(Box<Loose>),
}

impl Item {
    pub fn elements(&self) -> &[u32] {
        match self {
            Item::Rows(rows) => &rows.elements,
            Item::Loose(loose) => &loose.elements,
        }
    }

    /// Places of the corners of its elements.
    pub fn corners(&self) -> Vec<[u32; 8]> {
        match self {
            Item::Rows(rows) => {
                rows.rows.iter().flat_map(|row| (0..row.count).map(|i| row.corners(i))).collect()
            }
            Item::Loose(loose) => {
                (0..loose.elements.len()).map(|lane| loose.nodes.map(|corner| corner[lane])).collect()
            }
        }
    }

    /// Entries of the table of shapes, by batch.
    pub fn shapes(&self) -> &[u32] {
        match self {
            Item::Rows(rows) => &rows.shapes,
            Item::Loose(loose) => std::slice::from_ref(&loose.shape),
        }
    }
}

/// What the lanes of a batch of nodes are, by bits.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct NodeBatch {
    pub rim: u32,
    /// Nodes that can touch the road.
    pub surface: u32,
    /// Held components: lanes by component.
    pub held: [u32; 3],
    /// Of a batch with rim or surface nodes: where its lanes begin in tables of such batches alone.
    pub boundary: u32,
    /// Of a batch with driven nodes: its number among those, plus one; 0: it has none.
    pub driven: u32,
}

/// Lanes of a batch whose nodes belong to a driven set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DrivenPart {
    /// Number of the set.
    pub set: u32,
    /// Its prescribed components: lanes by component.
    pub lanes: [u32; 3],
}

/// Where a driven set is at the end of a step, and how it got there: a node with the arm a is at `at` + `rotation` a, its mean
/// velocity is `velocity` + `rate` a. Matrices are their columns.
#[derive(Debug, Clone, Copy)]
pub struct DrivenPose<T> {
    pub at: Vec3<T>,
    pub rotation: Mat3<T>,
    pub velocity: Vec3<T>,
    pub rate: Mat3<T>,
}

/// Sets of nodes whose components follow a motion.
#[derive(Debug, Clone)]
pub struct Driven<T> {
    /// By batch, in the order of lines.
    pub batches: Vec<Vec<DrivenPart>>,
    /// Positions of the nodes from the point that their set turns about, by batch and lane (as many as the widest lanes).
    pub arms: Field<T>,
    /// Poses of all sets step by step, from the step [`crate::Conditions::driven`] counts from.
    pub poses: Vec<DrivenPose<T>>,
}

/// Consecutive nodes.
#[derive(Debug, Clone)]
pub struct Line {
    pub start: usize,
    pub nodes: Vec<u32>,
    pub closed: bool,
    pub batches: Vec<NodeBatch>,
    /// Its copies among the forces, by ascending group.
    pub slots: Vec<usize>,
    /// Numbers of it in an array by place, and of one of its slots.
    pub length: usize,
    /// Forces come lane by lane: the slots must be zero before a step.
    pub loose: bool,
    pub has_rim: bool,
    /// Whether some nodes belong to a driven set.
    pub driven: bool,
    /// Whether all of its nodes are free of rim and holds.
    pub plain: bool,
    /// Its number among the lines that can touch the road.
    pub surface: Option<usize>,
}

/// Constant data of the node pass.
pub struct Nodes<T> {
    pub lines: Vec<Line>,
    /// By place.
    pub mass: Aligned<T>,
    pub inverse_mass: Aligned<T>,
    /// Number among the surface nodes; this and the arms by [`NodeBatch::boundary`] and lane.
    pub surface_of: Vec<u32>,
    /// Rim nodes' positions relative to the axle in the reference orientation; zero for others.
    pub rim_arms: Field<T>,
    /// One over the area of each surface node [1/m2], as of the last sample; empty unless friction looks at pressure.
    pub inverse_area: Vec<T>,
    pub driven: Driven<T>,
}

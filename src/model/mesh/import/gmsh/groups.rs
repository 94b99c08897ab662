//! What the sections of a file say, until all are read; physical groups as node sets.

use std::collections::BTreeMap;

use super::super::ids::Ids;
use super::super::raw::{Raw, RawSet};
use super::super::source::Place;
use super::stream::Stream;
use crate::error::Result;
use crate::model::mesh::{Labels, Numbers};

/// Dimension and tag of a group.
pub type Group = (u8, u64);

/// Nodes, elements and groups.
pub struct Collected<'a> {
    drop: &'a [String],
    /// Whether a section is wanted, of quadrangles; else hexahedra.
    section: bool,
    pub node_tags: Vec<u64>,
    pub nodes: Vec<[f64; 3]>,
    pub element_tags: Vec<u64>,
    /// Corners by tag.
    pub hexes: Vec<[u64; 8]>,
    pub quads: Vec<[u64; 4]>,
    names: BTreeMap<Group, String>,
    /// Groups of an entity (version 4).
    pub entities: BTreeMap<(u8, i64), Vec<u64>>,
    /// Nodes by group, in the order in which elements name them.
    members: BTreeMap<Group, Vec<u64>>,
    /// Elements of the body's dimension that are not wanted, by name.
    others: BTreeMap<&'static str, usize>,
    dropped: BTreeMap<&'static str, usize>,
}

/// An element type: name, dimension, nodes.
#[derive(Debug, Clone, Copy)]
pub struct Kind {
    pub name: &'static str,
    pub dimension: u8,
    pub nodes: usize,
}

const HEXAHEDRON: u64 = 5;

/// Element types by number.
const KINDS: [(u64, Kind); 19] = [
    (15, Kind { name: "point", dimension: 0, nodes: 1 }),
    (1, Kind { name: "line", dimension: 1, nodes: 2 }),
    (8, Kind { name: "line of 3 nodes", dimension: 1, nodes: 3 }),
    (2, Kind { name: "triangle", dimension: 2, nodes: 3 }),
    (9, Kind { name: "triangle of 6 nodes", dimension: 2, nodes: 6 }),
    (3, Kind { name: "quadrangle", dimension: 2, nodes: 4 }),
    (10, Kind { name: "quadrangle of 9 nodes", dimension: 2, nodes: 9 }),
    (16, Kind { name: "quadrangle of 8 nodes", dimension: 2, nodes: 8 }),
    (4, Kind { name: "tetrahedron", dimension: 3, nodes: 4 }),
    (11, Kind { name: "tetrahedron of 10 nodes", dimension: 3, nodes: 10 }),
    (HEXAHEDRON, Kind { name: "hexahedron", dimension: 3, nodes: 8 }),
    (12, Kind { name: "hexahedron of 27 nodes", dimension: 3, nodes: 27 }),
    (17, Kind { name: "hexahedron of 20 nodes", dimension: 3, nodes: 20 }),
    (6, Kind { name: "prism", dimension: 3, nodes: 6 }),
    (13, Kind { name: "prism of 18 nodes", dimension: 3, nodes: 18 }),
    (18, Kind { name: "prism of 15 nodes", dimension: 3, nodes: 15 }),
    (7, Kind { name: "pyramid", dimension: 3, nodes: 5 }),
    (14, Kind { name: "pyramid of 14 nodes", dimension: 3, nodes: 14 }),
    (19, Kind { name: "pyramid of 13 nodes", dimension: 3, nodes: 13 }),
];

/// The type of a number.
pub fn kind(stream: &Stream, number: u64) -> Result<Kind> {
    let found = KINDS.iter().find(|k| k.0 == number).map(|k| k.1);
    found.ok_or_else(|| {
        let problem = format!("elements of type {number}, which is not read");
        stream.error(problem, "mesh with hexahedra of eight nodes (Gmsh: Mesh.ElementOrder = 1)")
    })
}

/// `$PhysicalNames`: `dimension tag "name"`; text in binary files too.
pub fn names(stream: &mut Stream, collected: &mut Collected) -> Result<()> {
    let bad = |stream: &Stream, line: &str| stream.damaged(format!("{line:?} is no dimension, tag and name"));
    let line = stream.text_line()?;
    let count: usize = line.trim().parse().map_err(|_| stream.damaged(format!("{line:?} is not a count")))?;
    for _ in 0..count {
        let line = stream.text_line()?;
        let mut parts = line.splitn(3, char::is_whitespace);
        let mut number = || parts.next().and_then(|p| p.trim().parse::<u64>().ok());
        let (Some(dimension @ 0..=3), Some(tag)) = (number(), number()) else {
            return Err(bad(stream, &line));
        };
        let name = parts.next().unwrap_or_default().trim().trim_matches('"');
        collected.names.insert((dimension as u8, tag), name.into());
    }
    Ok(())
}

impl<'a> Collected<'a> {
    pub fn new(drop: &'a [String], section: bool) -> Self {
        let (node_tags, nodes, element_tags, hexes, quads) = Default::default();
        let (names, entities, members, others, dropped) = Default::default();
        Collected {
            drop,
            section,
            node_tags,
            nodes,
            element_tags,
            hexes,
            quads,
            names,
            entities,
            members,
            others,
            dropped,
        }
    }

    /// Takes an element of a kind: its nodes go to its groups, and a hexahedron to the body.
    pub fn element(&mut self, kind: Kind, tag: u64, nodes: &[u64], groups: &[u64]) {
        let of_body = if self.section { kind.dimension >= 2 } else { kind.dimension == 3 };
        let wanted = if self.section { (2, 4) } else { (3, 8) };
        if of_body && (kind.dimension, kind.nodes) != wanted {
            let left_out = self.drop.iter().any(|d| d.eq_ignore_ascii_case(kind.name));
            let counts = if left_out { &mut self.dropped } else { &mut self.others };
            *counts.entry(kind.name).or_default() += 1;
            return;
        }
        for &group in groups.iter().filter(|&&g| g != 0) {
            self.members.entry((kind.dimension, group)).or_default().extend_from_slice(nodes);
        }
        if !of_body {
            return;
        }
        self.element_tags.push(tag);
        match (<[u64; 8]>::try_from(nodes), <[u64; 4]>::try_from(nodes)) {
            (Ok(corners), _) => self.hexes.push(corners),
            (_, Ok(corners)) => self.quads.push(corners),
            _ => {}
        }
    }

    pub fn into_raw(self, file: &Place, format: &str) -> Result<Raw> {
        let file = Place { line: None, ..file.clone() };
        self.only_hexahedra(&file)?;
        let ids = Ids::new(&self.node_tags).map_err(|[a, _]| {
            let problem = format!("node {} is there twice", self.node_tags[a]);
            file.error("$Nodes", problem, "give every node a tag of its own")
        })?;
        if let Err([a, _]) = Ids::new(&self.element_tags) {
            let problem = format!("element {} is there twice", self.element_tags[a]);
            return Err(file.error("$Elements", problem, "give every element a tag of its own"));
        }
        let place = |tag: u64, what: &dyn Fn() -> String| {
            ids.get(tag).ok_or_else(|| {
                let problem = format!("{} has the node {tag}, which is not there", what());
                file.error("$Elements", problem, "the file is damaged: write it again")
            })
        };
        let mut hexes = Vec::with_capacity(self.hexes.len());
        for (corners, tag) in self.hexes.iter().zip(&self.element_tags) {
            let mut hex = [0; 8];
            for (corner, &node) in hex.iter_mut().zip(corners) {
                *corner = place(node, &|| format!("element {tag}"))?;
            }
            hexes.push(hex);
        }
        let mut quads = Vec::with_capacity(self.quads.len());
        for (corners, tag) in self.quads.iter().zip(&self.element_tags) {
            let mut quad = [0; 4];
            for (corner, &node) in quad.iter_mut().zip(corners) {
                *corner = place(node, &|| format!("element {tag}"))?;
            }
            quads.push(quad);
        }
        let mut sets = Vec::new();
        for (&(dimension, tag), members) in &self.members {
            let what = ["points", "curves", "surfaces", "volumes"][usize::from(dimension)];
            let named = self.names.get(&(dimension, tag)).filter(|n| !n.is_empty());
            let name = named.cloned().unwrap_or_else(|| format!("physical-{dimension}-{tag}"));
            let mut nodes = members
                .iter()
                .map(|&n| place(n, &|| format!("the group {name:?}")))
                .collect::<Result<Vec<u32>>>()?;
            nodes.sort_unstable();
            nodes.dedup();
            let taken = sets.iter().any(|s: &RawSet| s.name == name);
            let name = if taken { format!("{name}.{what}") } else { name };
            sets.push(RawSet { meaning: format!("{what} of the physical group {name}"), name, nodes });
        }
        let labels = Labels {
            nodes: Numbers { of: self.node_tags, parts: Vec::new() },
            elements: Numbers { of: self.element_tags, parts: Vec::new() },
            hash: String::new(),
        };
        let left_out = self
            .dropped
            .iter()
            .map(|(name, n)| format!("{n} elements of type {name:?} are left out (body.mesh.drop)"));
        let notes = left_out.collect();
        Ok(Raw { nodes: self.nodes, hexes, quads, axle: None, labels, sets, notes, format: format.into() })
    }

    fn only_hexahedra(&self, file: &Place) -> Result<()> {
        if !self.others.is_empty() {
            let list: Vec<String> =
                self.others.iter().map(|(name, n)| format!("{n} of type {name:?}")).collect();
            let kind = if self.section { "quadrangles of a section" } else { "hexahedra of eight nodes" };
            let problem = format!("elements that are no {kind}: {}", list.join(", "));
            let remedy = "mesh with hexahedra of eight nodes alone (Gmsh: transfinite volumes, Recombine, Mesh.ElementOrder = 1)";
            return Err(file.error("$Elements", problem, remedy));
        }
        match self.hexes.is_empty() && self.quads.is_empty() {
            true if self.section => Err(file.error(
                "$Elements",
                "there are no quadrangles in this file",
                "mesh the section with quadrangles of four nodes (Gmsh: Recombine), or leave revolve out",
            )),
            true => Err(file.error(
                "$Elements",
                "there are no hexahedra in this file",
                "mesh the volume with hexahedra; with physical groups Gmsh saves only those, unless Mesh.SaveAll = 1",
            )),
            false => Ok(()),
        }
    }
}

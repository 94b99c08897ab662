//! Sets of a deck as nodes: ranges, sets of sets, elements and faces.

use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use super::super::raw::RawSet;
use super::super::source::Place;
use super::assembly::{Body, shared};
use super::deck::ELEMENTS_OF;
use super::parts::{Member, Members, Surface};
use crate::error::{Error, Result};
use crate::model::mesh::faces::{Faces, OUTER};

/// Sets in sets in sets: deeper than anybody nests them.
const DEEPEST: usize = 100;

/// What a set is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Nodes,
    Elements,
}

/// A set by its kind, the body it is defined in, and its name in capitals.
type Key = (Kind, usize, Rc<str>);

/// The sets of a deck.
pub struct Sets<'a> {
    bodies: &'a [Body<'a>],
    hexes: &'a [[u32; 8]],
    /// Nodes of the elements that are no hexahedra, which are numbered on from those.
    others: &'a [Vec<u32>],
    file: &'a Place,
    faces: OnceCell<Faces>,
    /// Members that all sets may have together: those of a hostile deck multiply.
    most: usize,
    found: BTreeMap<Key, Rc<[u32]>>,
    stored: usize,
    /// Sets that are being looked up: one that leads to itself is in here.
    open: Vec<Key>,
}

/// Corners of the faces S1 to S6 (Abaqus' "Three-dimensional solid element library").
const SIDES: [[usize; 4]; 6] =
    [[0, 1, 2, 3], [4, 7, 6, 5], [0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0]];
/// The same faces among [`FACES`](crate::model::mesh::FACES).
const AS_FACE: [u32; 6] = [4, 5, 2, 1, 3, 0];

impl<'a> Sets<'a> {
    pub fn new(
        bodies: &'a [Body<'a>],
        hexes: &'a [[u32; 8]],
        others: &'a [Vec<u32>],
        file: &'a Place,
    ) -> Self {
        let nodes: usize = bodies.iter().flat_map(|b| &b.parts).map(|p| p.nodes.len()).sum();
        let most = 64 * (nodes + hexes.len()) + 100_000;
        let (faces, found) = (OnceCell::new(), BTreeMap::new());
        Sets { bodies, hexes, others, file, faces, most, found, stored: 0, open: Vec::new() }
    }

    /// All of them as nodes: sets of nodes, of elements, surfaces. Those of a part have the plain name where it is the only one.
    pub fn all(mut self) -> Result<Vec<RawSet>> {
        let bodies = self.bodies;
        let mut all: Vec<RawSet> = Vec::new();
        let mut taken: BTreeMap<String, usize> = BTreeMap::new();
        let mut list = Vec::new();
        for (b, body) in bodies.iter().enumerate() {
            let sets = |of: Kind| {
                let names = body.parts.iter().flat_map(move |p| match of {
                    Kind::Nodes => &p.node_sets.list,
                    Kind::Elements => &p.element_sets.list,
                });
                names.map(|s| s.name.as_str())
            };
            let mut seen = BTreeSet::new();
            for (kind, name) in sets(Kind::Nodes)
                .map(|n| (Kind::Nodes, n))
                .chain(sets(Kind::Elements).map(|n| (Kind::Elements, n)))
            {
                if seen.insert((kind, name.to_uppercase())) {
                    let nodes = self.nodes_of_set(kind, b, name)?;
                    let what = if kind == Kind::Nodes { "node set" } else { "nodes of the element set" };
                    list.push((b, name, kind == Kind::Elements, what, nodes));
                }
            }
            for surface in body.parts.iter().flat_map(|p| &p.surfaces) {
                let nodes = self.surface(b, surface)?;
                self.store(nodes.len())?;
                list.push((b, surface.name.as_str(), true, "nodes of the surface", nodes));
            }
        }
        for (b, name, _, _, _) in &list {
            // The same set of a part and of what stands outside of it counts twice.
            *taken.entry(name.to_uppercase()).or_default() += usize::from(*b > 0);
        }
        let mut used: BTreeMap<String, usize> = BTreeMap::new();
        for (b, name, derived, what, nodes) in list {
            let same = used.get(&name.to_uppercase()).is_some_and(|&s| all[s].nodes == nodes);
            if derived && same {
                continue;
            }
            let of_body = format!("{}.{name}", bodies[b].name);
            let alone = b == 0 || taken[&name.to_uppercase()] == 1;
            let mut full = if alone { name.to_string() } else { of_body.clone() };
            if b > 0 && used.contains_key(&full.to_uppercase()) {
                full = of_body;
            }
            if derived && used.contains_key(&full.to_uppercase()) {
                full += if what == "nodes of the surface" { ".surface" } else { ".elements" };
            }
            used.insert(full.to_uppercase(), all.len());
            all.push(RawSet { meaning: format!("{what} {name}"), name: full, nodes });
        }
        Ok(all)
    }

    fn nodes_of_set(&mut self, kind: Kind, body: usize, name: &str) -> Result<Vec<u32>> {
        let members = self.set((kind, body, shared(name)))?;
        Ok(match kind {
            Kind::Nodes => members.to_vec(),
            Kind::Elements => sorted(members.iter().flat_map(|&e| self.corners(e).iter().copied()).collect()),
        })
    }

    /// Nodes of an element, hexahedron or not.
    fn corners(&self, element: u32) -> &'a [u32] {
        let (hexes, others) = (self.hexes, self.others);
        hexes
            .get(element as usize)
            .map_or_else(|| &others[element as usize - hexes.len()][..], |hex| &hex[..])
    }

    /// Members of a set by place, ascending.
    fn set(&mut self, key: Key) -> Result<Rc<[u32]>> {
        if let Some(known) = self.found.get(&key) {
            return Ok(known.clone());
        }
        let bodies = self.bodies;
        let (kind, b, name) = &key;
        let of_body = bodies[*b].parts.iter().filter_map(|p| match kind {
            Kind::Nodes => p.node_sets.get(name),
            Kind::Elements => p.element_sets.get(name),
        });
        let members: Vec<&Member> = of_body.flat_map(|s| &s.members).collect();
        self.open.push(key.clone());
        let (mut all, mut names) = (Vec::new(), BTreeSet::new());
        for member in members {
            if let Members::Name(name) = &member.what
                && !names.insert((name, member.at.instance.clone()))
            {
                continue;
            }
            self.member(*kind, *b, member, &mut all)?;
        }
        self.open.pop();
        let all: Rc<[u32]> = sorted(all).into();
        self.store(all.len())?;
        self.found.insert(key, all.clone());
        Ok(all)
    }

    /// Counts members that are kept.
    fn store(&mut self, members: usize) -> Result<()> {
        self.stored += members;
        if self.stored <= self.most {
            return Ok(());
        }
        let problem = format!("sets with more than {} members in all", self.most);
        Err(self.file.error("set", problem, "remove sets that are not needed"))
    }

    /// Adds what a member stands for.
    fn member(&mut self, kind: Kind, body: usize, member: &Member, all: &mut Vec<u32>) -> Result<()> {
        let body = match &member.at.instance {
            Some(name) => {
                self.instance(name).ok_or_else(|| unknown(member, &format!("the instance {name:?}")))?
            }
            None => body,
        };
        match &member.what {
            Members::Range { ids, generated } => self.ids(kind, body, *ids, *generated, member, all),
            Members::Name(name) => {
                if let Some(elements) = name.strip_prefix(ELEMENTS_OF) {
                    let (b, name) = self
                        .named(Kind::Elements, body, elements)
                        .ok_or_else(|| unknown(member, elements))?;
                    self.check_open(&(Kind::Elements, b, shared(name)), member)?;
                    all.extend(self.nodes_of_set(Kind::Elements, b, name)?);
                    return Ok(());
                }
                if let Some((b, name)) = self.named(kind, body, name) {
                    let key = (kind, b, shared(name));
                    self.check_open(&key, member)?;
                    all.extend(self.set(key)?.iter());
                    return Ok(());
                }
                // INSTANCE.17
                let id = name
                    .rsplit_once('.')
                    .and_then(|(i, id)| Some((self.instance(i)?, id.trim().parse().ok()?)));
                let (b, id) = id.ok_or_else(|| unknown(member, &format!("the set {name:?}")))?;
                self.ids(kind, b, [id, id, 1], false, member, all)
            }
        }
    }

    fn check_open(&self, key: &Key, member: &Member) -> Result<()> {
        let place = member.at.place();
        if self.open.contains(key) {
            return Err(place.error(
                "set",
                format!("the set {:?} has itself as a member", &*key.2),
                "remove it from its own members",
            ));
        }
        if self.open.len() >= DEEPEST {
            return Err(place.error(
                "set",
                format!("sets in one another more than {DEEPEST} deep"),
                "name the members themselves",
            ));
        }
        Ok(())
    }

    fn instance(&self, name: &str) -> Option<usize> {
        self.bodies.iter().position(|b| !b.name.is_empty() && b.name.eq_ignore_ascii_case(name))
    }

    /// Whose set a name is: of the body itself, or `INSTANCE.SET`.
    fn named<'b>(&self, kind: Kind, body: usize, name: &'b str) -> Option<(usize, &'b str)> {
        let has = |b: usize, name: &str| {
            self.bodies[b].parts.iter().any(|p| match kind {
                Kind::Nodes => p.node_sets.get(name).is_some(),
                Kind::Elements => p.element_sets.get(name).is_some(),
            })
        };
        if has(body, name) {
            return Some((body, name));
        }
        let (instance, rest) = name.split_once('.')?;
        let b = self.instance(instance)?;
        has(b, rest).then_some((b, rest))
    }

    fn ids(
        &self,
        kind: Kind,
        body: usize,
        ids: [u64; 3],
        generated: bool,
        member: &Member,
        all: &mut Vec<u32>,
    ) -> Result<()> {
        let body = &self.bodies[body];
        let (known, first) = match kind {
            Kind::Nodes => (&body.nodes, body.first[0]),
            Kind::Elements => (&body.elements, body.first[1]),
        };
        let before = all.len();
        all.extend(known.range(ids).iter().map(|p| first + p));
        if kind == Kind::Elements {
            let first = self.hexes.len() as u32 + body.first[2];
            all.extend(body.others.range(ids).iter().map(|p| first + p));
        }
        let wanted = (ids[1] - ids[0]) / ids[2].max(1) + 1;
        if !generated && ((all.len() - before) as u64) < wanted {
            let is_there = |id: u64| {
                known.get(id).is_some() || (kind == Kind::Elements && body.others.get(id).is_some())
            };
            if let Some(id) = (ids[0]..=ids[1]).find(|&id| !is_there(id)) {
                let what = if kind == Kind::Nodes { "node" } else { "element" };
                return Err(unknown(member, &format!("the {what} {id}")));
            }
        }
        Ok(())
    }

    /// Nodes of the faces of a surface, ascending.
    fn surface(&mut self, body: usize, surface: &Surface) -> Result<Vec<u32>> {
        let mut nodes = Vec::new();
        for (member, side) in &surface.faces {
            let mut elements = Vec::new();
            self.member(Kind::Elements, body, member, &mut elements)?;
            let hexes = self.hexes;
            let faces = self.faces.get_or_init(|| Faces::of(hexes));
            // A surface of elements that are no hexahedra is all of them.
            for e in elements {
                if e as usize >= hexes.len() {
                    nodes.extend(self.corners(e));
                    continue;
                }
                for s in 0..6 {
                    let free = || faces.other[6 * e as usize + AS_FACE[s] as usize] == OUTER;
                    if side.map_or_else(free, |side| usize::from(side) == s) {
                        nodes.extend(SIDES[s].map(|c| hexes[e as usize][c]));
                    }
                }
            }
            // Faces share nodes: what grows is put in order from time to time.
            if nodes.len() > 1 << 24 {
                nodes = sorted(nodes);
            }
        }
        for member in &surface.nodes {
            self.member(Kind::Nodes, body, member, &mut nodes)?;
        }
        Ok(sorted(nodes))
    }
}

fn sorted(mut list: Vec<u32>) -> Vec<u32> {
    list.sort_unstable();
    list.dedup();
    list
}

fn unknown(member: &Member, what: &str) -> Error {
    let remedy = "remove the name, or define what it stands for: is a part of the file missing?";
    member.at.place().error("set", format!("{what} is not there"), remedy)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::mesh::FACES;

    /// A face by Abaqus' number has the nodes of the face that it is taken for.
    #[test]
    fn sides_are_faces() {
        for (side, face) in SIDES.iter().zip(AS_FACE) {
            assert_eq!(BTreeSet::from(*side), BTreeSet::from(FACES[face as usize]));
        }
    }
}

//! What a deck says, before it is put together: parts with nodes, elements and sets, and where they stand.

use std::collections::HashMap;
use std::path::Path;
use std::rc::Rc;

use super::super::source::Place;

/// What counts its nodes and elements from one: a part, an instance's own, or a whole deck without parts.
#[derive(Debug, Default)]
pub struct Part {
    pub name: String,
    pub node_ids: Vec<u64>,
    pub nodes: Vec<[f64; 3]>,
    pub element_ids: Vec<u64>,
    /// Corners by node id.
    pub hexes: Vec<[u64; 8]>,
    /// Elements that are no hexahedra, for the sets that name them: number, and the first of its nodes.
    pub others: Vec<(u64, Corners)>,
    /// Those of them that make up a section, by place.
    pub section: Vec<usize>,
    pub node_sets: Sets,
    pub element_sets: Sets,
    pub surfaces: Vec<Surface>,
}

/// Up to eight nodes of an element, by id.
pub type Corners = [Option<u64>; 8];

/// A part that stands somewhere.
#[derive(Debug)]
pub struct Instance {
    pub name: String,
    /// The part, by place; none: it has its own nodes and elements.
    pub part: Option<usize>,
    /// What the instance adds to its part, or is made of.
    pub own: Part,
    pub translation: [f64; 3],
    /// Two points of the axis, and the angle about it [rad].
    pub rotation: Option<([[f64; 3]; 2], f64)>,
    pub place: Place,
}

/// A set as it is defined, maybe in several places.
#[derive(Debug)]
pub struct Set {
    /// As first written.
    pub name: String,
    pub members: Vec<Member>,
}

/// A line of a set, or a part of one.
#[derive(Debug, Clone)]
pub struct Member {
    pub what: Members,
    pub at: Where,
}

/// Where a member of a set is named, and whose numbers it is in.
#[derive(Debug, Clone)]
pub struct Where {
    /// The instance whose numbers and names these are, where the card says one.
    pub instance: Option<Rc<str>>,
    pub line: u32,
    pub file: Rc<Path>,
}

impl Where {
    pub fn place(&self) -> Place {
        Place { file: self.file.to_path_buf(), line: Some(self.line as usize) }
    }
}

/// Members of a set.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Members {
    /// Ids first, first + step, .. last.
    Range { ids: [u64; 3], generated: bool },
    /// Another set, or `INSTANCE.17`.
    Name(String),
}

/// Faces of elements under a name, or nodes under one.
#[derive(Debug)]
pub struct Surface {
    pub name: String,
    /// Elements and the face of them that is meant; none: their free faces.
    pub faces: Vec<(Member, Option<u8>)>,
    /// Of a surface of nodes.
    pub nodes: Vec<Member>,
}

/// Sets by name, in the order of their first definition. Names differ by more than their case.
#[derive(Debug, Default)]
pub struct Sets {
    pub list: Vec<Set>,
    by_name: HashMap<String, usize>,
}

impl Sets {
    /// The place of the set `name`, made if it is not there: several definitions add up.
    pub fn place(&mut self, name: &str) -> usize {
        *self.by_name.entry(name.to_uppercase()).or_insert_with(|| {
            self.list.push(Set { name: name.into(), members: Vec::new() });
            self.list.len() - 1
        })
    }

    /// The set `name`, made if it is not there.
    pub fn make(&mut self, name: &str) -> &mut Set {
        let at = self.place(name);
        &mut self.list[at]
    }

    pub fn get(&self, name: &str) -> Option<&Set> {
        self.by_name.get(&name.to_uppercase()).map(|&at| &self.list[at])
    }
}

impl Set {
    /// Adds an id; ids in a row are one entry.
    pub fn push_id(&mut self, id: u64, like: &Where) {
        if let Some(Member { what: Members::Range { ids, generated: false }, at }) = self.members.last_mut()
            && ids[1].checked_add(1) == Some(id)
            && at.file == like.file
            && at.instance == like.instance
        {
            ids[1] = id;
            return;
        }
        let what = Members::Range { ids: [id, id, 1], generated: false };
        self.members.push(Member { what, at: like.clone() });
    }
}

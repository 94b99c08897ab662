//! Nodes of a mesh by name.

/// The set that every mesh has.
pub(super) const ALL: &str = "all";

/// Some nodes with a name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedNodes {
    pub name: String,
    /// What the set is, in words.
    pub meaning: String,
    /// Ascending, each once.
    pub nodes: Vec<u32>,
}

/// The sets of a mesh, in the order in which they are listed to people.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct NodeSets {
    sets: Vec<NamedNodes>,
}

/// A set that a mesh was asked for and does not have.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownSet {
    pub name: String,
    /// Names of the sets that it has.
    pub known: Vec<String>,
}

impl NodeSets {
    /// Adds a set; its nodes are put in order. A set of the same name is replaced.
    pub fn insert(&mut self, name: &str, meaning: &str, mut nodes: Vec<u32>) {
        nodes.sort_unstable();
        nodes.dedup();
        let set = NamedNodes { name: name.into(), meaning: meaning.into(), nodes };
        match self.sets.iter_mut().find(|s| s.name == name) {
            Some(old) => *old = set,
            None => self.sets.push(set),
        }
    }

    pub fn get(&self, name: &str) -> Option<&NamedNodes> {
        self.sets.iter().find(|s| s.name == name)
    }

    /// All sets, in the order in which they are listed.
    pub fn iter(&self) -> impl Iterator<Item = &NamedNodes> {
        self.sets.iter()
    }

    /// Names of all sets, that of every node first.
    pub fn names(&self) -> Vec<String> {
        let own = self.sets.iter().map(|s| s.name.as_str()).filter(|name| *name != ALL);
        std::iter::once(ALL).chain(own).map(String::from).collect()
    }

    /// What a set is, in words; its name where nothing else is known of it.
    pub fn meaning<'a>(&'a self, name: &'a str) -> &'a str {
        match self.get(name) {
            Some(set) => &set.meaning,
            None if name == ALL => "every node",
            None => name,
        }
    }
}

//! A deck, read from front to back: cards say what the lines behind them are.

use std::collections::BTreeMap;
use std::path::Path;
use std::rc::Rc;

use super::super::source::Place;
use super::cards::{Card, Cards, Dialect, Event};
use super::elements::{self, Shape};
use super::materials::{self, Material, Table};
use super::parts::{Instance, Member, Members, Part, Surface, Where};
use super::unread::{self, Kind};
use crate::error::Result;

/// What a deck says.
#[derive(Debug, Default)]
pub struct Deck {
    /// What stands outside of parts: all of a flat deck.
    pub root: Part,
    pub parts: Vec<Part>,
    pub instances: Vec<Instance>,
    pub materials: Vec<Material>,
    /// Element types by name, hexahedra and others: how many, and where the first card stands.
    pub types: BTreeMap<String, (usize, Place)>,
    /// Types left out because the scene says so.
    pub dropped: BTreeMap<String, usize>,
    /// Keywords that are not taken over, with what the scene has in their place; and unknown ones.
    pub not_taken_over: BTreeMap<String, (usize, Place, Kind)>,
    /// Problems of materials, which matter only if a scene is without one.
    pub material_notes: Vec<String>,
}

/// What the data lines are for.
#[derive(Debug)]
pub enum Active {
    Skip,
    /// Sets by their place in those of the part.
    Nodes {
        set: Option<usize>,
    },
    Elements {
        shape: Shape,
        set: Option<usize>,
    },
    Set {
        name: String,
        of_nodes: bool,
        generate: bool,
        instance: Option<Rc<str>>,
    },
    Surface {
        of_nodes: bool,
    },
    Placement {
        lines: usize,
    },
    Material(Table),
}

/// Where nodes, elements and sets go now.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    Root,
    Part(usize),
    Instance(usize),
}

pub struct Reader<'a> {
    pub cards: Cards,
    pub deck: Deck,
    pub active: Active,
    pub scope: Scope,
    drop: &'a [String],
    /// The file of the last line.
    file: Rc<Path>,
}

/// Reads a deck; element types in `drop` are left out.
pub fn read(path: &Path, dialect: Dialect, drop: &[String]) -> Result<Deck> {
    let cards = Cards::open(path, dialect)?;
    let (deck, file) = (Deck::default(), Rc::from(path));
    let mut reader = Reader { cards, deck, active: Active::Skip, scope: Scope::Root, drop, file };
    loop {
        match reader.cards.next()? {
            Event::Card(card) => reader.begin(&card)?,
            Event::Data => reader.line()?,
            Event::End => return Ok(reader.deck),
        }
    }
}

impl Reader<'_> {
    pub fn part(&mut self) -> &mut Part {
        match self.scope {
            Scope::Root => &mut self.deck.root,
            Scope::Part(p) => &mut self.deck.parts[p],
            Scope::Instance(i) => &mut self.deck.instances[i].own,
        }
    }

    pub fn here(&mut self, instance: Option<Rc<str>>) -> Where {
        let (file, line) = self.cards.file();
        if *self.file != *file {
            self.file = Rc::from(file);
        }
        Where { instance, line: line as u32, file: self.file.clone() }
    }

    /// What a keyword announces. One arm a keyword.
    fn begin(&mut self, card: &Card) -> Result<()> {
        self.active = match card.name.as_str() {
            "NODE" => self.nodes(card)?,
            "ELEMENT" => self.elements(card)?,
            "NSET" => self.set(card, "NSET", true)?,
            "ELSET" => self.set(card, "ELSET", false)?,
            "NGROUP" => self.set(card, "NGRP", true)?,
            "EGROUP" => self.set(card, "EGRP", false)?,
            "SURFACE" => self.surface(card)?,
            "SGROUP" => self.surface_group(card)?,
            "PART" => {
                self.deck.parts.push(Part { name: card.need("NAME")?.into(), ..Part::default() });
                self.scope = Scope::Part(self.deck.parts.len() - 1);
                Active::Skip
            }
            "INSTANCE" => self.instance(card)?,
            "END PART" | "END INSTANCE" => {
                self.scope = Scope::Root;
                Active::Skip
            }
            "MATERIAL" => {
                let name = card.get("NAME").unwrap_or_default().into();
                self.deck.materials.push(Material { name, ..Material::default() });
                Active::Skip
            }
            "DENSITY" => Active::Material(Table::Density),
            "HYPERELASTIC" => self.hyperelastic(card),
            "SOLID SECTION" | "SECTION" | "ITEM=1" | "ITEM=2" => Active::Skip,
            name => self.unread(name, card)?,
        };
        Ok(())
    }

    fn nodes(&mut self, card: &Card) -> Result<Active> {
        if let Some(system) = card.get("SYSTEM").filter(|s| !s.eq_ignore_ascii_case("R")) {
            let problem = format!("coordinates in the system {system:?}");
            return Err(card.error(problem, "write rectangular coordinates: leave SYSTEM out"));
        }
        let set = card.get("NSET").or(card.get("NGRP"));
        Ok(Active::Nodes { set: set.map(|name| self.part().node_sets.place(name)) })
    }

    fn elements(&mut self, card: &Card) -> Result<Active> {
        let name = card.need("TYPE")?.to_uppercase();
        let shape = match self.drop.iter().any(|d| d.eq_ignore_ascii_case(&name)) {
            true => {
                self.deck.dropped.entry(name.clone()).or_default();
                elements::dropped(&name)
            }
            false => elements::shape(&name),
        };
        self.deck.types.entry(name).or_insert_with(|| (0, card.place.clone()));
        let set = card.get("ELSET").or(card.get("EGRP"));
        Ok(Active::Elements { shape, set: set.map(|name| self.part().element_sets.place(name)) })
    }

    fn set(&mut self, card: &Card, key: &str, of_nodes: bool) -> Result<Active> {
        let name = card.need(key)?.to_string();
        let sets = if of_nodes { &mut self.part().node_sets } else { &mut self.part().element_sets };
        // A set may be empty, and named all the same.
        sets.make(&name);
        if let (Some(elements), true) = (card.get("ELSET"), of_nodes) {
            let what = Members::Name(format!("{ELEMENTS_OF}{elements}"));
            let at = self.here(None);
            self.part().node_sets.make(&name).members.push(Member { what, at });
        }
        let instance = card.get("INSTANCE").map(Rc::from);
        Ok(Active::Set { name, of_nodes, generate: card.has("GENERATE"), instance })
    }

    fn surface(&mut self, card: &Card) -> Result<Active> {
        let kind = card.get("TYPE").unwrap_or("ELEMENT").to_uppercase();
        let of_nodes = match kind.as_str() {
            "ELEMENT" => false,
            "NODE" => true,
            _ => {
                return match unread::surface(&kind) {
                    true => Ok(Active::Skip),
                    false => Err(card.error(
                        format!("TYPE={kind}"),
                        "write TYPE=ELEMENT or TYPE=NODE, or remove the card",
                    )),
                };
            }
        };
        let name = card.need("NAME")?.to_string();
        self.part().surfaces.push(Surface { name, faces: Vec::new(), nodes: Vec::new() });
        Ok(Active::Surface { of_nodes })
    }

    fn surface_group(&mut self, card: &Card) -> Result<Active> {
        let name = card.need("SGRP")?.to_string();
        self.part().surfaces.push(Surface { name, faces: Vec::new(), nodes: Vec::new() });
        Ok(Active::Surface { of_nodes: false })
    }

    fn instance(&mut self, card: &Card) -> Result<Active> {
        let name = card.need("NAME")?.to_string();
        let wanted = card.get("PART").filter(|p| !p.is_empty());
        let part = match wanted {
            None => None,
            Some(wanted) => {
                let at = self.deck.parts.iter().position(|p| p.name.eq_ignore_ascii_case(wanted));
                let known: Vec<&str> = self.deck.parts.iter().map(|p| p.name.as_str()).collect();
                let remedy = || format!("write one of the parts above: {}", known.join(", "));
                Some(at.ok_or_else(|| card.error(format!("there is no part {wanted:?}"), remedy()))?)
            }
        };
        if self.deck.instances.iter().any(|i| i.name.eq_ignore_ascii_case(&name)) {
            return Err(
                card.error(format!("a second instance {name:?}"), "give every instance a name of its own")
            );
        }
        self.deck.instances.push(Instance {
            name,
            part,
            own: Part::default(),
            translation: [0.0; 3],
            rotation: None,
            place: card.place.clone(),
        });
        self.scope = Scope::Instance(self.deck.instances.len() - 1);
        Ok(Active::Placement { lines: 0 })
    }

    fn hyperelastic(&mut self, card: &Card) -> Active {
        if self.deck.materials.is_empty() {
            self.deck.materials.push(Material::default());
        }
        match materials::announced(card) {
            Ok(kind) => {
                let law = (kind.to_string(), Vec::new(), card.place.clone());
                self.deck.materials.last_mut().expect("there is one").law = Some(law);
                Active::Material(Table::Law)
            }
            Err(problem) => {
                let line = card.place.line.unwrap_or(0);
                self.deck.material_notes.push(format!("line {line}: *HYPERELASTIC: {problem}"));
                Active::Skip
            }
        }
    }

    fn unread(&mut self, name: &str, card: &Card) -> Result<Active> {
        match unread::kind(name) {
            Kind::Harmless => {}
            Kind::MakesMesh(remedy) => {
                return Err(card.error("this keyword makes or changes a mesh, and is not followed", remedy));
            }
            kind => {
                /// Different keywords that are worth listing.
                const MOST: usize = 200;
                let known =
                    self.deck.not_taken_over.len() < MOST || self.deck.not_taken_over.contains_key(name);
                if known {
                    let first = || (0, card.place.clone(), kind);
                    self.deck.not_taken_over.entry(name.into()).or_insert_with(first).0 += 1;
                }
            }
        }
        Ok(Active::Skip)
    }
}

/// Stands before the name of an element set whose nodes are meant.
pub const ELEMENTS_OF: &str = "\u{1}";

//! Data lines of a deck, by what the card before them says.

use std::rc::Rc;

use super::super::numbers::{fields, real, shown, whole};
use super::deck::{Active, Reader, Scope};
use super::elements::{self, Shape};
use super::materials::Material;
use super::parts::{Corners, Member, Members};
use crate::error::Result;

impl Reader<'_> {
    /// A data line.
    pub fn line(&mut self) -> Result<()> {
        let active = std::mem::replace(&mut self.active, Active::Skip);
        let done = self.line_of(&active);
        self.active = match active {
            Active::Placement { lines } => Active::Placement { lines: lines + 1 },
            other => other,
        };
        done
    }

    fn line_of(&mut self, active: &Active) -> Result<()> {
        match active {
            Active::Skip => Ok(()),
            Active::Nodes { set } => self.node(*set),
            Active::Elements { shape, set } => self.element(shape, *set),
            Active::Set { name, of_nodes, generate, instance } => {
                self.members(name, *of_nodes, *generate, instance.clone())
            }
            Active::Surface { of_nodes } => self.face(*of_nodes),
            Active::Placement { lines } => self.placement(*lines),
            Active::Material(table) => {
                if self.deck.materials.is_empty() {
                    self.deck.materials.push(Material::default());
                }
                let place = self.cards.place();
                let numbers: Vec<&[u8]> = fields(self.cards.data()).collect();
                self.deck.materials.last_mut().expect("there is one").take(*table, &numbers, &place)
            }
        }
    }

    /// `17, 1.0, 2.0, 3.0`; what is not written is zero.
    fn node(&mut self, set: Option<usize>) -> Result<()> {
        let place = || self.cards.place();
        let bad = |problem: String| place().error("*NODE", problem, "write number, x, y, z");
        let mut parts = fields(self.cards.data());
        let id = whole(parts.next().unwrap_or_default()).map_err(bad)?;
        let mut x = [0.0; 3];
        for (c, field) in x.iter_mut().zip(parts) {
            *c = if field.is_empty() { 0.0 } else { real(field).map_err(bad)? };
        }
        let part = self.part();
        part.node_ids.push(id);
        part.nodes.push(x);
        if let Some(set) = set {
            let at = self.here(None);
            self.part().node_sets.list[set].push_id(id, &at);
        }
        Ok(())
    }

    /// `12, 1, 2, 3, 4, 5, 6, 7, 8`, maybe over several lines: one goes on where there are not yet enough nodes.
    fn element(&mut self, shape: &Shape, set: Option<usize>) -> Result<()> {
        let first = self.here(None);
        let bad = |problem: String| {
            first.place().error("*ELEMENT", problem, "write number, and the numbers of its nodes")
        };
        let (mut id, mut corners, mut count): (u64, Corners, usize) = (0, [None; 8], 0);
        let mut begun = false;
        loop {
            let mut unfinished = false;
            for field in fields(self.cards.data()) {
                unfinished = field.is_empty();
                if unfinished {
                    continue;
                }
                let number = whole(field).map_err(bad)?;
                match begun {
                    false => (id, begun) = (number, true),
                    true => {
                        if let Some(corner) = corners.get_mut(count) {
                            *corner = Some(number);
                        }
                        count += 1;
                    }
                }
            }
            let more = match shape.nodes {
                Some(nodes) => count < nodes,
                None => unfinished,
            };
            if !more {
                break;
            }
            if !self.cards.next_data()? {
                let wanted = shape.nodes.unwrap_or(count + 1);
                return Err(bad(format!(
                    "element {id} has {count} nodes where {wanted} are needed, and the file ends"
                )));
            }
        }
        if let Some(nodes) = shape.nodes.filter(|&n| n != count) {
            return Err(bad(format!("element {id} has {count} nodes where {nodes} are needed")));
        }
        self.take_element(shape, id, corners);
        if let Some(set) = set {
            self.part().element_sets.list[set].push_id(id, &first);
        }
        Ok(())
    }

    fn take_element(&mut self, shape: &Shape, id: u64, corners: Corners) {
        if let Some(count) = self.deck.dropped.get_mut(&shape.name) {
            *count += 1;
        } else if let Some(entry) = self.deck.types.get_mut(&shape.name) {
            entry.0 += 1;
        }
        let is_hexahedron = shape.is_hexahedron;
        let is_section = !self.deck.dropped.contains_key(&shape.name) && elements::is_section(&shape.name);
        let part = self.part();
        if is_hexahedron {
            part.element_ids.push(id);
            part.hexes.push(corners.map(|c| c.expect("eight nodes were counted")));
        } else {
            if is_section {
                part.section.push(part.others.len());
            }
            part.others.push((id, corners));
        }
    }

    fn members(
        &mut self,
        name: &str,
        of_nodes: bool,
        generate: bool,
        instance: Option<Rc<str>>,
    ) -> Result<()> {
        let at = self.here(instance);
        let key = if of_nodes { "*NSET" } else { "*ELSET" };
        let bad = |problem: String| at.place().error(key, problem, "write first, last, step");
        let data = self.data_copy();
        let part = self.part();
        let set = if of_nodes { part.node_sets.make(name) } else { part.element_sets.make(name) };
        if generate {
            let ids: Vec<u64> = fields(&data)
                .filter(|f| !f.is_empty())
                .map(whole)
                .collect::<std::result::Result<_, _>>()
                .map_err(bad)?;
            let ids = match ids[..] {
                [first] => [first, first, 1],
                [first, last] => [first, last, 1],
                [first, last, step] if step > 0 => [first, last, step],
                _ => return Err(bad(format!("{} numbers, or a step of zero", ids.len()))),
            };
            if ids[1] < ids[0] {
                return Err(bad(format!("{} comes before {}", ids[1], ids[0])));
            }
            set.members.push(Member { what: Members::Range { ids, generated: true }, at });
            return Ok(());
        }
        for field in fields(&data).filter(|f| !f.is_empty()) {
            match whole(field) {
                Ok(id) => set.push_id(id, &at),
                Err(_) => set.members.push(Member { what: name_of(field), at: at.clone() }),
            }
        }
        Ok(())
    }

    fn data_copy(&self) -> Vec<u8> {
        self.cards.data().to_vec()
    }

    /// `17, S3`, `TREAD, S3`, `TREAD` or, in a surface of nodes, `RIM`.
    fn face(&mut self, of_nodes: bool) -> Result<()> {
        let at = self.here(None);
        let data = self.data_copy();
        let parts: Vec<&[u8]> = fields(&data).collect();
        let member = |field: &[u8]| {
            let what = whole(field)
                .map_or_else(|_| name_of(field), |id| Members::Range { ids: [id, id, 1], generated: false });
            Member { what, at: at.clone() }
        };
        let face = match parts.get(1).copied().unwrap_or_default() {
            _ if of_nodes => None,
            [] => None,
            [b'S' | b's', digit @ b'1'..=b'6'] | [digit @ b'1'..=b'6'] => Some(digit - b'1'),
            other => {
                let problem = format!("{} is not a face of a hexahedron", shown(other));
                return Err(at.place().error("*SURFACE", problem, "write S1 to S6"));
            }
        };
        let named = member(parts[0]);
        let Some(surface) = self.part().surfaces.last_mut() else { return Ok(()) };
        match of_nodes {
            true => surface.nodes.push(named),
            false => surface.faces.push((named, face)),
        }
        Ok(())
    }

    /// First line: the translation; second: two points of an axis, and the angle about it [deg].
    fn placement(&mut self, line: usize) -> Result<()> {
        let place = self.cards.place();
        let bad = |problem: String| {
            place.error("*INSTANCE", problem, "write dx, dy, dz, then x1, y1, z1, x2, y2, z2, degrees")
        };
        let numbers: Vec<f64> = fields(self.cards.data())
            .map(|f| if f.is_empty() { Ok(0.0) } else { real(f) })
            .collect::<std::result::Result<_, _>>()
            .map_err(bad)?;
        let at = |i: usize| numbers.get(i).copied().unwrap_or(0.0);
        let Scope::Instance(i) = self.scope else { return Ok(()) };
        let instance = &mut self.deck.instances[i];
        match line {
            0 => instance.translation = [at(0), at(1), at(2)],
            1 => {
                let [a, b] = [[at(0), at(1), at(2)], [at(3), at(4), at(5)]];
                if a == b {
                    return Err(bad("the two points of the axis are the same".into()));
                }
                instance.rotation = Some(([a, b], at(6).to_radians()));
            }
            _ => return Err(bad("a third line".into())),
        }
        Ok(())
    }
}

fn name_of(field: &[u8]) -> Members {
    let text = String::from_utf8_lossy(field);
    Members::Name(text.trim_matches('"').into())
}

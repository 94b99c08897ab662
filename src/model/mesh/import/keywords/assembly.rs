//! A deck put together: instances where they stand, ids as places, sets as nodes.

use std::rc::Rc;

use super::super::ids::Ids;
use super::super::raw::Raw;
use super::super::source::Place;
use super::deck::Deck;
use super::parts::{Instance, Part};
use super::resolve::Sets;
use crate::error::Result;
use crate::model::mesh::{Labels, Numbers};
use crate::physics::tensor::{add, axpy, cross, dot, scale, sub};

/// A part where it stands, or what a deck has outside of parts (the first, without a name).
pub struct Body<'a> {
    pub name: &'a str,
    /// The part, and what the instance has of its own.
    pub parts: Vec<&'a Part>,
    pub nodes: Ids,
    pub elements: Ids,
    /// Elements that are no hexahedra, numbered on from all hexahedra of the deck.
    pub others: Ids,
    /// Places of its first node, hexahedron and other element in the whole.
    pub first: [u32; 3],
}

/// What a deck comes to.
///
/// `section`: the quadrilaterals of a section are wanted, not hexahedra.
pub fn assembled(deck: &Deck, section: bool, file: &Place) -> Result<Raw> {
    let mut raw = Raw::default();
    let mut bodies: Vec<Body> = vec![body("", vec![&deck.root], None, &mut raw, 0, file)?];
    for instance in &deck.instances {
        let mut parts: Vec<&Part> = instance.part.map(|p| &deck.parts[p]).into_iter().collect();
        parts.push(&instance.own);
        let others = bodies.iter().flat_map(|b| &b.parts).map(|p| p.others.len()).sum();
        bodies.push(body(&instance.name, parts, Some(instance), &mut raw, others, &instance.place)?);
    }
    if deck.instances.is_empty() && !deck.parts.is_empty() {
        let names: Vec<&str> = deck.parts.iter().map(|p| p.name.as_str()).collect();
        let problem = format!("parts without an instance: {}", names.join(", "));
        return Err(file.error(
            "*PART",
            problem,
            "add *INSTANCE, NAME=.., PART=.. and *END INSTANCE behind the parts",
        ));
    }
    for body in &bodies {
        corners(body, &mut raw, file)?;
    }
    let others: Vec<Vec<u32>> = bodies.iter().flat_map(other_corners).collect();
    if section {
        quads(&bodies, &others, &mut raw, file)?;
    }
    raw.sets = Sets::new(&bodies, &raw.hexes, &others, file).all()?;
    Ok(raw)
}

/// Adds the nodes of a body to the whole.
fn body<'a>(
    name: &'a str,
    parts: Vec<&'a Part>,
    instance: Option<&Instance>,
    raw: &mut Raw,
    others_before: usize,
    at: &Place,
) -> Result<Body<'a>> {
    let first = [raw.nodes.len() as u32, raw.labels.elements.of.len() as u32, others_before as u32];
    let all =
        |ids: fn(&Part) -> &Vec<u64>| -> Vec<u64> { parts.iter().flat_map(|p| ids(p)).copied().collect() };
    let (node_ids, element_ids) = (all(|p| &p.node_ids), all(|p| &p.element_ids));
    let of = if name.is_empty() { String::new() } else { format!(" in {name}") };
    let nodes = Ids::new(&node_ids).map_err(|[a, _]| {
        let problem = format!("node {}{of} is there twice", node_ids[a]);
        at.error("*NODE", problem, "give every node a number of its own, or remove the second")
    })?;
    let elements = Ids::new(&element_ids).map_err(|[a, _]| {
        let problem = format!("element {}{of} is there twice", element_ids[a]);
        at.error("*ELEMENT", problem, "give every element a number of its own, or remove the second")
    })?;
    let other_ids: Vec<u64> = parts.iter().flat_map(|p| &p.others).map(|o| o.0).collect();
    let others = Ids::new(&other_ids).map_err(|[a, _]| {
        let problem = format!("element {}{of} is there twice", other_ids[a]);
        at.error("*ELEMENT", problem, "give every element a number of its own, or remove the second")
    })?;
    for part in &parts {
        raw.nodes.extend(part.nodes.iter().map(|&x| instance.map_or(x, |i| placed(i, x))));
    }
    let Labels { nodes: of_nodes, elements: of_elements, .. } = &mut raw.labels;
    let label = |numbers: &mut Numbers, ids: Vec<u64>, first: u32| {
        numbers.parts.push((first, name.to_string()));
        numbers.of.extend(ids);
    };
    label(of_nodes, node_ids, first[0]);
    label(of_elements, element_ids, first[1]);
    Ok(Body { name, parts, nodes, elements, others, first })
}

/// A point of a part where its instance stands: moved first, then turned about the axis (Rodrigues' formula).
fn placed(instance: &Instance, x: [f64; 3]) -> [f64; 3] {
    let moved = add(x, instance.translation);
    let Some(([a, b], angle)) = instance.rotation else { return moved };
    let along = sub(b, a);
    let axis = scale(along, 1.0 / dot(along, along).sqrt());
    let arm = sub(moved, a);
    let (sin, cos) = angle.sin_cos();
    let turned = axpy(cross(axis, arm), sin, scale(arm, cos));
    add(a, axpy(axis, (1.0 - cos) * dot(axis, arm), turned))
}

/// Adds the hexahedra of a body, by place of their nodes.
fn corners(body: &Body, raw: &mut Raw, file: &Place) -> Result<()> {
    for part in &body.parts {
        for (hex, id) in part.hexes.iter().zip(&part.element_ids) {
            let mut places = [0; 8];
            for (place, node) in places.iter_mut().zip(hex) {
                let found = body.nodes.get(*node).ok_or_else(|| {
                    let of = if body.name.is_empty() { String::new() } else { format!("{}.", body.name) };
                    let problem = format!("element {of}{id} has the node {node}, which is not there");
                    file.error(
                        "*ELEMENT",
                        problem,
                        "add the node, or remove the element: is a part of the file missing?",
                    )
                })?;
                *place = body.first[0] + found;
            }
            raw.hexes.push(places);
        }
    }
    Ok(())
}

/// Takes the quadrilaterals of a section.
fn quads(bodies: &[Body], others: &[Vec<u32>], raw: &mut Raw, file: &Place) -> Result<()> {
    for body in bodies {
        let mut first = body.first[2] as usize;
        for part in &body.parts {
            for &at in &part.section {
                let id = part.others[at].0;
                let quad = <[u32; 4]>::try_from(&others[first + at][..]).map_err(|_| {
                    let problem = format!("element {id} of the section has not four nodes that are there");
                    file.error("*ELEMENT", problem, "add the nodes, or remove the element")
                })?;
                raw.quads.push(quad);
                raw.labels.elements.of.push(id);
            }
            first += part.others.len();
        }
    }
    Ok(())
}

/// Nodes of the elements of a body that are no hexahedra, as far as they are there.
fn other_corners<'a>(body: &'a Body) -> impl Iterator<Item = Vec<u32>> + 'a {
    let place = |node: &Option<u64>| Some(body.first[0] + body.nodes.get((*node)?)?);
    body.parts
        .iter()
        .flat_map(|p| &p.others)
        .map(move |(_, corners)| corners.iter().filter_map(place).collect())
}

/// A name that the sets of all bodies can share.
pub fn shared(text: &str) -> Rc<str> {
    Rc::from(text.to_uppercase())
}

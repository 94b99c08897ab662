//! Gmsh's mesh, 2.2 or 4.1, as text or binary. A node set is a physical group: of surfaces where faces have just its nodes, else of
//! points.

use std::io::{Result, Write};

use super::{element_numbers, node_numbers};
use crate::model::mesh::{Mesh, NamedNodes};

/// How a `.msh` file is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Msh {
    /// Version 2.2, which older programs read; else 4.1.
    pub old: bool,
    pub binary: bool,
}

/// Gmsh's numbers of element types.
const POINT: i32 = 15;
const QUADRANGLE: i32 = 3;
const HEXAHEDRON: i32 = 5;

/// Elements of one type in one group, by number of their nodes.
struct Block {
    dimension: i32,
    kind: i32,
    /// Group and entity.
    tag: i32,
    name: String,
    elements: Vec<(u64, Vec<u64>)>,
}

/// Writes nodes, hexahedra and node sets; lengths in metres.
pub fn write(out: &mut dyn Write, mesh: &Mesh, how: Msh) -> Result<()> {
    let nodes = node_numbers(mesh);
    let blocks = blocks(mesh, &nodes);
    let version = if how.old { "2.2" } else { "4.1" };
    writeln!(out, "$MeshFormat\n{version} {} 8", i32::from(how.binary))?;
    let mut file = File { out, binary: how.binary };
    if how.binary {
        file.int(1)?;
        file.line()?;
    }
    writeln!(file.out, "$EndMeshFormat\n$PhysicalNames\n{}", blocks.len())?;
    for Block { dimension, tag, name, .. } in &blocks {
        writeln!(file.out, "{dimension} {tag} \"{}\"", name.replace(['"', '\n'], "_"))?;
    }
    writeln!(file.out, "$EndPhysicalNames")?;
    match how.old {
        true => version2(&mut file, mesh, &nodes, &blocks),
        false => version4(&mut file, mesh, &nodes, &blocks),
    }
}

/// The body first, so that its elements keep their numbers.
fn blocks(mesh: &Mesh, nodes: &[u64]) -> Vec<Block> {
    let numbers = element_numbers(mesh);
    let corners = |of: &[u32]| of.iter().map(|&n| nodes[n as usize]).collect::<Vec<u64>>();
    let hexes = numbers.iter().zip(&mesh.hexes).map(|(&e, hex)| (e, corners(hex))).collect();
    let taken = |name: &str| mesh.sets.get(name).is_some();
    let name = if taken("body") { "hexahedra" } else { "body" };
    let mut blocks =
        vec![Block { dimension: 3, kind: HEXAHEDRON, tag: 1, name: name.into(), elements: hexes }];
    let mut next = numbers.iter().max().map_or(1, |n| n + 1);
    for (k, set) in mesh.sets.iter().enumerate() {
        let faces = faces_of(mesh, set);
        let (dimension, kind) = if faces.is_empty() { (0, POINT) } else { (2, QUADRANGLE) };
        let members: Vec<Vec<u64>> = match faces.is_empty() {
            true => set.nodes.iter().map(|&n| corners(&[n])).collect(),
            false => faces.iter().map(|f| corners(f)).collect(),
        };
        let elements: Vec<(u64, Vec<u64>)> = (next..).zip(members).collect();
        next += elements.len() as u64;
        blocks.push(Block { dimension, kind, tag: k as i32 + 2, name: set.name.clone(), elements });
    }
    blocks
}

/// Outer faces with nodes of the set alone, if those are all of its nodes.
fn faces_of(mesh: &Mesh, set: &NamedNodes) -> Vec<[u32; 4]> {
    let has = |n: &u32| set.nodes.binary_search(n).is_ok();
    let faces: Vec<[u32; 4]> = mesh.facets.iter().filter(|f| f.iter().all(has)).copied().collect();
    let mut nodes: Vec<u32> = faces.iter().flatten().copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    if nodes == set.nodes { faces } else { Vec::new() }
}

fn version2(file: &mut File, mesh: &Mesh, nodes: &[u64], blocks: &[Block]) -> Result<()> {
    writeln!(file.out, "$Nodes\n{}", nodes.len())?;
    for (&n, x) in nodes.iter().zip(&mesh.nodes) {
        file.int(n as i32)?;
        file.reals(x)?;
        file.end()?;
    }
    file.line()?;
    writeln!(file.out, "$EndNodes\n$Elements\n{}", blocks.iter().map(|b| b.elements.len()).sum::<usize>())?;
    for block in blocks {
        // Two tags: group and entity.
        if file.binary {
            [block.kind, block.elements.len() as i32, 2].iter().try_for_each(|&i| file.int(i))?;
        }
        for (e, of) in &block.elements {
            file.int(*e as i32)?;
            if !file.binary {
                file.int(block.kind)?;
                file.int(2)?;
            }
            file.int(block.tag)?;
            file.int(block.tag)?;
            of.iter().try_for_each(|&n| file.int(n as i32))?;
            file.end()?;
        }
    }
    file.line()?;
    writeln!(file.out, "$EndElements")
}

fn version4(file: &mut File, mesh: &Mesh, nodes: &[u64], blocks: &[Block]) -> Result<()> {
    entities(file, mesh, blocks)?;
    let extremes = |of: &mut dyn Iterator<Item = u64>| {
        let (low, high) = of.fold((u64::MAX, 0), |(low, high), n| (low.min(n), high.max(n)));
        [low.min(high), high]
    };
    writeln!(file.out, "$Nodes")?;
    let [low, high] = extremes(&mut nodes.iter().copied());
    file.sizes(&[1, nodes.len() as u64, low, high])?;
    // All of them on the body.
    [3, 1, 0].iter().try_for_each(|&i| file.int(i))?;
    file.sizes(&[nodes.len() as u64])?;
    for &n in nodes {
        file.sizes(&[n])?;
    }
    for x in &mesh.nodes {
        file.reals(x)?;
        file.end()?;
    }
    file.line()?;
    writeln!(file.out, "$EndNodes\n$Elements")?;
    let [low, high] = extremes(&mut blocks.iter().flat_map(|b| b.elements.iter().map(|e| e.0)));
    let count = blocks.iter().map(|b| b.elements.len() as u64).sum();
    file.sizes(&[blocks.len() as u64, count, low, high])?;
    for block in blocks {
        [block.dimension, block.tag, block.kind].iter().try_for_each(|&i| file.int(i))?;
        file.sizes(&[block.elements.len() as u64])?;
        for (e, of) in &block.elements {
            let line: Vec<u64> = std::iter::once(*e).chain(of.iter().copied()).collect();
            file.sizes(&line)?;
        }
    }
    file.line()?;
    writeln!(file.out, "$EndElements")
}

/// An entity a group: Gmsh says of entities what groups they are in.
fn entities(file: &mut File, mesh: &Mesh, blocks: &[Block]) -> Result<()> {
    let bound = |pick: fn(f64, f64) -> f64, from: f64| -> [f64; 3] {
        std::array::from_fn(|d| mesh.nodes.iter().fold(from, |m, x| pick(m, x[d])))
    };
    let (low, high) = (bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY));
    writeln!(file.out, "$Entities")?;
    let of = |dimension: i32| blocks.iter().filter(move |b| b.dimension == dimension);
    let counts: Vec<u64> = (0..4).map(|d| of(d).count() as u64).collect();
    file.sizes(&counts)?;
    for dimension in 0..4 {
        for block in of(dimension) {
            file.int(block.tag)?;
            file.reals(&low)?;
            if dimension > 0 {
                file.reals(&high)?;
            }
            file.size(1)?;
            file.int(block.tag)?;
            if dimension > 0 {
                file.size(0)?;
            }
            file.end()?;
        }
    }
    file.line()?;
    writeln!(file.out, "$EndEntities")
}

/// Numbers as text or binary.
struct File<'a> {
    out: &'a mut dyn Write,
    binary: bool,
}

impl File<'_> {
    fn int(&mut self, value: i32) -> Result<()> {
        if self.binary { self.out.write_all(&value.to_ne_bytes()) } else { write!(self.out, "{value} ") }
    }

    fn size(&mut self, value: u64) -> Result<()> {
        if self.binary { self.out.write_all(&value.to_ne_bytes()) } else { write!(self.out, "{value} ") }
    }

    /// Sizes, and the end of a line of text.
    fn sizes(&mut self, values: &[u64]) -> Result<()> {
        values.iter().try_for_each(|&v| self.size(v))?;
        self.end()
    }

    fn reals(&mut self, values: &[f64; 3]) -> Result<()> {
        values.iter().try_for_each(|v| match self.binary {
            true => self.out.write_all(&v.to_ne_bytes()),
            false => write!(self.out, "{v:e} "),
        })
    }

    /// Ends a line of text.
    fn end(&mut self) -> Result<()> {
        if self.binary { Ok(()) } else { writeln!(self.out) }
    }

    /// Ends binary data, as a line of its own.
    fn line(&mut self) -> Result<()> {
        if self.binary { writeln!(self.out) } else { Ok(()) }
    }
}

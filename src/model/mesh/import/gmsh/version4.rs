//! Sections of version 4.1.

use super::groups::{Collected, kind};
use super::stream::{Stream, Width::Eight};
use crate::error::Result;

/// `$Entities`: which physical groups an entity belongs to.
pub fn entities(stream: &mut Stream, into: &mut Collected) -> Result<()> {
    let counts = stream.wholes(4, Eight)?;
    for (dimension, &count) in counts.iter().enumerate() {
        for _ in 0..count {
            let tag = stream.integer()?;
            // A point, or the corners of a box.
            stream.reals(if dimension == 0 { 3 } else { 6 })?;
            let groups = tags(stream)?;
            if dimension > 0 {
                // What bounds it.
                tags(stream)?;
            }
            let groups = groups.into_iter().filter_map(|g| u64::try_from(g.abs()).ok()).collect();
            into.entities.insert((dimension as u8, tag), groups);
        }
    }
    Ok(())
}

fn tags(stream: &mut Stream) -> Result<Vec<i64>> {
    let count = stream.whole(Eight)? as usize;
    let mut tags = Vec::with_capacity(stream.room(count));
    for _ in 0..count {
        tags.push(stream.integer()?);
    }
    Ok(tags)
}

/// Blocks of nodes on an entity: all tags, then all coordinates.
pub fn nodes(stream: &mut Stream, into: &mut Collected) -> Result<()> {
    let [blocks, count, _, _] = head(stream)?;
    let mut read = 0;
    for _ in 0..blocks {
        let (dimension, _, parametric, in_block) = block(stream)?;
        let of_node = 3 + if parametric == 0 { 0 } else { dimension as usize };
        let left = count - read;
        if in_block > left {
            return Err(stream.damaged(format!("a block of {in_block} nodes where {left} are left")));
        }
        let tags = stream.wholes(in_block as usize, Eight)?;
        into.node_tags.extend(tags);
        for _ in 0..in_block {
            let x = stream.reals(of_node)?;
            into.nodes.push([x[0], x[1], x[2]]);
        }
        read += in_block;
    }
    complete(stream, "nodes", count, read)
}

/// Blocks of elements of a type on an entity, `tag nodes..` each.
pub fn elements(stream: &mut Stream, into: &mut Collected) -> Result<()> {
    let [blocks, count, _, _] = head(stream)?;
    let mut read = 0;
    for _ in 0..blocks {
        let (dimension, entity, number, in_block) = block(stream)?;
        let kind = kind(stream, number as u64)?;
        let left = count - read;
        if in_block > left {
            return Err(stream.damaged(format!("a block of {in_block} elements where {left} are left")));
        }
        if i64::from(kind.dimension) != dimension {
            return Err(stream
                .damaged(format!("elements of type {:?} on an entity of dimension {dimension}", kind.name)));
        }
        let groups = into.entities.get(&(kind.dimension, entity)).cloned().unwrap_or_default();
        for _ in 0..in_block {
            let numbers = stream.wholes(1 + kind.nodes, Eight)?;
            into.element(kind, numbers[0], &numbers[1..], &groups);
        }
        read += in_block;
    }
    complete(stream, "elements", count, read)
}

/// Blocks, items, smallest and largest tag.
fn head(stream: &mut Stream) -> Result<[u64; 4]> {
    let head = stream.wholes(4, Eight)?;
    Ok([head[0], head[1], head[2], head[3]])
}

/// Dimension and tag of the entity, what follows (parametric, or the element type), items.
fn block(stream: &mut Stream) -> Result<(i64, i64, i64, u64)> {
    let [dimension, entity, what] = [stream.integer()?, stream.integer()?, stream.integer()?];
    if !(0..=3).contains(&dimension) || what < 0 {
        return Err(stream.damaged(format!("a block of dimension {dimension} and type {what}")));
    }
    Ok((dimension, entity, what, stream.whole(Eight)?))
}

fn complete(stream: &Stream, what: &str, said: u64, read: u64) -> Result<()> {
    match said == read {
        true => Ok(()),
        false => Err(stream.damaged(format!("{said} {what} are announced, and {read} are there"))),
    }
}

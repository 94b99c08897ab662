//! Sections of version 2.2.

use super::groups::{Collected, Kind, kind};
use super::stream::{Stream, Width::Four};
use crate::error::Result;

/// The count of a section stands as text in binary files too.
fn count(stream: &mut Stream) -> Result<usize> {
    let line = stream.text_line()?;
    line.trim().parse().map_err(|_| stream.damaged(format!("{line:?} is not a count")))
}

/// `tag x y z` a node.
pub fn nodes(stream: &mut Stream, into: &mut Collected) -> Result<()> {
    let count = count(stream)?;
    for _ in 0..count {
        into.node_tags.push(stream.whole(Four)?);
        let x = stream.reals(3)?;
        into.nodes.push([x[0], x[1], x[2]]);
    }
    Ok(())
}

/// As text `tag type tags.. nodes..` an element; binary: blocks of a type, `type count tags` before each.
pub fn elements(stream: &mut Stream, into: &mut Collected) -> Result<()> {
    let count = count(stream)?;
    let mut read = 0;
    while read < count {
        if stream.binary() {
            let block = stream.wholes(3, Four)?;
            let kind = kind(stream, block[0])?;
            let left = (count - read) as u64;
            if block[1] == 0 || block[1] > left {
                return Err(stream.damaged(format!("a block of {} elements where {left} are left", block[1])));
            }
            for _ in 0..block[1] {
                let tag = stream.whole(Four)?;
                element(stream, into, kind, tag, block[2])?;
            }
            read += block[1] as usize;
        } else {
            let start = stream.wholes(3, Four)?;
            let kind = kind(stream, start[1])?;
            element(stream, into, kind, start[0], start[2])?;
            read += 1;
        }
    }
    Ok(())
}

/// Tags, of which the first is the physical group, and nodes.
fn element(stream: &mut Stream, into: &mut Collected, kind: Kind, tag: u64, tags: u64) -> Result<()> {
    /// Group, entity, and partitions of an element.
    const MOST: u64 = 1000;
    if tags > MOST {
        return Err(stream.damaged(format!("element {tag} has {tags} tags")));
    }
    let (mut groups, mut partitions) = (Vec::new(), Vec::new());
    for t in 0..tags {
        // Partitions may be negative: ghosts.
        let value = stream.integer()?;
        if t == 0 { groups.push(value.max(0) as u64) } else { partitions.push(value) }
    }
    let nodes = stream.wholes(kind.nodes, Four)?;
    into.element(kind, tag, &nodes, &groups);
    Ok(())
}

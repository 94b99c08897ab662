//! Abaqus' and CalculiX' input file.

use std::io::{Result, Write};

use super::{element_numbers, node_numbers};
use crate::model::mesh::Mesh;

/// Entries of a data line that every reader takes.
const ENTRIES: usize = 16;

/// Writes nodes, C3D8 elements and node sets; lengths in metres.
pub fn write(out: &mut dyn Write, mesh: &Mesh) -> Result<()> {
    let (nodes, elements) = (node_numbers(mesh), element_numbers(mesh));
    writeln!(out, "*HEADING\nhexroll: {}; lengths in m", mesh.description.replace('\n', " "))?;
    writeln!(out, "*NODE")?;
    for (n, [x, y, z]) in nodes.iter().zip(&mesh.nodes) {
        writeln!(out, "{n}, {x:e}, {y:e}, {z:e}")?;
    }
    writeln!(out, "*ELEMENT, TYPE=C3D8")?;
    for (e, hex) in elements.iter().zip(&mesh.hexes) {
        write!(out, "{e}")?;
        for n in hex {
            write!(out, ", {}", nodes[*n as usize])?;
        }
        writeln!(out)?;
    }
    for set in mesh.sets.iter() {
        writeln!(out, "*NSET, NSET={}", name(&set.name))?;
        for line in set.nodes.chunks(ENTRIES) {
            let line: Vec<String> = line.iter().map(|&n| nodes[n as usize].to_string()).collect();
            writeln!(out, "{}", line.join(", "))?;
        }
    }
    Ok(())
}

/// A name as it may stand behind `=`: without what ends it.
fn name(text: &str) -> String {
    let plain: String =
        text.chars().map(|c| if c == ',' || c == '"' || c.is_control() { '_' } else { c }).collect();
    if plain.contains(char::is_whitespace) { format!("\"{plain}\"") } else { plain }
}

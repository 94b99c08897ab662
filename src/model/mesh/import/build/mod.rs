//! From what a file says to a mesh that can be trusted: what is wrong is mended and said, or refused with the file's numbers.

mod axle;
mod fault;
mod gaps;
mod grid;
mod merge;
mod order;
mod revolve;

use std::sync::Arc;

use sha2::{Digest, Sha256};

use super::raw::Raw;
use crate::error::Result;
use crate::model::mesh::faces::{Faces, MANY, OUTER, nodes_of};
use crate::model::mesh::{Labels, Mesh, NodeSets, quality};
use crate::scene::MeshFile;
use fault::Fault;

/// The mesh of a file.
pub fn mesh(mut raw: Raw, file: &MeshFile, rim: Option<&str>) -> Result<Mesh> {
    let fault = Fault::new(file, Labels::default());
    let sectors = file.revolve.map_or(1, |how| how.sectors);
    let elements = (raw.hexes.len() + raw.quads.len()).saturating_mul(8).saturating_mul(sectors);
    if u32::try_from(elements).is_err() || u32::try_from(raw.nodes.len()).is_err() {
        // Every element has eight force slots, and slots are counted in 32 bits.
        let most = u32::MAX / 8 / 1_000_000;
        return Err(
            fault.error("more elements than can be counted".into(), format!("at most {most} million fit"))
        );
    }
    /// More sets than anybody looks through.
    const SETS: usize = 10_000;
    if raw.sets.len() > SETS {
        let problem = format!("{} sets, and at most {SETS} are taken", raw.sets.len());
        return Err(fault.error(problem, "remove sets that are not needed"));
    }
    for x in &mut raw.nodes {
        *x = file.axis.to_y(x.map(|c| file.unit.to_metres(c)));
    }
    drop_unused(&mut raw);
    if let Some(how) = &file.revolve {
        let fault = Fault::new(file, raw.labels.clone());
        revolve::revolve(&mut raw, how, &fault)?;
    }
    if let Some(within) = file.merge {
        merge::merge(&mut raw, within);
        drop_unused(&mut raw);
    }
    let fault = Fault::new(file, raw.labels.clone());
    order::mend(&mut raw, &fault)?;
    let faces = Faces::of(&raw.hexes);
    one_on_each_side(&raw.hexes, &faces, &fault)?;
    let facets: Vec<[u32; 4]> = faces.outer().map(|f| nodes_of(&raw.hexes, f)).collect();
    let gaps = gaps::check(&raw, &facets, &fault)?;
    raw.notes.extend(gaps);
    raw.notes.extend(flat(&raw, &fault));
    Ok(finished(raw, facets, file, rim))
}

/// See [`Labels::hash`].
fn hash(raw: &Raw) -> String {
    let mut sha = Sha256::new();
    sha.update(bytemuck::cast_slice::<f64, u8>(raw.nodes.as_flattened()));
    sha.update(bytemuck::cast_slice::<u32, u8>(raw.hexes.as_flattened()));
    for set in &raw.sets {
        sha.update(set.name.as_bytes());
        sha.update(bytemuck::cast_slice::<u32, u8>(&set.nodes));
    }
    sha.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

fn finished(mut raw: Raw, facets: Vec<[u32; 4]>, file: &MeshFile, rim: Option<&str>) -> Mesh {
    raw.labels.hash = hash(&raw);
    let mut sets = NodeSets::default();
    raw.sets.iter().for_each(|set| sets.insert(&set.name, &set.meaning, set.nodes.clone()));
    let (axle, found) = axle::of(file, raw.axle, &raw.nodes, rim.and_then(|name| sets.get(name)));
    let surface = Mesh::boundary_nodes(&facets);
    let name = file.path.file_name().unwrap_or_default().to_string_lossy();
    let description = format!("{name}: {}, coordinates in {}; axle {found}", raw.format, file.unit.name);
    Mesh {
        nodes: raw.nodes,
        hexes: raw.hexes,
        facets,
        sets,
        axle,
        description,
        surface,
        labels: Some(Arc::new(raw.labels)),
        notes: raw.notes,
        ..Mesh::default()
    }
}

/// Removes nodes that no element has: they would have no mass.
fn drop_unused(raw: &mut Raw) {
    let mut used = vec![false; raw.nodes.len()];
    raw.hexes.iter().flatten().chain(raw.quads.iter().flatten()).for_each(|&n| used[n as usize] = true);
    let (kept, unused): (Vec<u32>, Vec<u32>) = (0..used.len() as u32).partition(|&n| used[n as usize]);
    if unused.is_empty() {
        return;
    }
    let list = raw.labels.nodes.list(&unused);
    raw.notes.push(format!("{} nodes that no hexahedron has are left out: {list}", unused.len()));
    let mut place = vec![u32::MAX; used.len()];
    kept.iter().enumerate().for_each(|(to, &from)| place[from as usize] = to as u32);
    raw.nodes = kept.iter().map(|&n| raw.nodes[n as usize]).collect();
    raw.labels.nodes = raw.labels.nodes.only(&kept);
    raw.hexes
        .iter_mut()
        .flatten()
        .chain(raw.quads.iter_mut().flatten())
        .for_each(|n| *n = place[*n as usize]);
    for set in &mut raw.sets {
        let before = set.nodes.len();
        set.nodes = set.nodes.iter().map(|&n| place[n as usize]).filter(|&n| n != u32::MAX).collect();
        if set.nodes.is_empty() && before > 0 {
            raw.notes
                .push(format!("the set {:?} has only nodes that no hexahedron has, and is empty", set.name));
        }
    }
}

/// Refuses elements that lie on each other: a face has one element on each side.
fn one_on_each_side(hexes: &[[u32; 8]], faces: &Faces, fault: &Fault) -> Result<()> {
    let element = |face: u32| face / 6;
    for (face, &other) in faces.other.iter().enumerate() {
        let face = face as u32;
        let problem = match other {
            OUTER => continue,
            MANY => format!(
                "a face of element {} belongs to more than two elements",
                fault.elements(&[element(face)])
            ),
            // Seen from the other side nodes run the other way round: only then do the elements lie on both sides.
            _ if runs_with(nodes_of(hexes, face), nodes_of(hexes, other)) => {
                let (a, b) = (element(face), element(other));
                format!("elements {} lie on the same side of a face that they share", fault.elements(&[a, b]))
            }
            _ => continue,
        };
        return Err(fault.error(problem, "remove the elements that are there twice"));
    }
    Ok(())
}

/// Whether two faces with the same nodes have them in the same sense.
fn runs_with(a: [u32; 4], b: [u32; 4]) -> bool {
    let at = |n: u32| b.iter().position(|&m| m == n);
    let (Some(first), Some(second)) = (at(a[0]), at(a[1])) else { return false };
    (first + 1) % 4 == second
}

/// Names elements that are nearly flat.
fn flat(raw: &Raw, fault: &Fault) -> Option<String> {
    let shape = |hex: &[u32; 8]| quality::scaled_jacobian(&hex.map(|n| raw.nodes[n as usize]));
    let flat: Vec<u32> =
        (0..raw.hexes.len() as u32).filter(|&e| shape(&raw.hexes[e as usize]) < quality::FLAT).collect();
    (!flat.is_empty()).then(|| {
        let list = fault.elements(&flat);
        format!("{} elements are nearly flat (scaled Jacobian below {}): {list}", flat.len(), quality::FLAT)
    })
}

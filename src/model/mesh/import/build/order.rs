//! Corners in the order that elements here have; elements that are inside out in any order.

use super::super::raw::Raw;
use super::fault::Fault;
use crate::error::Result;
use crate::model::mesh::quality::corner_jacobians;

/// Orders that programs write by mistake, as corners of ours: the other face first, which mirrors the element; rows instead of
/// circles, as voxels have them; both.
const ORDERS: [[usize; 8]; 3] =
    [[4, 5, 6, 7, 0, 1, 2, 3], [0, 1, 3, 2, 4, 5, 7, 6], [4, 5, 7, 6, 0, 1, 3, 2]];

/// Puts the corners of every element in order.
///
/// # Errors
/// Elements with a node twice, or with a volume that is not positive at each corner in any order.
pub fn mend(raw: &mut Raw, fault: &Fault) -> Result<()> {
    let collapsed: Vec<u32> =
        (0..raw.hexes.len() as u32).filter(|&e| has_twice(&raw.hexes[e as usize])).collect();
    if !collapsed.is_empty() {
        let list = fault.elements(&collapsed);
        let problem =
            format!("{} elements have a node twice (wedges written as hexahedra?): {list}", collapsed.len());
        return Err(fault.error(
            problem,
            "mesh with hexahedra of eight nodes alone; if nodes were merged, make body.mesh.merge smaller",
        ));
    }
    let (mut mended, mut refused) = (Vec::new(), Vec::new());
    let nodes = &raw.nodes;
    for (e, hex) in raw.hexes.iter_mut().enumerate() {
        let good =
            |hex: &[u32; 8]| corner_jacobians(&hex.map(|n| nodes[n as usize])).iter().all(|j| j[0] > 0.0);
        if good(hex) {
            continue;
        }
        match ORDERS.iter().map(|order| order.map(|c| hex[c])).find(good) {
            Some(other) => {
                *hex = other;
                mended.push(e as u32);
            }
            None => refused.push(e as u32),
        }
    }
    if !refused.is_empty() {
        let e = refused[0] as usize;
        let jacobians = corner_jacobians(&raw.hexes[e].map(|n| nodes[n as usize]));
        let worst =
            (0..8).min_by(|&a, &b| jacobians[a][1].total_cmp(&jacobians[b][1])).expect("eight corners");
        let at = fault.nodes(&[raw.hexes[e][worst]]);
        let problem = format!(
            "{} elements are inside out or flat: {}; the first at its node {at}, where its scaled Jacobian is {:.3}",
            refused.len(),
            fault.elements(&refused),
            jacobians[worst][1]
        );
        return Err(fault.error(problem, "mend these elements in the program that made the mesh"));
    }
    if !mended.is_empty() {
        let list = fault.elements(&mended);
        raw.notes.push(format!(
            "{} elements had their corners in another order, which was mended: {list}",
            mended.len()
        ));
    }
    Ok(())
}

fn has_twice(hex: &[u32; 8]) -> bool {
    (1..8).any(|c| hex[..c].contains(&hex[c]))
}

//! The fields a picture can be coloured by.

use crate::model::mesh::Mesh;
use crate::record::Snapshot;
use crate::scene::Field;
use crate::{Error, Result};

/// A field's values in SI units.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Shape `[node_count]`, drawn interpolated.
    Nodes(Vec<f64>),
    /// Shape `[element_count]`, drawn flat.
    Elements(Vec<f64>),
}

impl Values {
    /// Values at the four corners of a facet of `element`.
    pub fn corners(&self, facet: [u32; 4], element: u32) -> [f64; 4] {
        match self {
            Values::Nodes(values) => facet.map(|n| values[n as usize]),
            Values::Elements(values) => [values[element as usize]; 4],
        }
    }
}

/// Name, SI unit, and whether the field is a magnitude (never negative).
pub fn describe(field: Field) -> (&'static str, &'static str, bool) {
    match field {
        Field::Displacement => ("Displacement", "m", true),
        Field::Velocity => ("Speed", "m/s", true),
        Field::ContactForce => ("Contact force", "N", true),
        Field::Pressure => ("Pressure", "Pa", false),
        Field::VolumeRatio => ("Volume ratio J", "", false),
        Field::VonMises => ("Von Mises stress", "Pa", true),
        Field::FrictionEnergy => ("Friction energy", "J/m²", false),
    }
}

/// Values of `field`; [`Error::Picture`] if the snapshot does not have them for every node or element.
pub fn values(field: Field, mesh: &Mesh, snapshot: &Snapshot) -> Result<Values> {
    let values = match field {
        Field::Displacement => {
            let pairs = snapshot.x.iter().zip(&mesh.nodes);
            Values::Nodes(pairs.map(|(x, X)| length([x[0] - X[0], x[1] - X[1], x[2] - X[2]])).collect())
        }
        Field::Velocity => Values::Nodes(snapshot.v.iter().copied().map(length).collect()),
        Field::ContactForce => {
            let mut forces = vec![0.0; mesh.nodes.len()];
            for contact in &snapshot.contact {
                forces[contact.node as usize] = length(contact.force);
            }
            Values::Nodes(forces)
        }
        Field::Pressure => Values::Elements(snapshot.pressure.clone()),
        Field::VolumeRatio => Values::Elements(snapshot.volume_ratio.clone()),
        Field::VonMises => Values::Elements(snapshot.von_mises.clone()),
        Field::FrictionEnergy => {
            let areas = reference_areas(mesh);
            let mut energies = vec![0.0; mesh.nodes.len()];
            for contact in &snapshot.contact {
                let n = contact.node as usize;
                energies[n] = contact.friction_energy / areas[n];
            }
            Values::Nodes(energies)
        }
    };
    let (got, wanted, what) = match &values {
        Values::Nodes(v) => (v, mesh.nodes.len(), "nodes"),
        Values::Elements(v) => (v, mesh.hexes.len(), "elements"),
    };
    let name = describe(field).0;
    if got.len() != wanted {
        let problem = format!("{name} has {} values for {wanted} {what}", got.len());
        return Err(Error::Picture { problem });
    }
    match got.iter().position(|v| !v.is_finite()) {
        Some(at) => Err(Error::Picture { problem: format!("{name} is {} at {what} {at}", got[at]) }),
        None => Ok(values),
    }
}

/// Area of the reference surface nearest to each node: a quarter of every facet beside it, zero inside.
fn reference_areas(mesh: &Mesh) -> Vec<f64> {
    let mut areas = vec![0.0; mesh.nodes.len()];
    for facet in &mesh.facets {
        let [a, b, c, d] = facet.map(|n| mesh.nodes[n as usize]);
        let across = |p: [f64; 3], q: [f64; 3]| [q[0] - p[0], q[1] - p[1], q[2] - p[2]];
        let ([x, y, z], [u, v, w]) = (across(a, c), across(b, d));
        let area = 0.5 * length([y * w - z * v, z * u - x * w, x * v - y * u]);
        facet.iter().for_each(|&n| areas[n as usize] += 0.25 * area);
    }
    areas
}

/// Checks that a snapshot belongs to the mesh: positions for every node, contact at its nodes.
pub fn check(mesh: &Mesh, snapshot: &Snapshot) -> Result<()> {
    let count = mesh.nodes.len();
    let problem = if snapshot.x.len() != count {
        format!("the snapshot has {} positions for {count} nodes", snapshot.x.len())
    } else if let Some(node) = snapshot.x.iter().position(|x| x.iter().any(|c| !c.is_finite())) {
        format!("the position of node {node} is not finite")
    } else if let Some(c) = snapshot.contact.iter().find(|c| c.node as usize >= count) {
        format!("the snapshot has contact at node {}, but the mesh has {count} nodes", c.node)
    } else if let Some(c) = snapshot.contact.iter().find(|c| c.force.iter().any(|f| !f.is_finite())) {
        format!("the contact force at node {} is not finite", c.node)
    } else {
        return Ok(());
    };
    Err(Error::Picture { problem })
}

/// Length of a vector.
fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

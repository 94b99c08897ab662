//! What touches the road in a snapshot, in the road's own coordinates.

use glam::{DVec2, DVec3};

use super::road::{Axes, Chart};
use super::surface::{edges, median_length};
use crate::model::mesh::Mesh;
use crate::record::{ContactState, Snapshot};
use crate::scene::Road;

/// A touching node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    pub node: u32,
    pub x: DVec3,
    /// Coordinates in the road's plane [m].
    pub flat: DVec2,
    /// Normal force of the road on the node [N].
    pub normal: f64,
    /// Force over deformed area [Pa].
    pub pressure: f64,
    /// Tangential force of the road on the node, in the plane's axes [N].
    pub shear: DVec2,
    pub slips: bool,
}

/// The touching nodes with the surroundings that a picture of them shows.
#[derive(Debug, Clone)]
pub struct Contact {
    pub chart: Chart,
    /// Axes in the middle of the shown part.
    pub axes: Axes,
    pub touches: Vec<Touch>,
    /// Corners of the shown part of the road in its own coordinates [m].
    pub low: DVec2,
    pub high: DVec2,
    /// Typical distance of neighbouring nodes [m].
    pub spacing: f64,
    /// Facets that may be seen from the road within the shown part.
    pub facets: Vec<[u32; 4]>,
}

impl Contact {
    /// Reads a checked snapshot.
    pub fn of(mesh: &Mesh, snapshot: &Snapshot, road: Road) -> Contact {
        let chart = Chart(road);
        let touches = touches(snapshot, &chart);
        let shown = shown_nodes(mesh, snapshot, &chart);
        let near: Vec<[u32; 4]> =
            mesh.facets.iter().filter(|f| f.iter().any(|&n| shown[n as usize])).copied().collect();
        let spacing = median_length(&edges(&near), &snapshot.x);
        let flats = || (0..shown.len()).filter(|&n| shown[n]).map(|n| chart.flat(DVec3::from(snapshot.x[n])));
        let low = flats().reduce(DVec2::min).unwrap_or(DVec2::ZERO);
        let high = flats().reduce(DVec2::max).unwrap_or(DVec2::ZERO);
        // Room for arrows around the outermost nodes, and something to see if only one node touches.
        let margin = DVec2::splat((0.06 * (high - low).max_element()).max(1.3 * spacing));
        let (low, high) = (low - margin, high + margin);
        let facets = facing_facets(mesh, snapshot, &chart, (high - low).length());
        let axes = chart.axes(chart.at(0.5 * (low + high), 0.0));
        Contact { chart, axes, touches, low, high, spacing, facets }
    }

    /// Largest tangential force [N]; zero where it is nothing but the round-off of the normal forces.
    pub fn largest_shear(&self) -> f64 {
        let largest = |force: fn(&Touch) -> f64| self.touches.iter().map(force).fold(0.0, f64::max);
        let (shear, normal) = (largest(|t| t.shear.length()), largest(|t| t.normal));
        if shear > 1e-6 * normal { shear } else { 0.0 }
    }

    /// Total force of the road on the body: along, across, normal [N].
    pub fn total(&self) -> [f64; 3] {
        let shear: DVec2 = self.touches.iter().map(|t| t.shear).sum();
        [shear.x, shear.y, self.touches.iter().map(|t| t.normal).sum()]
    }

    /// Corners of the shown part as points in space.
    pub fn corners(&self) -> [DVec3; 4] {
        let (l, h) = (self.low, self.high);
        [l, DVec2::new(h.x, l.y), h, DVec2::new(l.x, h.y)].map(|c| self.chart.at(c, 0.0))
    }
}

fn touches(snapshot: &Snapshot, chart: &Chart) -> Vec<Touch> {
    let touching = snapshot.contact.iter().filter(|c| c.state != ContactState::Free);
    touching
        .map(|c| {
            let (x, force) = (DVec3::from(snapshot.x[c.node as usize]), DVec3::from(c.force));
            let axes = chart.axes(x);
            Touch {
                node: c.node,
                x,
                flat: chart.flat(x),
                normal: axes.normal.dot(force),
                pressure: c.pressure,
                shear: DVec2::new(axes.along.dot(force), axes.across.dot(force)),
                slips: c.state == ContactState::Slip,
            }
        })
        .collect()
}

/// Which nodes touch, shape `[node_count]`.
pub fn touching(mesh: &Mesh, snapshot: &Snapshot) -> Vec<bool> {
    let mut touching = vec![false; mesh.nodes.len()];
    for contact in snapshot.contact.iter().filter(|c| c.state != ContactState::Free) {
        touching[contact.node as usize] = true;
    }
    touching
}

/// The touching nodes; without any, those nearest to the road.
fn shown_nodes(mesh: &Mesh, snapshot: &Snapshot, chart: &Chart) -> Vec<bool> {
    let touching = touching(mesh, snapshot);
    if touching.contains(&true) {
        return touching;
    }
    let gaps: Vec<f64> = snapshot.x.iter().map(|&x| chart.gap(x.into())).collect();
    let lowest = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = gaps.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    gaps.iter().map(|g| g - lowest <= 0.02 * (highest - lowest)).collect()
}

/// Facets that face the road and are not farther from it than `reach`.
fn facing_facets(mesh: &Mesh, snapshot: &Snapshot, chart: &Chart, reach: f64) -> Vec<[u32; 4]> {
    let faces = |facet: &&[u32; 4]| {
        let c = facet.map(|n| DVec3::from(snapshot.x[n as usize]));
        let gap = c.iter().map(|&x| chart.gap(x)).fold(f64::INFINITY, f64::min);
        let normal = (c[2] - c[0]).cross(c[3] - c[1]);
        gap < reach && normal.dot(chart.axes(c[0]).normal) < 0.0
    };
    mesh.facets.iter().filter(faces).copied().collect()
}

/// Where the body goes relative to the road below the contact, along the contact's axes; `None` if it does not go anywhere.
pub fn travel(mesh: &Mesh, snapshot: &Snapshot, contact: &Contact) -> Option<DVec2> {
    if snapshot.v.len() != mesh.nodes.len() {
        return None;
    }
    let Contact { chart, axes, low, high, .. } = contact;
    let middle = chart.at(0.5 * (*low + *high), 0.0);
    let velocity = DVec3::from(chart.0.velocity(middle.to_array()));
    let relative = |v: [f64; 3]| DVec3::from(v) - velocity;
    let mean = snapshot.v.iter().map(|&v| relative(v)).sum::<DVec3>() / snapshot.v.len() as f64;
    let flat = DVec2::new(axes.along.dot(mean), axes.across.dot(mean));
    let fastest = snapshot.v.iter().map(|&v| relative(v).length()).fold(0.0, f64::max);
    // Vibration alone moves the mean a little: below one part in fifty there is no direction to show.
    (flat.length() > 0.02 * fastest).then(|| flat.normalize())
}

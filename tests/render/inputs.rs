//! The wheel of the pictures, at rest and as if it rolled.

use hexroll::model::mesh::Mesh;
use hexroll::record::{ContactNode, ContactState, Snapshot};
use hexroll::scene::MeshSpec;

pub const OUTER: f64 = 39e-3;
pub const INNER: f64 = 17e-3;
pub const WIDTH: f64 = 17.5e-3;

pub fn wheel(scale: f64) -> Mesh {
    let spec = MeshSpec::Ring {
        outer_radius: OUTER * scale,
        inner_radius: INNER * scale,
        width: WIDTH * scale,
        elements: [44, 4, 5],
    };
    Mesh::generate(&spec).with_rim("inner").expect("a ring has an inner cylinder")
}

/// The wheel as built: nothing deformed, nothing touching.
pub fn at_rest(mesh: &Mesh) -> Snapshot {
    let elements = mesh.hexes.len();
    Snapshot {
        time: 0.0,
        x: mesh.nodes.clone(),
        v: vec![[0.0; 3]; mesh.nodes.len()],
        pressure: vec![0.0; elements],
        von_mises: vec![0.0; elements],
        volume_ratio: vec![1.0; elements],
        axle: Some((mesh.axle, [[1., 0., 0.], [0., 1., 0.], [0., 0., 1.]])),
        ..Snapshot::default()
    }
}

/// A made-up rolling wheel: lowered by 2.2 mm, flat at the road, turned a little; a parabolic pressure over
/// the patch, shear that drives, and slip where it is largest.
pub fn rolling(mesh: &Mesh, scale: f64) -> Snapshot {
    let mut snapshot = at_rest(mesh);
    let sink = 2.2e-3 * scale;
    let (sin, cos) = 0.1_f64.sin_cos();
    let axle = [5e-3 * scale, 0.0, mesh.axle[2] - sink];
    for (x, X) in snapshot.x.iter_mut().zip(&mesh.nodes) {
        let (dx, dz) = (X[0] - mesh.axle[0], X[2] - mesh.axle[2]);
        *x = [axle[0] + cos * dx + sin * dz, X[1], axle[2] - sin * dx + cos * dz];
        if x[2] < 0.012 * scale {
            // Squeezed towards the road, bulging sideways.
            let depth = (0.012 * scale - x[2]) / (0.0142 * scale);
            x[1] *= 1.0 + 0.12 * depth * depth;
            x[2] = x[2].max(0.0);
        }
    }
    snapshot.time = 30e-3;
    snapshot.axle = Some((axle, [[cos, 0., sin], [0., 1., 0.], [-sin, 0., cos]]));
    for (v, x) in snapshot.v.iter_mut().zip(&snapshot.x) {
        *v = [2.58 + 70.0 * (x[2] - axle[2]), 0.0, -70.0 * (x[0] - axle[0])];
    }
    for (element, hex) in mesh.hexes.iter().enumerate() {
        let middle = |d: usize| hex.iter().map(|&n| snapshot.x[n as usize][d]).sum::<f64>() / 8.0;
        let (dx, dz) = (middle(0) - axle[0], middle(2));
        let load = (-(dx * dx + dz * dz) / (0.012 * scale).powi(2)).exp();
        snapshot.pressure[element] = 0.9e6 * load - 0.05e6;
        snapshot.von_mises[element] = 1.3e6 * load + 0.1e6 * (1.0 - dz / (0.08 * scale)).abs();
        snapshot.volume_ratio[element] = 1.0 - 0.011 * load;
    }
    snapshot.contact = patch(mesh, &snapshot, axle[0], scale);
    snapshot
}

fn patch(mesh: &Mesh, snapshot: &Snapshot, middle: f64, scale: f64) -> Vec<ContactNode> {
    let half = 13e-3 * scale;
    let node = |&node: &u32| {
        let x = snapshot.x[node as usize];
        let s = (x[0] - middle) / half;
        if x[2] > 1e-9 || s.abs() >= 1.0 {
            let (force, area, pressure, slip_speed) = ([0.0; 3], 0.0, 0.0, 0.0);
            let (friction_energy, state) = (0.0, ContactState::Free);
            return ContactNode { node, force, area, pressure, slip_speed, friction_energy, state };
        }
        let area = 1.9e-5 * scale * scale;
        let pressure = 0.75e6 * (1.0 - s * s) * (1.0 - 0.3 * (x[1] / (9e-3 * scale)).powi(2));
        let normal = pressure * area;
        let slips = s < -0.35;
        let shear = if slips { normal } else { 0.6 * normal * (0.75 - s) };
        let force = [0.97 * shear, 0.24 * shear * x[1] / (9e-3 * scale), normal];
        let state = if slips { ContactState::Slip } else { ContactState::Stick };
        let (slip_speed, friction_energy) = if slips { (0.3, 2e-6 * normal) } else { (0.0, 0.0) };
        ContactNode { node, force, area, pressure, slip_speed, friction_energy, state }
    };
    mesh.surface.iter().map(node).collect()
}

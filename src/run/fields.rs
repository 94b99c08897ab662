//! Whole fields of a snapshot, from positions alone and in f64 whatever engine ran: stresses, volumes, areas.

use crate::cpu::element_forces;
use crate::engine::{State, Window};
use crate::model::Model;
use crate::model::mesh::Mesh;
use crate::physics::element::hex8;
use crate::physics::rim;
use crate::physics::tensor::{add, cross, dot, scale, sub};
use crate::record::{ContactNode, ContactState, Snapshot};
use crate::scene::Road;

/// Tributary areas of the surface nodes [m2], shape `[surface_count]`: the quarters nearest to each node of its
/// deformed facets, projected on the road, of facets that face it. Without a road: empty.
pub fn contact_areas(mesh: &Mesh, x: impl Fn(u32) -> [f64; 3], road: &Road) -> Vec<f64> {
    let mut areas = vec![0.0; mesh.surface.len()];
    quarters(mesh, x, road, |k, area, _| areas[k] += area);
    areas
}

/// Extents of the quarters of some nodes, `touches` by their index in the surface, along the unit directions [m].
pub fn extents(
    mesh: &Mesh,
    x: impl Fn(u32) -> [f64; 3],
    road: &Road,
    touches: impl Fn(usize) -> bool,
    directions: [[f64; 3]; 2],
) -> [f64; 2] {
    let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    quarters(mesh, x, road, |k, _, corners| {
        if touches(k) {
            for (bound, direction) in bounds.iter_mut().zip(&directions) {
                for corner in corners {
                    let at = dot(*corner, *direction);
                    *bound = [bound[0].min(at), bound[1].max(at)];
                }
            }
        }
    });
    bounds.map(|[low, high]| (high - low).max(0.0))
}

/// Calls `visit` with every quarter of a facet that faces the road: index in the surface of the node it belongs to,
/// projected area, corners.
fn quarters(
    mesh: &Mesh,
    x: impl Fn(u32) -> [f64; 3],
    road: &Road,
    mut visit: impl FnMut(usize, f64, &[[f64; 3]; 4]),
) {
    let Road::Plane { normal, .. } = road;
    for facet in &mesh.facets {
        let p = facet.map(&x);
        let middle = |a: usize, b: usize| scale(add(p[a], p[b]), 0.5);
        let centre = scale(add(middle(0, 1), middle(2, 3)), 0.5);
        for a in 0..4 {
            let Ok(k) = mesh.surface.binary_search(&facet[a]) else { continue };
            let (before, after) = (middle((a + 3) % 4, a), middle(a, (a + 1) % 4));
            let doubled = cross(sub(centre, p[a]), sub(before, after));
            let area = -0.5 * dot(doubled, *normal);
            if area > 0.0 {
                visit(k, area, &[p[a], after, centre, before]);
            }
        }
    }
}

/// A snapshot at the end of a window.
pub fn snapshot(
    model: &Model,
    road: Option<&Road>,
    time: f64,
    step: u64,
    length: f64,
    state: State,
    window: &Window,
    friction_energy: &[f64],
) -> Snapshot {
    let contact =
        road.map(|r| contact_nodes(model, r, length, &state, window, friction_energy)).unwrap_or_default();
    let (mut volume_ratio, mut pressure, mut von_mises) = (Vec::new(), Vec::new(), Vec::new());
    for (hex, &class) in model.mesh.hexes.iter().zip(&model.class_of) {
        let corners = hex.map(|n| state.x[n as usize]);
        let f = element_forces(model, class as usize, &corners, &[[0.0; 3]; 8]);
        let volume = hex8::volume(&corners);
        let sigma = mean_stress(&corners, &f, volume);
        let p = -(sigma[0][0] + sigma[1][1] + sigma[2][2]) / 3.0;
        let s = |i: usize, j: usize| sigma[i][j] + if i == j { p } else { 0.0 };
        let norm2: f64 = (0..9).map(|i| s(i / 3, i % 3) * s(i / 3, i % 3)).sum();
        volume_ratio.push(volume / model.classes[class as usize].volume);
        pressure.push(p);
        von_mises.push((1.5 * norm2).sqrt());
    }
    let axle = (!model.mesh.rim.is_empty()).then(|| {
        let r = rim::rotation(&window.rim).transpose().to_cols_array_2d();
        (rim::axle(&window.rim).to_array(), r)
    });
    Snapshot { time, step, x: state.x, v: state.v, contact, volume_ratio, pressure, von_mises, axle }
}

/// Volume mean of the Cauchy stress: sum_a f_a (x) x_a / v, since the force matrix times A^T is sigma det A.
fn mean_stress(x: &[[f64; 3]; 8], f: &[[f64; 3]; 8], volume: f64) -> [[f64; 3]; 3] {
    let product = |i: usize, j: usize| (0..8).map(|a| f[a][i] * x[a][j]).sum::<f64>();
    std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (product(i, j) + product(j, i)) / volume))
}

fn contact_nodes(
    model: &Model,
    road: &Road,
    length: f64,
    state: &State,
    window: &Window,
    friction_energy: &[f64],
) -> Vec<ContactNode> {
    let Road::Plane { normal, velocity, .. } = *road;
    let areas = contact_areas(&model.mesh, |n| state.x[n as usize], road);
    let node = |(k, ((&node, sum), area)): (usize, ((&u32, &crate::engine::SurfaceSum), f64))| {
        // Before the first window there is no impulse and no time.
        let force = sum.impulse.map(|i| if length > 0.0 { i / length } else { 0.0 });
        let relative = sub(sum.v, velocity);
        let slip = sub(relative, scale(normal, dot(relative, normal)));
        let touched = sum.touching > 0;
        let state = match (touched, 2 * sum.sticking >= sum.touching) {
            (false, _) => ContactState::Free,
            (true, true) => ContactState::Stick,
            (true, false) => ContactState::Slip,
        };
        let pressure = if area > 0.0 { dot(force, normal) / area } else { 0.0 };
        let slip_speed = if touched { dot(slip, slip).sqrt() } else { 0.0 };
        let friction_energy = friction_energy.get(k).copied().unwrap_or(0.0);
        ContactNode { node, force, area, pressure, slip_speed, friction_energy, state }
    };
    model.mesh.surface.iter().zip(&window.surface).zip(areas).enumerate().map(node).collect()
}

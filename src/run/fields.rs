//! Whole fields of a snapshot, from positions alone and in f64 whatever engine ran: stresses, volumes, areas.

use crate::engine::{State, Window};
use crate::model::Model;
use crate::model::areas::contact_areas;
use crate::physics::element::hex8;
use crate::physics::rim;
use crate::physics::tensor::{dot, scale, sub};
use crate::record::{ContactNode, ContactState, Snapshot};
use crate::scene::Road;

/// The end of a window: time, steps taken so far, and the time over which the window's forces acted [s].
pub struct Moment {
    pub time: f64,
    pub step: u64,
    pub length: f64,
}

/// A snapshot at the end of a window.
pub fn snapshot(
    model: &Model,
    road: Option<&Road>,
    &Moment { time, step, length }: &Moment,
    state: State,
    window: &Window,
    friction_energy: &[f64],
) -> Snapshot {
    let contact =
        road.map(|r| contact_nodes(model, r, length, &state, window, friction_energy)).unwrap_or_default();
    let (mut volume_ratio, mut pressure, mut von_mises) = (Vec::new(), Vec::new(), Vec::new());
    for (hex, &class) in model.mesh.hexes.iter().zip(&model.class_of) {
        let corners = hex.map(|n| state.x[n as usize]);
        let f = model.element_forces(class as usize, &corners, &[[0.0; 3]; 8]);
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
    Snapshot {
        time,
        step,
        force_time: length,
        x: state.x,
        v: state.v,
        contact,
        volume_ratio,
        pressure,
        von_mises,
        axle,
    }
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
    let areas = contact_areas(&model.mesh, |n| state.x[n as usize], road, |_| true);
    let node = |(k, ((&node, sum), area)): (usize, ((&u32, &crate::engine::SurfaceSum), f64))| {
        // Before the first window there is no impulse and no time.
        let force = sum.impulse.map(|i| if length > 0.0 { i / length } else { 0.0 });
        let (normal, velocity) = (road.normal(sum.x), road.velocity(sum.x));
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

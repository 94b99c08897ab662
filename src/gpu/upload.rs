//! What a model becomes on the device: constants of the kernels, and every buffer with its content.

use super::Gpu;
use super::buffers::{self, Buffers, PLAN, STEP_STRIDE, vec4};
use super::chains::{Chains, LANES};
use super::compose::Choice;
use super::engine::{Counts, GROUP, PARTIALS};
use super::layout::{self, RimSum, SurfaceRecord};
use crate::model::mesh::Mesh;
use crate::model::{Model, areas};
use crate::scene::{Friction, Road, Scene};

/// Node roles, as in shaders/lib/nodes.wgsl.
const INTERIOR: u32 = 0xffff_ffff;
const RIM: u32 = 0x8000_0000;

/// Values of every constant a kernel may declare.
pub fn constants(model: &Model, scene: &Scene, chains: &Chains) -> Vec<(&'static str, f64)> {
    use crate::scene::Law::*;
    let [g0, g1, g2] = match model.law {
        NeoHookean { g0, g1 } => [g0, g1, 0.0],
        MooneyRivlin { g0, g1, g2 } | MooneyRivlinEq4 { g0, g1, g2 } => [g0, g1, g2],
    };
    let mut all = vec![("g0", g0), ("g1", g1), ("g2", g2), ("eta", model.viscosity.unwrap_or(0.0))];
    all.extend(["gravity_x", "gravity_y", "gravity_z"].into_iter().zip(scene.gravity));
    all.extend(chains.lattice.iter().flat_map(|l| l.constants(chains.longest)));
    all.extend(scene.friction.iter().flat_map(friction_constants));
    if let Some(Road::Plane { point, normal, velocity }) = scene.road {
        all.extend(["normal_x", "normal_y", "normal_z"].into_iter().zip(normal));
        all.extend(["road_velocity_x", "road_velocity_y", "road_velocity_z"].into_iter().zip(velocity));
        // Seen from the frame: it moves only along the road.
        all.push(("road_offset", (0..3).map(|d| normal[d] * point[d]).sum()));
    }
    all
}

fn friction_constants(law: &Friction) -> Vec<(&'static str, f64)> {
    match *law {
        Friction::Coulomb { mu } => vec![("mu", mu)],
        Friction::Viscous { slope } => vec![("friction_slope", slope)],
        Friction::Stribeck { still, kinetic, speed, slope } => vec![
            ("friction_still", still),
            ("friction_kinetic", kinetic),
            ("friction_inverse_speed", 1.0 / speed),
            ("friction_slope", slope),
        ],
        Friction::PressureVelocity { a, b, pressure, c, speed } => vec![
            ("friction_a", a),
            ("friction_b", b),
            ("friction_inverse_pressure", 1.0 / pressure),
            ("friction_c", c),
            ("friction_inverse_speed", 1.0 / speed),
        ],
    }
}

/// One over the area of every surface node with the nodes at `x` [1/m2].
pub fn inverse_areas(mesh: &Mesh, x: impl Fn(u32) -> [f64; 3], road: &Road) -> Vec<f32> {
    areas::inverse_areas(mesh, x, road).into_iter().map(|a| a as f32).collect()
}

/// Every buffer of a run, filled.
pub fn upload(
    gpu: &Gpu,
    model: &Model,
    chains: &Chains,
    choice: &Choice,
    counts: &Counts,
    frame: [f64; 3],
    road: Option<&Road>,
) -> Buffers {
    let mut b = Buffers::default();
    let mesh = &model.mesh;
    b.filled(gpu, "chain_groups", &chains.groups);
    b.filled(gpu, "chain_classes", &chains.classes);
    buffers::upload_classes(&mut b, gpu, model, chains.shared_classes);
    if chains.lattice.is_none() {
        b.filled(gpu, "chain_nodes", &chains.nodes);
        b.filled(gpu, "chain_elements", &chains.elements);
        b.filled(gpu, "corner_start", &chains.start);
        b.filled(gpu, "corners", &chains.slots);
    }
    b.filled(gpu, "roles", &roles(model, choice.road));
    b.filled(gpu, "rim_nodes", &mesh.rim);
    let arm = |&n: &u32| vec4(std::array::from_fn(|d| mesh.nodes[n as usize][d] - mesh.axle[d]));
    b.filled(gpu, "rim_arms", &mesh.rim.iter().map(arm).collect::<Vec<_>>());
    let surface = if choice.road { &mesh.surface[..] } else { &[] };
    b.filled(gpu, "surface_nodes", surface);
    b.filled(gpu, "boundary", &[surface, &mesh.rim].concat());
    if choice.held {
        b.filled(gpu, "held", &mesh.held.iter().map(|&bits| u32::from(bits)).collect::<Vec<u32>>());
    }
    if let (Some(road), true) = (road, choice.friction.is_some_and(|law| law.needs_area())) {
        b.filled(gpu, "inverse_areas", &inverse_areas(mesh, |n| mesh.nodes[n as usize], road));
    }
    let (hi, lo) = split(&mesh.nodes, frame, &masses(model, choice.road));
    b.filled(gpu, "positions", &hi);
    if choice.plus {
        b.filled(gpu, "positions_lo", &lo);
    }
    b.zeroed::<[f32; 4]>(gpu, "velocities", counts.nodes);
    b.zeroed::<[f32; 4]>(gpu, "slots", chains.slot_count());
    let threads = LANES * chains.groups.len();
    b.zeroed::<[f32; 4]>(gpu, "energies", threads);
    b.zeroed::<f32>(gpu, "viscous_work", if choice.viscous { threads } else { 1 });
    b.zeroed::<RimSum>(gpu, "rim_sums", counts.rim);
    b.zeroed::<SurfaceRecord>(gpu, "surface_sums", counts.surface);
    b.zeroed::<[f32; 4]>(gpu, "surface_states", 2 * counts.surface);
    b.zeroed::<u32>(gpu, "contact_states", counts.surface);
    b.zeroed::<[f32; 4]>(gpu, "contact_steps", counts.contact_slots() * counts.surface.div_ceil(GROUP));
    b.zeroed::<[f32; 4]>(gpu, "probes", 4 * counts.nodes.div_ceil(GROUP));
    b.zeroed::<layout::RimState>(gpu, "rim_state", 1);
    b.zeroed::<layout::RimState>(gpu, "rim_state_probe", 1);
    for (name, width) in [
        ("partials_rim", 2),
        ("partials_viscous", 1),
        ("kept_viscous", 1),
        ("partials_probes", 4),
        ("partials_energies", 1),
    ] {
        b.zeroed::<[f32; 4]>(gpu, name, width * PARTIALS);
    }
    b.filled(gpu, "failure", &[u32::MAX; 4]);
    // No step has this index: a submission that does nothing is noticed, the first one too.
    b.filled(gpu, "done", &[u32::MAX; 4]);
    b.uniform(gpu, "step", PLAN * STEP_STRIDE);
    b.zeroed::<layout::Step>(gpu, "plan", PLAN);
    b.uniform(gpu, "batch", size_of::<layout::Batch>());
    b.uniform(gpu, "shift", 16);
    b
}

/// Positions relative to the frame, as single-precision hi and lo parts, with the masses beside them.
pub fn split(x: &[[f64; 3]], frame: [f64; 3], masses: &[f32]) -> (Vec<[f32; 4]>, Vec<[f32; 4]>) {
    let pair = |(x, &mass): (&[f64; 3], &f32)| {
        let local: [f64; 3] = std::array::from_fn(|d| x[d] - frame[d]);
        let [a, b, c, _] = vec4(local);
        let low = vec4(local.map(|v| v - f64::from(v as f32)));
        ([a, b, c, mass], low)
    };
    x.iter().zip(masses).map(pair).unzip()
}

/// Mass of each node [kg], negative if it can touch the road or belongs to the rim.
pub fn masses(model: &Model, road: bool) -> Vec<f32> {
    let mut masses: Vec<f32> = model.mass.iter().map(|&m| m as f32).collect();
    let surface = if road { &model.mesh.surface[..] } else { &[] };
    surface.iter().chain(&model.mesh.rim).for_each(|&n| masses[n as usize] *= -1.0);
    masses
}

fn roles(model: &Model, road: bool) -> Vec<u32> {
    let mut roles = vec![INTERIOR; model.node_count()];
    if road {
        for (k, &n) in model.mesh.surface.iter().enumerate() {
            roles[n as usize] = k as u32;
        }
    }
    for (k, &n) in model.mesh.rim.iter().enumerate() {
        roles[n as usize] = RIM | k as u32;
    }
    roles
}

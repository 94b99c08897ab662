//! What a model becomes on the device: constants of the kernels, and every buffer with its content.

use super::Gpu;
use super::buffers::{self, Buffers, PLAN, STEP_STRIDE, part_stride, vec4};
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

/// Words of a body's flags.
const FLAGS: usize = 4;
/// Bodies of one dispatch at most, as in shaders/lib/member.wgsl.
pub const MEMBERS: usize = 512;

/// The part of the body number `body` of a dispatch in which it takes `steps`.
pub fn member(counts: &Counts, body: usize, steps: usize) -> layout::Member {
    let at = |count: usize| (body * part_stride(count)) as u32;
    layout::Member {
        steps: steps as u32,
        nodes: at(counts.nodes),
        surface: at(counts.surface),
        rim: at(counts.rim),
        chains: at(LANES * counts.chain_groups),
        plan: at(PLAN),
        contact: at(counts.contact_records()),
        flags: at(FLAGS),
    }
}

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

/// A table that no kernel writes.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    name: &'static str,
    bytes: Vec<u8>,
    /// Size of the uniform buffer it begins, if it is one [bytes].
    uniform: Option<usize>,
}

/// Every table of a body: what bodies must have in common to share a dispatch, beside the kernels.
pub fn tables(model: &Model, chains: &Chains, choice: &Choice) -> Vec<Table> {
    let mesh = &model.mesh;
    let table = |name, bytes: &[u8]| Table { name, bytes: bytes.to_vec(), uniform: None };
    let mut all = vec![
        table("chain_groups", bytemuck::cast_slice(&chains.groups)),
        table("chain_classes", bytemuck::cast_slice(&chains.classes)),
        Table {
            name: "classes",
            bytes: buffers::classes(model),
            uniform: chains.shared_classes.then(|| buffers::shared_classes_size(model.element)),
        },
    ];
    if chains.lattice.is_none() {
        all.extend([
            table("chain_nodes", bytemuck::cast_slice(&chains.nodes)),
            table("chain_elements", bytemuck::cast_slice(&chains.elements)),
            table("corner_start", bytemuck::cast_slice(&chains.start)),
            table("corners", bytemuck::cast_slice(&chains.slots)),
        ]);
    }
    let arm = |&n: &u32| vec4(std::array::from_fn(|d| mesh.nodes[n as usize][d] - mesh.axle[d]));
    let arms: Vec<[f32; 4]> = mesh.rim.iter().map(arm).collect();
    let surface = if choice.road { &mesh.surface[..] } else { &[] };
    all.extend([
        table("roles", bytemuck::cast_slice(&roles(model, choice.road))),
        table("rim_nodes", bytemuck::cast_slice(&mesh.rim)),
        table("rim_arms", bytemuck::cast_slice(&arms)),
        table("surface_nodes", bytemuck::cast_slice(surface)),
        table("boundary", bytemuck::cast_slice(&[surface, &mesh.rim].concat())),
    ]);
    if choice.held {
        let bits: Vec<u32> = mesh.held.iter().map(|&bits| u32::from(bits)).collect();
        all.push(table("held", bytemuck::cast_slice(&bits)));
    }
    all
}

/// Buffers of `bodies` bodies with these tables, which they share, and this choice of kernels; those of the first one,
/// still without its content.
pub fn create(gpu: &Gpu, tables: &[Table], choice: &Choice, counts: &Counts, bodies: usize) -> Buffers {
    let mut b = Buffers::default();
    for table in tables {
        match table.uniform {
            Some(size) => {
                b.uniform(gpu, table.name, size);
                b.get(table.name).write(gpu, &table.bytes);
            }
            None => b.filled(gpu, table.name, &table.bytes),
        }
    }
    let (nodes, surface, threads) = (counts.nodes, counts.surface, LANES * counts.chain_groups);
    b.parts::<[f32; 4]>(gpu, "positions", nodes, bodies);
    if choice.plus {
        b.parts::<[f32; 4]>(gpu, "positions_lo", nodes, bodies);
    }
    b.parts::<[f32; 4]>(gpu, "velocities", nodes, bodies);
    if bodies > 1 {
        // A stage of one of them may have what needs it.
        b.parts::<[f32; 2]>(gpu, "works", nodes, bodies);
    }
    b.parts::<[f32; 4]>(gpu, "slots", counts.slots, bodies);
    b.parts::<[f32; 4]>(gpu, "energies", threads, bodies);
    b.parts::<f32>(gpu, "viscous_work", if choice.viscous { threads } else { 1 }, bodies);
    b.parts::<RimSum>(gpu, "rim_sums", counts.rim, bodies);
    b.parts::<SurfaceRecord>(gpu, "surface_sums", surface, bodies);
    b.parts::<[f32; 4]>(gpu, "surface_states", 2 * surface, bodies);
    b.parts::<u32>(gpu, "contact_states", surface, bodies);
    b.parts::<[f32; 4]>(gpu, "contact_steps", counts.contact_records(), bodies);
    if choice.friction.is_some_and(|law| law.needs_area()) {
        b.parts::<f32>(gpu, "inverse_areas", surface, bodies);
    }
    b.parts::<[f32; 4]>(gpu, "probes", 4 * nodes.div_ceil(GROUP), bodies);
    b.parts::<layout::RimState>(gpu, "rim_state", 1, bodies);
    b.parts::<layout::RimState>(gpu, "rim_state_probe", 1, bodies);
    for (name, width) in [
        ("partials_rim", 2),
        ("partials_viscous", 1),
        ("kept_viscous", 1),
        ("partials_probes", 4),
        ("partials_energies", 1),
    ] {
        b.parts::<[f32; 4]>(gpu, name, width * PARTIALS, bodies);
    }
    b.parts::<u32>(gpu, "failure", FLAGS, bodies);
    b.parts::<u32>(gpu, "done", FLAGS, bodies);
    b.parts::<layout::Step>(gpu, "plan", PLAN, bodies);
    b.uniform(gpu, "members", MEMBERS * size_of::<layout::Member>());
    b
}

/// Bytes of the largest of a body's arrays that its step binds.
pub fn largest_part(counts: &Counts) -> u64 {
    let parts = [
        (PLAN, size_of::<layout::Step>()),
        (counts.contact_records(), size_of::<[f32; 4]>()),
        (counts.nodes, size_of::<[f32; 4]>()),
        (counts.slots, size_of::<[f32; 4]>()),
        (counts.surface, size_of::<SurfaceRecord>()),
    ];
    parts.iter().map(|(count, size)| (part_stride(*count) * size) as u64).max().unwrap_or(1)
}

/// Gives a body's buffers what it starts with, and those that it has to itself.
pub fn fill(
    gpu: &Gpu,
    b: &mut Buffers,
    model: &Model,
    choice: &Choice,
    frame: [f64; 3],
    road: Option<&Road>,
) {
    let mesh = &model.mesh;
    let write = |b: &Buffers, name: &str, bytes: &[u8]| b.get(name).write(gpu, bytes);
    let (hi, lo) = split(&mesh.nodes, frame, &masses(model, choice.road));
    write(b, "positions", bytemuck::cast_slice(&hi));
    if choice.plus {
        write(b, "positions_lo", bytemuck::cast_slice(&lo));
    }
    if let (Some(road), true) = (road, b.has("inverse_areas")) {
        let areas = inverse_areas(mesh, |n| mesh.nodes[n as usize], road);
        write(b, "inverse_areas", bytemuck::cast_slice(&areas));
    }
    write(b, "failure", bytemuck::cast_slice(&[u32::MAX; FLAGS]));
    // No step has this index: a submission that does nothing is noticed, the first one too.
    write(b, "done", bytemuck::cast_slice(&[u32::MAX; FLAGS]));
    b.uniform(gpu, "step", PLAN * STEP_STRIDE);
    b.uniform(gpu, "shift", 16);
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

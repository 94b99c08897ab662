//! What a model becomes on the device: constants of the kernels, and every buffer with its content.

use super::Gpu;
use super::buffers::{self, Buffers, PLAN, part_stride, step_stride, vec4};
use super::chains::{Chains, LANES};
use super::compose::Choice;
use super::counts::{Counts, PARTIALS};
use super::layout::{self, Member, Real, RimSum, SurfaceRecord, Wgsl, encode};
use super::precision::Precision;
use super::series;
use crate::model::mesh::Mesh;
use crate::model::{Model, areas};
use crate::scene::{Friction, Road, Scene};

/// Node roles, as in shaders/lib/nodes.wgsl.
const INTERIOR: u32 = 0xffff_ffff;
const RIM: u32 = 0x8000_0000;

/// Words of a body's flags.
const FLAGS: usize = 4;
/// Bodies of one dispatch at most, as in shaders/body/resident.wgsl.
pub const MEMBERS: usize = 512;

/// The part of the body number `body` of a dispatch in which it takes `steps`.
pub fn member(counts: &Counts, body: usize, steps: usize) -> Member {
    let at = |count: usize| (body * part_stride(count)) as u32;
    Member {
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
    let mut all = model.law.constants();
    all.push(("eta", model.viscosity.unwrap_or(0.0)));
    all.extend(["gravity_x", "gravity_y", "gravity_z"].into_iter().zip(scene.gravity));
    all.extend(series::constants(model));
    all.push(("face_slots", chains.face as f64));
    all.extend(chains.lattice.iter().flat_map(|l| l.constants(chains.longest)));
    all.extend(scene.friction.iter().flat_map(Friction::constants));
    // Seen from where the frame begins: it moves only along directions in which the road does not change.
    all.extend(scene.road.iter().flat_map(Road::constants));
    all
}

/// One over the area of every surface node with the nodes at `x` [1/m2].
pub fn inverse_areas(mesh: &Mesh, x: impl Fn(u32) -> [f64; 3], road: &Road, real: Real) -> Vec<u8> {
    encode(real, &areas::inverse_areas(mesh, x, road))
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
pub fn tables(model: &Model, chains: &Chains, choice: &Choice, road: Option<&Road>) -> Vec<Table> {
    let (mesh, real) = (&model.mesh, choice.precision.real());
    let table = |name, bytes: &[u8]| Table { name, bytes: bytes.to_vec(), uniform: None };
    let mut all = vec![
        table("chain_groups", bytemuck::cast_slice(&chains.groups)),
        table("chain_classes", bytemuck::cast_slice(&chains.classes)),
        Table {
            name: "classes",
            bytes: buffers::classes(model, real),
            uniform: chains.shared_classes.then(|| buffers::shared_classes_size(model.element, real)),
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
    let arms: Vec<[f64; 4]> = mesh.rim.iter().map(arm).collect();
    let surface = if choice.road.is_some() { &mesh.surface[..] } else { &[] };
    let boundary = [surface, &mesh.rim].concat();
    all.extend([
        table("roles", bytemuck::cast_slice(&roles(model, choice.road.is_some()))),
        table("rim_nodes", bytemuck::cast_slice(&mesh.rim)),
        table("rim_arms", &encode(real, &arms)),
        table("surface_nodes", bytemuck::cast_slice(surface)),
        table("boundary", bytemuck::cast_slice(&boundary)),
        table("boundary_bits", bytemuck::cast_slice(&bits(&boundary, model.node_count()))),
    ]);
    if choice.held {
        let bits: Vec<u32> = mesh.held.iter().map(|&bits| u32::from(bits)).collect();
        all.push(table("held", bytemuck::cast_slice(&bits)));
    }
    let shape = road.map(Road::array).unwrap_or_default();
    if !shape.is_empty() {
        all.push(table("road_shape", &encode(real, &shape)));
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
    let real = choice.precision.real();
    let (nodes, surface, threads) = (counts.nodes, counts.surface, LANES * counts.chain_groups);
    let mut parts = |name, each, count| b.parts(gpu, name, each, count, bodies);
    let (scalar, pair, vector) = (f64::size(real), <[f64; 2]>::size(real), <[f64; 4]>::size(real));
    parts("positions", vector, nodes);
    if choice.precision.has_pairs() {
        parts("positions_lo", vector, nodes);
    }
    parts("velocities", vector, nodes);
    if bodies > 1 {
        // A stage of one of them may have what needs it.
        parts("works", pair, nodes);
    }
    parts("slots", vector, counts.slots);
    b.use_share("slots", counts.stored_slots as f64 / counts.slots as f64);
    let mut parts = |name, each, count| b.parts(gpu, name, each, count, bodies);
    parts("energies", vector, threads);
    // Summed four by four.
    parts("viscous_work", scalar, if choice.viscous { threads } else { 4 });
    parts("viscous_loss", scalar, if choice.relaxes { threads } else { 4 });
    parts("memory", scalar, counts.remembered);
    parts("fading", vector, PLAN * counts.terms);
    parts("rim_sums", RimSum::size(real), counts.rim);
    parts("surface_sums", SurfaceRecord::size(real), surface);
    parts("surface_states", vector, 2 * surface);
    parts("contact_states", size_of::<u32>(), surface);
    parts("contact_steps", vector, counts.contact_records());
    if choice.friction.is_some_and(|law| law.needs_area()) {
        parts("inverse_areas", scalar, surface);
    }
    parts("probes", vector, counts.probe_records());
    parts("rim_state", layout::RimState::size(real), 1);
    parts("rim_state_probe", layout::RimState::size(real), 1);
    for (name, width) in [
        ("partials_rim", 2),
        ("partials_viscous", 1),
        ("kept_viscous", 1),
        ("partials_loss", 1),
        ("partials_probes", 4),
        ("partials_energies", 1),
    ] {
        parts(name, vector, width * PARTIALS);
    }
    parts("failure", size_of::<u32>(), FLAGS);
    parts("done", size_of::<u32>(), FLAGS);
    parts("plan", layout::Step::size(real), PLAN);
    b.uniform(gpu, "members", MEMBERS * Member::size(real));
    b
}

/// Bytes of the largest of a body's arrays that its step binds.
pub fn largest_part(counts: &Counts, real: Real) -> u64 {
    let vector = <[f64; 4]>::size(real);
    let parts = [
        (PLAN, layout::Step::size(real)),
        (counts.contact_records(), vector),
        (counts.nodes, vector),
        (counts.slots, vector),
        (counts.remembered, f64::size(real)),
        (counts.surface, SurfaceRecord::size(real)),
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
    let (mesh, real) = (&model.mesh, choice.precision.real());
    let write = |b: &Buffers, name: &str, bytes: &[u8]| b.get(name).write(gpu, bytes);
    let (hi, lo) = split(&mesh.nodes, frame, &model.mass, choice.precision);
    write(b, "positions", &encode(real, &hi));
    if choice.precision.has_pairs() {
        write(b, "positions_lo", &encode(real, &lo));
    }
    if let (Some(road), true) = (road, b.has("inverse_areas")) {
        let areas = inverse_areas(mesh, |n| mesh.nodes[n as usize], road, real);
        write(b, "inverse_areas", &areas);
    }
    write(b, "failure", bytemuck::cast_slice(&[u32::MAX; FLAGS]));
    // No step has this index: a submission that does nothing is noticed, the first one too.
    write(b, "done", bytemuck::cast_slice(&[u32::MAX; FLAGS]));
    b.uniform(gpu, "step", PLAN * step_stride(real));
    b.uniform(gpu, "shift", layout::Shift::size(real));
}

/// Positions relative to the frame with the masses beside them; of pairs the hi and lo parts.
pub fn split(
    x: &[[f64; 3]],
    frame: [f64; 3],
    masses: &[f64],
    precision: Precision,
) -> (Vec<[f64; 4]>, Vec<[f64; 4]>) {
    let high = |v: f64| if precision.has_pairs() { f64::from(v as f32) } else { v };
    let pair = |(x, &mass): (&[f64; 3], &f64)| {
        let local: [f64; 3] = std::array::from_fn(|d| x[d] - frame[d]);
        let [a, b, c] = local.map(high);
        ([a, b, c, mass], vec4(local.map(|v| v - high(v))))
    };
    x.iter().zip(masses).map(pair).unzip()
}

/// The given ones of so many nodes, as bits: bit n % 32 of word n / 32.
fn bits(nodes: &[u32], count: usize) -> Vec<u32> {
    let mut words = vec![0; count.div_ceil(32)];
    nodes.iter().for_each(|n| words[*n as usize / 32] |= 1 << (n % 32));
    words
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

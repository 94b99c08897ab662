//! Bytes that the CPU engine will hold, from a mesh's counts.

use crate::Precision;
use crate::engine::SurfaceSum;
use crate::kernels::memory::vectors;
use crate::kernels::{Batch, Line, LineSums, NodeBatch, Row, Rows};
use crate::memory::{Counts, Part};
use crate::physics::element::Class;
use crate::physics::lanes::{Instructions, Level, WIDEST};
use crate::scene::{Element, Scene};

/// Layers of lines whose forces are in the slots at a time: one that is being finished, one that is begun, the rim's.
const LAYERS: u64 = 3;

/// Bytes of one number, and lanes of the engine's vectors.
fn number(precision: Precision) -> (u64, u64) {
    let level = Level::detect();
    match precision.is_single() {
        true => (size_of::<f32>() as u64, level.width::<f32>() as u64),
        false => (size_of::<f64>() as u64, level.width::<f64>() as u64),
    }
}

/// Numbers of a line, with what lanes read beyond its end ([`Line::length`]).
fn length(counts: &Counts, width: u64) -> u64 {
    (counts.line_nodes.div_ceil(width) + 1) * width
}

/// An engine in this precision, on a mesh of rows, and the copy of its positions that trial forces are computed at.
pub fn engine(scene: &Scene, precision: Precision) -> Part {
    let counts = &Counts::of(scene);
    let (number, width) = number(precision);
    let length = length(counts, width);
    let places = counts.lines * length;
    // Positions and velocities, the copy that a failing step is taken back to; masses and their reciprocals.
    let nodes = (3 * (4 + 1) + 2) * number * places + 4 * counts.nodes;
    let slots = LAYERS * counts.layer_lines * length * 3 * number;
    let batches = counts.line_nodes.div_ceil(width);
    let of_line = size_of::<Line>() + size_of::<LineSums>();
    // Their nodes, slots, batches; held twice, by the layout and the node pass, while the engine is made.
    let lines = counts.lines
        * (of_line as u64 + 8 * 4 + 4 * counts.line_nodes + batches * size_of::<NodeBatch>() as u64);
    let rows = counts.elements.div_ceil(counts.line_nodes);
    let of_row = size_of::<Row>() + size_of::<Rows>() + 8 * WIDEST;
    let of_batch = (size_of::<Batch>() + size_of::<u32>()) as u64;
    let elements = rows * of_row as u64 + 4 * counts.elements + of_batch * counts.elements.div_ceil(width);
    // An entry of the table of shapes has the shapes of a batch.
    let entries = counts.shapes / counts.line_shapes * counts.line_shapes.div_ceil(width);
    let of_entry = (4 * WIDEST) as u64 + number * width * Class::<f64>::OF_POINTS.len() as u64;
    let surface =
        if scene.road.is_some() { counts.surface * (size_of::<SurfaceSum>() + 8 + 4 + 4) as u64 } else { 0 };
    // What points remember, and the copy that a failing step is taken back to.
    let points = match scene.body.element {
        Element::Q1p0 | Element::Full => 8,
        Element::UniformGradient { .. } => 1,
    };
    let terms = scene.body.relaxation.terms.len();
    let remembered = if terms == 0 { 0 } else { vectors(points, terms) as u64 };
    let memory = 2 * number * remembered * counts.elements.next_multiple_of(width);
    let bytes = nodes + slots + lines + elements + entries * of_entry + surface + memory;
    Part { name: "engine", bytes }
}

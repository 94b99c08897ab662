//! Differences between the fields of two runs, snapshot by snapshot.

use serde::Serialize;

use super::{Run, other_mesh, relative_l2};
use crate::Result;
use crate::output::read::{self, SnapshotFile, Stored};
use crate::output::stages;
use crate::record::ContactNode;

/// Differences between two snapshots.
#[derive(Debug, Clone, Serialize)]
pub struct SnapshotError {
    pub stage: String,
    /// [s]
    pub time_a: f64,
    pub time_b: f64,
    pub fields: Vec<FieldError>,
}

/// Differences in one field; of vectors, all components together.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FieldError {
    /// Name of the array in the snapshot's file.
    pub name: &'static str,
    pub unit: &'static str,
    /// Norm of B - A over the norm of A; none if A is zero everywhere and B is not.
    pub relative_l2: Option<f64>,
    /// Largest |B - A|, and the node or element it is at.
    pub max_difference: f64,
    pub worst: usize,
    /// `node` or `element`.
    pub entity: &'static str,
}

/// Compares the snapshots of the same time; a note for those without a partner.
///
/// # Errors
/// As [`compare`](super::compare).
pub fn compare(a: &Run, b: &Run, notes: &mut Vec<String>) -> Result<Vec<SnapshotError>> {
    let mut errors = Vec::new();
    for file in &a.snapshots {
        let Some(partner) = partner(a, b, file) else { continue };
        let (one, other) = (read::snapshot(&file.path)?, read::snapshot(&partner.path)?);
        check_meshes(a, b, &one, &other)?;
        let fields = fields(&one, &other);
        errors.push(SnapshotError { stage: one.stage, time_a: file.time, time_b: partner.time, fields });
    }
    let counts = [a.snapshots.len(), b.snapshots.len()];
    if counts != [errors.len(); 2] {
        notes.push(format!("A has {} snapshots and B {}; {} match", counts[0], counts[1], errors.len()));
    }
    Ok(errors)
}

/// B's snapshot of the same stage and time since its start.
fn partner<'b>(a: &Run, b: &'b Run, file: &SnapshotFile) -> Option<&'b SnapshotFile> {
    let (stage, since) = place(a, file.time);
    b.snapshots.iter().find(|other| {
        let (other_stage, other_since) = place(b, other.time);
        stage == other_stage && (since - other_since).abs() <= a.tolerance()
    })
}

/// Stage a time lies in (the earlier one at a border), and the time since its start [s]. A time before the
/// first row or after the last one that was written is in the first or the last stage.
fn place(run: &Run, time: f64) -> (String, f64) {
    let mut spans = stages::spans(&run.history);
    let Some(last) = spans.pop() else { return (String::new(), time) };
    let span = spans.into_iter().find(|span| time <= span.end + run.tolerance()).unwrap_or(last);
    (span.stage, time - span.start)
}

fn check_meshes(a: &Run, b: &Run, one: &Stored, other: &Stored) -> Result<()> {
    let (one, other) = (&one.mesh, &other.mesh);
    if one.hexes != other.hexes || one.nodes.len() != other.nodes.len() {
        let sizes = [one, other].map(|m| (m.hexes.len(), m.nodes.len()));
        let detail = if sizes[0] == sizes[1] {
            "its elements have other corners".into()
        } else {
            format!("{:?} elements and nodes, not {:?}", sizes[1], sizes[0])
        };
        return Err(other_mesh(a, b, detail));
    }
    let size = crate::output::summary::largest(one.nodes.as_flattened().iter().copied());
    let apart = one.nodes.iter().zip(&other.nodes).map(|(p, q)| distance(*p, *q));
    // Reference positions come back from sums of f64: round-off, far below 1e-9 of the coordinates.
    match apart.enumerate().find(|(_, d)| *d > 1e-9 * size) {
        Some((node, d)) => Err(other_mesh(a, b, format!("node {node} stands {d:.3e} m elsewhere"))),
        None => Ok(()),
    }
}

fn distance<const N: usize>(p: [f64; N], q: [f64; N]) -> f64 {
    (0..N).map(|d| (q[d] - p[d]).powi(2)).sum::<f64>().sqrt()
}

fn fields(one: &Stored, other: &Stored) -> Vec<FieldError> {
    let both = [one, other];
    let mut errors = vec![
        error("displacement", "m", "node", both.map(displacement)),
        error("velocity", "m/s", "node", both.map(|s| s.snapshot.v.clone())),
    ];
    if both.iter().all(|s| !s.snapshot.contact.is_empty()) {
        errors.extend([
            error("contact_force", "N", "node", both.map(|s| at_nodes(s, |c| c.force))),
            error("contact_pressure", "Pa", "node", both.map(|s| at_nodes(s, |c| [c.pressure]))),
            error("slip_speed", "m/s", "node", both.map(|s| at_nodes(s, |c| [c.slip_speed]))),
        ]);
    }
    let scalar = |f: &[f64]| f.iter().map(|&v| [v]).collect();
    errors.extend([
        error("J", "-", "element", both.map(|s| scalar(&s.snapshot.volume_ratio))),
        error("pressure", "Pa", "element", both.map(|s| scalar(&s.snapshot.pressure))),
        error("von_mises", "Pa", "element", both.map(|s| scalar(&s.snapshot.von_mises))),
    ]);
    errors
}

fn displacement(stored: &Stored) -> Vec<[f64; 3]> {
    let positions = stored.snapshot.x.iter().zip(&stored.mesh.nodes);
    positions.map(|(x, X)| std::array::from_fn(|d| x[d] - X[d])).collect()
}

/// A contact value at every node, zero off the surface.
fn at_nodes<const N: usize>(stored: &Stored, value: impl Fn(&ContactNode) -> [f64; N]) -> Vec<[f64; N]> {
    let mut all = vec![[0.0; N]; stored.mesh.nodes.len()];
    stored.snapshot.contact.iter().for_each(|c| all[c.node as usize] = value(c));
    all
}

fn error<const N: usize>(
    name: &'static str,
    unit: &'static str,
    entity: &'static str,
    [a, b]: [Vec<[f64; N]>; 2],
) -> FieldError {
    let differences = a.iter().zip(&b).map(|(a, b)| distance(*a, *b).abs());
    // total_cmp puts NaN, with a plain sign, above every number: a NaN is the worst there is. Of equals
    // max_by takes the last, so from the back it is the first.
    let indexed = differences.enumerate().rev();
    let (worst, max_difference) = indexed.max_by(|x, y| x.1.total_cmp(&y.1)).unwrap_or((0, 0.0));
    let pairs = a.as_flattened().iter().copied().zip(b.as_flattened().iter().copied());
    FieldError { name, unit, relative_l2: relative_l2(pairs), max_difference, worst, entity }
}

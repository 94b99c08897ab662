//! What a user should know of a scene or a run before believing its numbers.

use hexroll::model::Model;
use hexroll::model::mesh::{Mesh, Ring};
use hexroll::output::summary::{HourglassShare, StageMeans, Summary, WorstBalance};
use hexroll::output::{ContactScatter, Verdict};
use hexroll::run::Totals;
use hexroll::scene::{Drive, Element, Method, Scene};

/// Warnings that the scene and its mesh give without a run.
pub fn of(scene: &Scene, model: &Model) -> Vec<String> {
    [chatter(scene), unstable(scene), locking(scene), flat_elements(model), no_rows(scene, model)]
        .into_iter()
        .flatten()
        .chain(coarse_ring(scene, model))
        .chain(fine_road(scene, model))
        .collect()
}

/// Constant friction on an elastic body is ill-posed: it needs a little viscosity.
fn chatter(scene: &Scene) -> Option<String> {
    let dynamic = scene.stages.iter().any(|s| s.method == Method::Explicit && s.mass_damping == 0.0);
    (scene.friction.is_some() && scene.body.viscosity.is_none() && dynamic).then(|| {
        "friction on a purely elastic material chatters, the more the finer the mesh; forces that are to be believed \
         need a viscosity (body.material.viscosity)"
            .into()
    })
}

fn unstable(scene: &Scene) -> Option<String> {
    (scene.safety > 1.0).then(|| {
        format!(
            "time_step.safety = {} is above 1: steps longer than the critical one are unstable",
            scene.safety
        )
    })
}

/// Full integration locks where the bulk modulus dominates.
fn locking(scene: &Scene) -> Option<String> {
    let ratio = scene.body.law.bulk_modulus() / scene.body.law.shear_modulus();
    (scene.body.element == Element::Full && ratio > 10.0).then(|| {
        format!("element \"full\" is too stiff where kappa/G is large (here {ratio:.0}); \"q1p0\" is not")
    })
}

/// A hexahedron is as good as its longest side is short.
fn flat_elements(model: &Model) -> Option<String> {
    const FLAT: f64 = 5.0;
    let worst = model.mesh.hexes.iter().map(|hex| aspect(&hex.map(|n| model.mesh.nodes[n as usize])));
    let worst = worst.fold(1.0, f64::max);
    (worst > FLAT).then(|| format!("elements are up to {worst:.1} times as long as they are thick"))
}

/// Longest over shortest mean edge of the three directions.
fn aspect(corners: &[[f64; 3]; 8]) -> f64 {
    const EDGES: [[[usize; 2]; 4]; 3] = [
        [[0, 1], [3, 2], [4, 5], [7, 6]],
        [[0, 3], [1, 2], [4, 7], [5, 6]],
        [[0, 4], [1, 5], [2, 6], [3, 7]],
    ];
    let length =
        |&[a, b]: &[usize; 2]| (0..3).map(|d| (corners[a][d] - corners[b][d]).powi(2)).sum::<f64>().sqrt();
    let means = EDGES.map(|edges| edges.iter().map(length).sum::<f64>());
    means.iter().copied().fold(0.0, f64::max) / means.iter().copied().fold(f64::INFINITY, f64::min)
}

/// A body that spins on a road without rows of nodes round its axle: nobody knows when the next node comes to the road.
fn no_rows(scene: &Scene, model: &Model) -> Option<String> {
    let turns = |drive: Drive| match drive {
        Drive::Hold => false,
        Drive::Displacement { to, .. } | Drive::Velocity { to, .. } => to != 0.0,
        Drive::Free { .. } => true,
    };
    let spins = scene.stages.iter().any(|s| s.slip.is_some() || turns(s.rim.spin));
    (scene.road.is_some() && scene.rim.is_some() && spins && model.mesh.ring().is_none()).then(|| {
        "the mesh has no rows of outermost nodes round its axle: figures of the footprint are taken over whole windows \
         (output.sample), in which a node may roll out of it, and a tone of the mesh is not told from chatter"
            .into()
    })
}

/// What lies between two surface nodes is not felt: a road must be coarser than the mesh.
fn fine_road(scene: &Scene, model: &Model) -> Vec<String> {
    /// Nodes that a wave needs: with fewer than four its height is a matter of where they are.
    const A_WAVE: f64 = 4.0;
    let texture = scene.road.as_ref().and_then(|road| road.texture());
    let Some((texture, spacing)) = texture.zip(node_spacing(&model.mesh)) else { return Vec::new() };
    let mm = |length: f64| format!("{:.4} mm", 1e3 * length);
    let mut warnings = Vec::new();
    if texture.shortest < A_WAVE * spacing {
        warnings.push(format!(
            "the road has waves or sides down to {}, surface nodes are {} apart (median edge): what lies between nodes is not felt",
            mm(texture.shortest),
            mm(spacing)
        ));
    }
    if texture.steepest > 1.0 {
        let angle = texture.steepest.atan().to_degrees();
        warnings.push(format!(
            "the road is up to {angle:.1} deg steep: a node meets such a side only where it comes down on it"
        ));
    }
    if texture.sharpest < spacing {
        warnings.push(format!(
            "the road bends with a radius down to {}, below the {} between surface nodes: an edge between two nodes passes through it",
            mm(texture.sharpest),
            mm(spacing)
        ));
    }
    warnings
}

/// Median length of the edges of facets [m]; none of a mesh without facets.
fn node_spacing(mesh: &Mesh) -> Option<f64> {
    let edges = mesh.facets.iter().flat_map(|f| (0..4).map(move |k| [f[k], f[(k + 1) % 4]]));
    let length = |[a, b]: [u32; 2]| {
        let [a, b] = [a, b].map(|n| mesh.nodes[n as usize]);
        (0..3).map(|d| (a[d] - b[d]).powi(2)).sum::<f64>().sqrt()
    };
    let mut lengths: Vec<f64> = edges.map(length).collect();
    let middle = lengths.len() / 2;
    (!lengths.is_empty()).then(|| *lengths.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// A ring on a road is a polygon: its contact must span a few elements.
fn coarse_ring(scene: &Scene, model: &Model) -> Vec<String> {
    /// Sides below which a polygon rolls like one.
    const SIDES: usize = 24;
    /// Elements along the contact below which its pressure is not resolved.
    const ALONG: f64 = 4.0;
    let Some(Ring { around: sides, radius }) = model.mesh.ring() else { return Vec::new() };
    let mut warnings = Vec::new();
    if scene.road.is_none() {
        return warnings;
    }
    if sides < SIDES {
        warnings.push(format!("a ring of {sides} elements round the circumference rolls like a polygon"));
    }
    if model.mesh.lattice().is_some_and(|lattice| lattice.elements[2] < 2) {
        warnings.push("a ring one element thick cannot bend between rim and road".into());
    }
    let pressed = scene.stages.iter().filter_map(|s| match s.rim.z {
        Drive::Displacement { to, .. } if to < 0.0 => Some(-to),
        _ => None,
    });
    if let Some(depth) = pressed.reduce(f64::max) {
        // The chord that a rigid circle pressed in by `depth` cuts off.
        let chord = 2.0 * (depth * (2.0 * radius - depth)).max(0.0).sqrt();
        let along = chord * sides as f64 / (std::f64::consts::TAU * radius);
        if along < ALONG {
            warnings
                .push(format!("the contact spans only about {along:.1} elements along the circumference"));
        }
    }
    warnings
}

/// Warnings that a run gives: energies that do not add up, hourglass modes, stages that chatter or hum, and what helps.
pub fn of_run(
    scene: &Scene,
    stages: &[StageMeans],
    stored: &WorstBalance,
    hourglass: Option<&HourglassShare>,
    totals: &Totals,
) -> Vec<String> {
    let named = stages.iter().filter_map(|s| Some((&s.stage, s.contact.as_ref()?)));
    let verdicts = named.filter_map(|(stage, contact)| verdict(scene, stage, contact));
    unbalanced(scene, stored, totals)
        .into_iter()
        .chain(hourglass.and_then(hourglassed))
        .chain(verdicts)
        .collect()
}

/// Hourglass energy over strain energy from which on it is worth a word: where hourglass modes are but a remedy, they hold some per
/// cent.
const HOURGLASS: f64 = 0.1;

fn hourglassed(share: &HourglassShare) -> Option<String> {
    (share.of_strain_energy > HOURGLASS).then(|| {
        format!(
            "hourglass energy comes to {:.0} % of the strain energy (t = {:.4e} s): the body deforms in modes that the element \
             does not see, and stiffness and forces are not to be believed. element = \"q1p0\" or \"full\", or a finer mesh, helps",
            100.0 * share.of_strain_energy,
            share.time_s
        )
    })
}

/// What must be said of a run among many, beside its forces.
pub fn among_many(summary: &Summary) -> Option<String> {
    summary.hourglass.as_ref().and_then(hourglassed)
}

/// Largest stored-energy error over the largest term that is not worth a word: hard impacts leave some per cent, since their
/// highest frequencies are resolved by the safety factor alone.
const UNBALANCED: f64 = 0.1;

/// What helps where rounding is the cause.
const MORE_DIGITS: &str = "--precision f64, or f32+ on a GPU, has more digits";

/// An error that is round-off is nobody's fault; one that rounding explains has no other cause.
fn unbalanced(scene: &Scene, stored: &WorstBalance, totals: &Totals) -> Option<String> {
    let share = stored.share_of_largest_term;
    let counts = share > UNBALANCED && stored.worst_error_J > totals.energy_round_off();
    counts.then(|| match totals.estimate.rounding {
        Some(class) if class >= share => format!(
            "stored energy and works differ by {:.0} % of the largest of them: rounding does as much to the forces of this \
             body (estimated at {:.0} % of them), and the numbers are not to be believed. {MORE_DIGITS}",
            100.0 * share,
            100.0 * class
        ),
        _ => format!(
            "stored energy and works differ by {:.0} % of the largest of them: the steps are too long for what happens in \
             them, and the numbers are not to be believed. A smaller time_step.safety (here {}) helps, or windows \
             (output.sample) shorter than an impact, after which the critical step is looked at again",
            100.0 * share,
            scene.safety
        ),
    })
}

fn verdict(scene: &Scene, stage: &str, contact: &ContactScatter) -> Option<String> {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    match contact.verdict {
        Verdict::Smooth => None,
        Verdict::Tone => Some(format!(
            "stage {stage:?} hums: the corners of the ring mesh pass the road at {:.0} Hz and move its force by {} of the \
             normal force; the means stand, a finer mesh makes the tone higher and weaker",
            contact.tone_Hz.unwrap_or(0.0),
            percent(contact.tone_share),
        )),
        Verdict::Chattering => Some(format!(
            "stage {stage:?} is chattering: from step to step the road's force scatters by {} of the normal force \
             (limit {}), and {} of the touching nodes change their state; {}. {}",
            percent(contact.remaining_share),
            percent(contact.limit),
            percent(contact.changing_share),
            unbelievable(contact),
            match scene.body.viscosity {
                None =>
                    "A viscosity helps (body.material.viscosity, for rubber of the order of 20 Pa s)".into(),
                Some(eta) => format!("More viscosity may help (body.material.viscosity is {eta} Pa s)"),
            }
        )),
        Verdict::Rounding => Some(format!(
            "stage {stage:?} is rounded: from step to step the road's force scatters by {} of the normal force (limit {}), and \
             rounding does as much to the forces of this body under this load; its means are not to be believed. {MORE_DIGITS}",
            percent(contact.remaining_share),
            percent(contact.limit),
        )),
    }
}

/// Which means of a stage whose force scatters are wrong. Where every node slides friction is mu times the normal force at
/// each step, whose mean is the load: neither depends on which nodes touch. Where some stick, it does.
fn unbelievable(contact: &ContactScatter) -> &'static str {
    /// Sticking nodes that carry no more than this share of the normal force leave friction to the sliding ones.
    const FEW: f64 = 0.01;
    match contact.sticking_share {
        Some(share) if share < FEW => {
            "its contact area and pressures are not to be believed, the mean force is: all touching nodes slide"
        }
        _ => "its means are not to be believed",
    }
}

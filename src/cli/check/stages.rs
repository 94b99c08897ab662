//! Stages, optional pieces and outputs, in words.

use serde::Serialize;

use super::Piece;
use crate::estimate::Steps;
use crate::format::si;
use hexroll::model::mesh::NodeSets;
use hexroll::physics::material::Term;
use hexroll::scene::{
    Drive, Field, ImplicitScheme, InitialVelocity, Method, Picture, RimMotion, Scene, Slip, Snapshots, Stage,
};

/// A stage as it will run.
#[derive(Debug, Serialize)]
pub struct StagePlan {
    pub name: String,
    pub method: String,
    /// The longest it may take.
    pub duration_s: f64,
    pub steps_at_most: u64,
    /// Mass damping [1/s]; 0: none.
    pub mass_damping_per_s: f64,
    pub initial_velocity: Option<&'static str>,
    /// Components of the rim that do not hold.
    pub rim: Vec<String>,
}

pub fn plans(scene: &Scene, steps: &Steps) -> Vec<StagePlan> {
    let plan = |(stage, &steps_at_most): (&Stage, &u64)| StagePlan {
        name: stage.name.clone(),
        method: match stage.method {
            Method::Explicit => "explicit".into(),
            Method::QuasiStatic { kinetic_ratio, residual } => {
                format!(
                    "quasi-static, until kinetic/strain energy <= {kinetic_ratio:e} and residual <= {residual:e}"
                )
            }
            Method::Implicit(implicit) => match implicit.scheme {
                ImplicitScheme::Static { increments } => {
                    format!("implicit, static, {increments} increments or more")
                }
                ImplicitScheme::Dynamic { step, damping } => {
                    format!("implicit, Newmark with steps of {step:e} s, numerical damping {damping}")
                }
            },
        },
        duration_s: stage.duration,
        steps_at_most,
        mass_damping_per_s: stage.mass_damping,
        initial_velocity: stage.initial_velocity.map(|v| match v {
            InitialVelocity::Rim => "every node starts with the rim's rigid motion",
            InitialVelocity::Zero => "everything starts at rest",
        }),
        rim: rim(&stage.rim).into_iter().chain(stage.slip.map(slip)).collect(),
    };
    scene.stages.iter().zip(&steps.by_stage).map(plan).collect()
}

fn rim(motion: &RimMotion) -> Vec<String> {
    let [length, angle] = [["m", "N", "kg"], ["rad", "N m", "kg m2"]];
    let units = [length, length, length, angle, angle, angle];
    let names = ["x", "y", "z", "steer", "camber", "spin"];
    let moving = motion.drives().into_iter().zip(names).zip(units);
    moving
        .filter_map(|((drive, name), units)| Some(format!("{name} {}", motion_text(drive, units)?)))
        .collect()
}

fn slip(slip: Slip) -> String {
    let radius = slip.free_radius.map_or("as measured before".into(), |r| si(r, "m"));
    format!("spin at a longitudinal slip of {} %, free-rolling radius {radius}", 100.0 * slip.kappa)
}

fn motion_text(drive: Drive, [way, load_unit, mass_unit]: [&str; 3]) -> Option<String> {
    let over = |ramp: f64| if ramp > 0.0 { format!(" over {}", si(ramp, "s")) } else { String::new() };
    match drive {
        Drive::Hold => None,
        Drive::Displacement { to, ramp } => Some(format!("to {}{}", si(to, way), over(ramp))),
        Drive::Velocity { to, ramp } => Some(format!("at {}{}", si(to, &format!("{way}/s")), over(ramp))),
        Drive::Free { mass, load, ramp } => {
            Some(format!("free under {load} {load_unit}{}, rim {mass} {mass_unit}", over(ramp)))
        }
    }
}

/// Optional parts of the physics, those left out included.
pub fn pieces(scene: &Scene, sets: &NodeSets) -> Vec<Piece> {
    let any_damping = scene.stages.iter().filter(|s| s.mass_damping > 0.0).map(|s| format!("{:?}", s.name));
    let damped: Vec<String> = any_damping.collect();
    let free = scene.stages.iter().any(|s| s.rim.drives().iter().any(|d| matches!(d, Drive::Free { .. })));
    let piece = |name, detail| Piece { name, detail };
    vec![
        piece("viscosity", scene.body.viscosity.map(|eta| format!("Kelvin-Voigt, {eta} Pa s in shear"))),
        piece("relaxation", relaxation(scene)),
        piece("mass damping", (!damped.is_empty()).then(|| format!("in stage {}", damped.join(", ")))),
        piece("gravity", (scene.gravity != [0.0; 3]).then(|| format!("{:?} m/s2", scene.gravity))),
        piece("held components", (!scene.holds.is_empty()).then(|| holds(scene, sets))),
        piece("moved components", (!scene.motions.is_empty()).then(|| motions(scene, sets))),
        piece("road", scene.road.as_ref().map(|road| road.description())),
        piece("friction", scene.friction.map(|law| law.formula())),
        piece(
            "rim",
            scene
                .rim
                .as_ref()
                .map(|_| if free { "rigid, some components free" } else { "rigid, prescribed" }.into()),
        ),
    ]
}

/// Terms of the Prony series, and the modulus at once.
fn relaxation(scene: &Scene) -> Option<String> {
    let series = &scene.body.relaxation;
    let instantaneous = series.instantaneous();
    let term = |t: &Term| format!("{:.4} in {}", t.ratio / instantaneous, si(t.time, "s"));
    let terms: Vec<String> = series.terms.iter().map(term).collect();
    (!terms.is_empty()).then(|| {
        let modulus = scene.body.law.shear_modulus() * instantaneous;
        format!(
            "Prony series, shares {}; instantaneous shear modulus {}",
            terms.join(", "),
            si(modulus, "Pa")
        )
    })
}

fn holds(scene: &Scene, sets: &NodeSets) -> String {
    let hold = |h: &hexroll::scene::Hold| {
        let names: String =
            ['x', 'y', 'z'].iter().zip(h.components).filter_map(|(c, on)| on.then_some(c)).collect();
        format!("{names} of {}", sets.meaning(&h.nodes.name))
    };
    scene.holds.iter().map(hold).collect::<Vec<_>>().join(", ")
}

fn motions(scene: &Scene, sets: &NodeSets) -> String {
    let motion = |m: &hexroll::scene::SetMotion| {
        let moved =
            ['x', 'y', 'z'].iter().zip(&m.components).filter_map(|(c, path)| path.as_ref().map(|_| *c));
        let turned = if m.turn.is_some() { ", turned," } else { "" };
        format!("{}{turned} of {}", moved.collect::<String>(), sets.meaning(&m.nodes.name))
    };
    scene.motions.iter().map(motion).collect::<Vec<_>>().join("; ")
}

/// What a run would write.
pub fn outputs(scene: &Scene) -> Vec<String> {
    let snapshots = match scene.output.snapshots {
        Snapshots::None => "no snapshots".into(),
        Snapshots::StageEnds => "snapshots at the end of every stage".into(),
        Snapshots::Every(s) => format!("snapshots every {} and at the end of every stage", si(s, "s")),
    };
    let picture = |p: &Picture| match p {
        Picture::Footprint => "footprint".to_string(),
        Picture::Body(field) => format!("body coloured by {}", field_name(*field)),
    };
    let pictures: Vec<String> = scene.output.pictures.iter().map(picture).collect();
    let pictures = if pictures.is_empty() {
        "no pictures".into()
    } else {
        format!("pictures of every snapshot: {}", pictures.join(", "))
    };
    let mut all =
        vec![format!("a row of history every {}", si(scene.output.sample, "s")), snapshots, pictures];
    if !scene.recorded().is_empty() {
        all.push("displacements and reactions of moved and recorded node sets: reactions.csv".into());
    }
    all
}

fn field_name(field: Field) -> &'static str {
    crate::pictures::FIELDS.iter().find(|(_, f)| *f == field).map_or("", |(name, _)| name)
}

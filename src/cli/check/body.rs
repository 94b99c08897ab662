//! The body: mesh, element, law.

use serde::Serialize;

use hexroll::model::Model;
use hexroll::model::mesh::quality;
use hexroll::physics::parameters::{Parameter, Quantity};
use hexroll::run::stability::Bound;
use hexroll::scene::{Element, Law, Lumping, Scene};

/// The body as it is meshed.
#[derive(Debug, Serialize)]
pub struct Body {
    pub mesh: String,
    /// What a user must know of the file that the mesh is from.
    pub notes: Vec<String>,
    pub volume_m3: f64,
    /// Smallest scaled Jacobian (1: right angles; 0: flat), and the element that has it.
    pub worst_scaled_jacobian: f64,
    pub worst_element: String,
    /// Elements that allow the shortest steps, one a shape.
    pub limiting: Vec<Limiting>,
    /// Elements round the circumference; none of a mesh without rows of outermost nodes round its axle.
    pub around: Option<usize>,
    /// Names that [rim] and [[hold]] may use.
    pub node_sets: Vec<String>,
    pub elements: usize,
    pub nodes: usize,
    /// Nodes that can touch the road.
    pub surface_nodes: usize,
    pub rim: Option<String>,
    pub rim_nodes: usize,
    /// Distinct reference shapes of elements.
    pub shape_classes: usize,
    pub element: String,
    pub mass_lumping: &'static str,
    pub mass_kg: f64,
    pub law: &'static str,
    /// The law's own constants and its energy.
    pub constants: String,
    pub shear_modulus_Pa: f64,
    pub bulk_modulus_Pa: f64,
    pub youngs_modulus_Pa: f64,
    pub poisson_ratio: f64,
    pub density_kg_m3: f64,
    /// Speed of waves of dilatation and of shear, unstressed [m/s].
    pub wave_speed_m_s: f64,
    pub shear_wave_speed_m_s: f64,
}

/// An element that limits the step.
#[derive(Debug, Serialize)]
pub struct Limiting {
    pub element: String,
    /// Largest step that is stable for it alone [s].
    pub step_s: f64,
    /// Elements of this shape.
    pub alike: usize,
}

/// Limiting elements that are shown.
const SHOWN: usize = 3;

fn limiting(model: &Model, bounds: &[Bound]) -> Vec<Limiting> {
    let mut order: Vec<&Bound> = bounds.iter().collect();
    order.sort_by(|a, b| a.dt.total_cmp(&b.dt));
    let one = |b: &&Bound| Limiting {
        element: model.mesh.element_name(b.element),
        step_s: b.dt,
        alike: model.class_of.iter().filter(|&&c| c == model.class_of[b.element]).count(),
    };
    order.iter().take(SHOWN).map(one).collect()
}

impl Body {
    pub fn of(scene: &Scene, model: &Model, bounds: &[Bound]) -> Body {
        let law = &scene.body.law;
        let [G, kappa, rho] = [law.shear_modulus(), law.bulk_modulus(), scene.body.density];
        let mesh = &model.mesh;
        let (worst_scaled_jacobian, worst) = quality::worst(mesh).unwrap_or((1.0, 0));
        Body {
            mesh: mesh.description.clone(),
            notes: mesh.notes.clone(),
            volume_m3: model.class_of.iter().map(|&c| model.classes[c as usize].volume).sum(),
            worst_scaled_jacobian,
            worst_element: mesh.element_name(worst),
            limiting: limiting(model, bounds),
            around: mesh.ring().map(|ring| ring.around),
            node_sets: mesh.sets.names(),
            elements: model.element_count(),
            nodes: model.node_count(),
            surface_nodes: mesh.surface.len(),
            rim: scene.rim.as_ref().map(|rim| mesh.sets.meaning(&rim.nodes.name).into()),
            rim_nodes: mesh.rim.len(),
            shape_classes: model.classes.len(),
            element: element_text(scene.body.element),
            mass_lumping: match scene.body.lumping {
                Lumping::RowSum => "row sums of the consistent mass",
                Lumping::Equal => "an eighth of the element to each corner",
            },
            mass_kg: model.mass.iter().sum(),
            law: law.name(),
            constants: constants(law),
            shear_modulus_Pa: G,
            bulk_modulus_Pa: kappa,
            youngs_modulus_Pa: 9.0 * kappa * G / (3.0 * kappa + G),
            poisson_ratio: (3.0 * kappa - 2.0 * G) / (2.0 * (3.0 * kappa + G)),
            density_kg_m3: rho,
            wave_speed_m_s: (law.wave_modulus() / rho).sqrt(),
            shear_wave_speed_m_s: (G / rho).sqrt(),
        }
    }
}

fn element_text(element: Element) -> String {
    match element {
        Element::Q1p0 => "q1p0: 2x2x2 points, one mean-dilatation pressure".into(),
        Element::Full => "full: 2x2x2 points for everything".into(),
        Element::UniformGradient { hourglass } => {
            format!("uniform-gradient: mean gradients, hourglass stiffness {hourglass} G")
        }
    }
}

fn constants(law: &Law) -> String {
    // Ten digits: what the file says, without the round-off of reading it.
    let mpa = |v: f64| format!("{} MPa", (v * 1e4).round() / 1e10);
    let (parameters, values) = law.parameters();
    let one = |(p, value): (&Parameter, f64)| match p.quantity {
        Quantity::Stress => format!("{} = {}", p.key, mpa(value)),
        Quantity::Compressibility => format!("{} = {value} 1/Pa", p.key),
        Quantity::Number => format!("{} = {value}", p.key),
        Quantity::Speed => format!("{} = {value} m/s", p.key),
        Quantity::Slowness => format!("{} = {value} s/m", p.key),
    };
    parameters.iter().zip(values).map(one).collect::<Vec<_>>().join(", ")
}

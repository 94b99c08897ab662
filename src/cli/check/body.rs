//! The body: mesh, element, law.

use serde::Serialize;

use hexroll::model::Model;
use hexroll::physics::parameters::{Parameter, Quantity};
use hexroll::scene::{Element, Law, Lumping, Scene};

/// The body as it is meshed.
#[derive(Debug, Serialize)]
pub struct Body {
    pub mesh: String,
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

impl Body {
    pub fn of(scene: &Scene, model: &Model) -> Body {
        let law = &scene.body.law;
        let [G, kappa, rho] = [law.shear_modulus(), law.bulk_modulus(), scene.body.density];
        let mesh = &model.mesh;
        Body {
            mesh: mesh.description.clone(),
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

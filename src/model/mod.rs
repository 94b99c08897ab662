//! SI, f64 description of the discrete body: mesh, mass, shape classes, who gathers from whom.

pub mod areas;
pub mod chains;
mod classes;
mod driven;
mod forces;
pub mod frame;
pub mod memory;
pub mod mesh;
mod placement;
pub mod shuffle;

use crate::error::{Error, Result};
use crate::physics::element::{Class, Composition};
use crate::physics::material::Relaxation;
use crate::scene::{Body, Element, Hold, Law, Lumping, MeshSpec, Rim, Scene};
use mesh::{Mesh, UnknownSet};
use std::sync::Arc;

/// The discrete body.
#[derive(Debug, Clone)]
pub struct Model {
    pub mesh: Mesh,
    pub law: Law,
    pub element: Element,
    /// Shear viscosity [Pa s].
    pub viscosity: Option<f64>,
    /// Prony series; no terms: nothing relaxes.
    pub relaxation: Relaxation,
    pub density: f64,
    pub lumping: Lumping,
    /// Lumped nodal mass [kg], shape `[node_count]`.
    pub mass: Vec<f64>,
    /// Distinct reference shapes, and which one each element has, shape `[element_count]`.
    pub classes: Arc<[Class<f64>]>,
    pub class_of: Vec<u32>,
    /// Element corners at each node: `corners[corner_start[n]..corner_start[n + 1]]` holds 8 element + corner.
    pub corner_start: Vec<u32>,
    pub corners: Vec<u32>,
}

impl Model {
    /// Meshes a scene.
    ///
    /// # Errors
    /// [`Error::Memory`] if the body does not fit, before any of it is made; [`Error::Scene`] for a node set that the mesh does
    /// not have, a rim that leaves nothing to deform, an inside-out element, a body that begins inside the road.
    pub fn new(scene: &Scene) -> Result<Model> {
        crate::memory::ensure(scene, |scene| memory::body(scene).into())?;
        let mesh = meshed(scene)?;
        let labels = mesh.labels.clone();
        Model::from_mesh(mesh, &scene.body).map_err(|element| Error::Scene {
            file: scene.file.display().to_string(),
            line: None,
            key: "body.mesh".into(),
            problem: format!(
                "element {} is inside out: det dX/dxi is not positive",
                mesh::element_name(labels.as_deref(), element)
            ),
            remedy: "every element needs a positive volume at its corners and Gauss points".into(),
        })
    }

    /// Assembles any mesh; `Err(element)` names an inside-out element.
    pub fn from_mesh(mesh: Mesh, body: &Body) -> std::result::Result<Model, usize> {
        let Body { law, element, viscosity, ref relaxation, density, lumping, .. } = *body;
        let hourglass = match element {
            Element::UniformGradient { hourglass } => hourglass,
            Element::Q1p0 | Element::Full => 0.0,
        };
        let moduli = [hourglass * law.shear_modulus(), hourglass * viscosity.unwrap_or(0.0)];
        let (classes, class_of) = classes::find(&mesh, moduli)?;
        let volumes: Vec<[f64; 8]> = classes.iter().map(|c| c.corner_volumes(lumping)).collect();
        let mass = lumped_mass(&mesh, &volumes, &class_of, density);
        let (corner_start, corners) = node_corners(&mesh);
        Ok(Model {
            mesh,
            law,
            element,
            viscosity,
            relaxation: relaxation.clone(),
            density,
            lumping,
            mass,
            classes: classes.into(),
            class_of,
            corner_start,
            corners,
        })
    }

    pub fn element_count(&self) -> usize {
        self.mesh.hexes.len()
    }

    pub fn node_count(&self) -> usize {
        self.mesh.nodes.len()
    }

    /// What the elements' forces are made of.
    pub fn composition(&self) -> Composition {
        let relaxes = !self.relaxation.terms.is_empty();
        Composition { element: self.element, law: self.law, viscosity: self.viscosity, relaxes }
    }

    /// Whether every element is a plane figure extruded along eta.
    pub fn is_extruded(&self) -> bool {
        self.classes.iter().all(Class::is_extruded)
    }
}

/// The mesh of a scene with its rim and holds, where the scene wants it.
fn meshed(scene: &Scene) -> Result<Mesh> {
    let file = scene.file.display().to_string();
    let mut mesh = match &scene.body.mesh {
        MeshSpec::File(mesh) => Mesh::imported(mesh, scene.rim.as_ref().map(|rim| &rim.nodes))?,
        generator => Mesh::graded(generator, &scene.body.grading),
    };
    mesh = mesh.moved(scene.body.offset);
    if let Some(Rim { nodes }) = &scene.rim {
        let key = "rim.nodes";
        mesh = mesh.with_rim(&nodes.name).map_err(|e| nodes.unknown(&file, key, &e.known))?;
        if mesh.rim.len() == mesh.nodes.len() {
            let problem = "the rim has every node of the mesh, and nothing can deform".into();
            return Err(nodes.error(&file, key, problem, "name a set of some of the nodes".into()));
        }
    }
    for (k, Hold { nodes, components, .. }) in scene.holds.iter().enumerate() {
        let unknown = |e: UnknownSet| nodes.unknown(&file, &format!("hold.{k}.nodes"), &e.known);
        mesh = mesh.with_held(&nodes.name, *components).map_err(unknown)?;
    }
    placement::placed(driven::driven(mesh, scene)?, scene)
}

/// Sums of the corner masses by node.
fn lumped_mass(mesh: &Mesh, volumes: &[[f64; 8]], class_of: &[u32], density: f64) -> Vec<f64> {
    let mut mass = vec![0.0; mesh.nodes.len()];
    for (hex, &class) in mesh.hexes.iter().zip(class_of) {
        for (&node, volume) in hex.iter().zip(volumes[class as usize]) {
            mass[node as usize] += density * volume;
        }
    }
    mass
}

/// Corners by node (compressed rows), ascending, so that every gather sums in the same order.
fn node_corners(mesh: &Mesh) -> (Vec<u32>, Vec<u32>) {
    let mut start = vec![0u32; mesh.nodes.len() + 1];
    for &node in mesh.hexes.iter().flatten() {
        start[node as usize + 1] += 1;
    }
    for n in 0..mesh.nodes.len() {
        start[n + 1] += start[n];
    }
    let mut next = start.clone();
    let mut corners = vec![0u32; 8 * mesh.hexes.len()];
    for (slot, &node) in mesh.hexes.iter().flatten().enumerate() {
        corners[next[node as usize] as usize] = slot as u32;
        next[node as usize] += 1;
    }
    (start, corners)
}

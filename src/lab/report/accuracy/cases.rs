//! The problems that are measured, and the settings they are measured with.

use crate::bench::kind::Kind;
use crate::rig::{down, given, press, rolling, wheel};
use hexroll::scene::*;

/// What is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Problem {
    /// The paper's wheel pressed by 2.2 mm, mu = 1: vertical force.
    Static,
    /// Pressed and rolled straight, 20 Pa s: longitudinal force, mean of 40 to 50 ms.
    Straight,
    /// The same at 5 degrees: side force.
    Slip5,
    /// A pulse of dilatation in a bar: rms displacement.
    Wave,
}

impl Problem {
    pub const ALL: [Problem; 4] = [Problem::Static, Problem::Straight, Problem::Slip5, Problem::Wave];

    pub fn name(self) -> &'static str {
        match self {
            Problem::Static => "static",
            Problem::Straight => "straight",
            Problem::Slip5 => "slip-5",
            Problem::Wave => "wave",
        }
    }

    /// The problem with this name.
    pub fn named(name: &str) -> Option<Problem> {
        Problem::ALL.into_iter().find(|p| p.name() == name)
    }

    /// What the error is an error of.
    pub fn quantity(self) -> &'static str {
        match self {
            Problem::Static => "vertical force",
            Problem::Straight => "longitudinal force",
            Problem::Slip5 => "side force",
            Problem::Wave => "displacement",
        }
    }
}

/// One cell of the matrix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Who computes.
    pub machine: Kind,
    pub element: Element,
    /// Refinement: 1 is 44 x 4 x 5 elements, or a bar of 50.
    pub mesh: usize,
    pub safety: f64,
}

/// Name of an engine in tables.
pub fn machine_name(machine: Kind) -> &'static str {
    match machine {
        Kind::CpuF64 => "cpu f64",
        Kind::CpuF32 => "cpu f32",
        Kind::GpuF32 => "gpu f32",
        Kind::GpuF32Plus => "gpu f32+",
        Kind::GpuF64 => "gpu f64",
    }
}

/// The engine with this name in tables.
pub fn machine_named(name: &str) -> Option<Kind> {
    Kind::ALL.into_iter().find(|m| machine_name(*m) == name)
}

/// Name of a formulation in scenes.
pub fn element_name(element: Element) -> &'static str {
    match element {
        Element::Q1p0 => "q1p0",
        Element::Full => "full",
        Element::UniformGradient { .. } => "uniform-gradient",
    }
}

/// Formulations that are measured; the hourglass stiffness is the default one.
pub const ELEMENTS: [Element; 3] =
    [Element::Q1p0, Element::UniformGradient { hourglass: given::HOURGLASS }, Element::Full];

/// Duration of the rolling stage, and the part at its end that is averaged [s].
pub const ROLL: f64 = 0.05;
pub const MEAN: f64 = 0.01;

/// The wheel of a problem.
pub fn scene(problem: Problem, setting: &Setting) -> Scene {
    let mut scene = wheel(given::refined(setting.mesh), 1.0);
    scene.body.element = setting.element;
    scene.safety = setting.safety;
    scene.stages = vec![press(down(given::DEPTH))];
    if problem != Problem::Static {
        scene.body.viscosity = Some(given::VISCOSITY);
        let velocity = if problem == Problem::Slip5 { given::AT_5_DEGREES } else { given::STRAIGHT };
        scene.stages.push(rolling(velocity, given::SPIN, ROLL));
    }
    scene
}

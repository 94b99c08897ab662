//! The critical time step of the current state, from the assembled tangent (eq. 29).
//!
//! The scheme with half-step velocities is stable while the largest eigenvalue of
//! B(dt) = M^-1 (dt^2/4 K + dt/2 C) is below one: K alone gives 2/omega_max. B is applied by the engine's own force pass,
//! as a difference of forces between the state displaced by e w, moving with e (2/dt) w, and the state at rest.

use rayon::prelude::*;

use super::lanczos::{self, Top};
use crate::engine::Engine;
use crate::error::Result;
use crate::memory::{Counts, Part};
use crate::model::Model;
use crate::scene::Scene;

/// Residual of the eigenvalue, relative: the step is known to half of it.
const TOLERANCE: f64 = 1e-3;
/// Share of all modes in the start from the mode found before: enough for another to grow, which it does by a factor or more
/// an iteration, and little to be rid of.
const NEW: f64 = 0.01;
/// Shapes of elements whose bounds several threads find.
const MANY_SHAPES: usize = 1000;
/// Iterations after which the bound (value plus residual) is taken as it is.
const MOST: usize = 120;

/// A critical step and what is needed to find the next one cheaply.
#[derive(Debug, Clone, Default)]
pub struct Critical {
    /// Largest stable step [s], from the upper bound of the eigenvalue.
    pub dt: f64,
    /// Ritz vector (nodes times 3), the next start.
    vector: Vec<f64>,
    pub iterations: usize,
}

/// Largest step that is stable for an element alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    pub dt: f64,
    /// The first element of its shape.
    pub element: usize,
}

/// Critical step from single elements: no assembly can be less stable than its worst element (Irons & Treharne), so
/// this is safe in the reference shape, and some way below the assembled value.
pub fn element_bound(model: &Model) -> Result<f64> {
    Ok(element_bounds(model)?.iter().map(|b| b.dt).fold(f64::INFINITY, f64::min))
}

/// That of every shape of elements, in the order of the shapes. An imported mesh may have as many as elements.
pub fn element_bounds(model: &Model) -> Result<Vec<Bound>> {
    let mut first = vec![usize::MAX; model.classes.len()];
    for (element, &class) in model.class_of.iter().enumerate().rev() {
        first[class as usize] = element;
    }
    let used = |&(_, element): &(usize, &usize)| *element != usize::MAX;
    // Every mode is at most as much stiffer at once as the modulus is.
    let stiffer = model.relaxation.instantaneous().sqrt();
    let bound = |(class, &element): (usize, &usize)| {
        Ok(Bound { dt: class_bound(model, class, element)? / stiffer, element })
    };
    // Threads take memory of their own: for many shapes alone.
    match first.len() < MANY_SHAPES {
        true => first.iter().enumerate().filter(used).map(bound).collect(),
        false => first.par_iter().enumerate().filter(used).map(bound).collect(),
    }
}

fn class_bound(model: &Model, class: usize, element: usize) -> Result<f64> {
    let corners = model.mesh.hexes[element].map(|n| model.mesh.nodes[n as usize]);
    let volumes = model.classes[class].corner_volumes(model.lumping);
    let mass: Vec<f64> = (0..24).map(|i| model.density * volumes[i / 3]).collect();
    let size = model.classes[class].volume.cbrt();
    let start = spread(24, |_| true);
    let mut dt = size / (model.law.wave_modulus() / model.density).sqrt();
    // With viscosity the pencil depends on dt: two corrections settle it far below any safety factor.
    for _ in 0..if model.viscosity.is_some() { 4 } else { 1 } {
        let apply = |w: &[f64], with_velocity: f64| {
            let e = 1e-6 * size / w.iter().fold(0.0f64, |m, w| m.max(w.abs()));
            let moved = |s: f64| {
                std::array::from_fn(|a| std::array::from_fn(|d| corners[a][d] + s * e * w[3 * a + d]))
            };
            let moving = |s: f64| {
                std::array::from_fn(|a| std::array::from_fn(|d| s * e * with_velocity * w[3 * a + d]))
            };
            let f = model.element_forces(class, &moved(1.0), &moving(1.0));
            let g = model.element_forces(class, &moved(-1.0), &moving(-1.0));
            Ok((0..24)
                .map(|i| (f[i / 3][i % 3] - g[i / 3][i % 3]) / (2.0 * e * mass[i]))
                .collect::<Vec<f64>>())
        };
        let scaled = |w: &[f64]| Ok(apply(w, 2.0 / dt)?.iter().map(|b| b * dt * dt / 4.0).collect());
        let top = lanczos::largest(scaled, &mass, &start, 1e-6, 24)?;
        let stiffness = rayleigh(&apply(&top.vector, 0.0)?, &top.vector, &mass);
        dt = corrected(dt, &top, stiffness);
    }
    Ok(dt)
}

fn rayleigh(applied: &[f64], w: &[f64], mass: &[f64]) -> f64 {
    applied.iter().zip(w).zip(mass).map(|((a, w), m)| a * w * m).sum()
}

/// The dt that makes k dt^2/4 + c dt/2 = 1 for the mode found at `dt`, whose stiffness quotient is k.
fn corrected(dt: f64, top: &Top, stiffness: f64) -> f64 {
    let margin = top.upper / top.value;
    let k = stiffness * margin;
    let c = ((top.value - stiffness * dt * dt / 4.0) / (dt / 2.0)).max(0.0) * margin;
    // Written so that nothing cancels: dt = 4 / (c + sqrt(c^2 + 4 k)).
    4.0 / (c + (c * c + 4.0 * k).sqrt())
}

/// Bytes that the search holds: the basis of the iteration, and beside it vectors in f64: masses, start, mode before and mode found,
/// positions and velocities of one side of the difference, forces of both.
pub fn search(scene: &Scene) -> Part {
    let nodes = Counts::of(scene).nodes;
    let vector = size_of::<[f64; 3]>() as u64 * nodes;
    let basis = (lanczos::kept(3 * nodes as usize) as u64 + 2).min(MOST as u64);
    Part { name: "search for the critical step", bytes: (basis + 8) * vector }
}

/// Critical step of the engine's current positions. `guess`: a step of the right size, `before`: the last result.
pub fn assembled(
    engine: &mut dyn Engine,
    model: &Model,
    x: &[[f64; 3]],
    guess: f64,
    before: Option<&Critical>,
) -> Result<Critical> {
    let mut tangent = Tangent::new(engine, model, x);
    if tangent.held.iter().all(|held| *held) {
        // Where every component is prescribed no step is too long.
        return Ok(Critical { dt: guess, vector: vec![0.0; 3 * x.len()], iterations: 0 });
    }
    let start = tangent.start(before);
    let mass = tangent.mass.clone();
    let mut dt = guess;
    let mut iterations = 0;
    loop {
        let top = lanczos::largest(
            |w| Ok(tangent.apply(w, 2.0 / dt)?.iter().map(|b| b * dt * dt / 4.0).collect()),
            &mass,
            &start,
            TOLERANCE,
            MOST,
        )?;
        iterations += top.iterations;
        let stiffness = if model.viscosity.is_some() {
            rayleigh(&tangent.apply(&top.vector, 0.0)?, &top.vector, &mass)
        } else {
            top.value * 4.0 / (dt * dt)
        };
        let new = corrected(dt, &top, stiffness);
        // Without viscosity the first answer is exact; with it the pencil was that of `dt`. A step that is not a
        // number settles too: the next element pass says which element is broken.
        let moved = (new / dt - 1.0).abs();
        let settled = model.viscosity.is_none() || moved < 0.02 || moved.is_nan();
        dt = new;
        if settled {
            return Ok(Critical { dt, vector: top.vector, iterations });
        }
    }
}

/// M^-1 (K + s C) of the free components at the engine's positions, by differences of its forces.
struct Tangent<'a> {
    engine: &'a mut dyn Engine,
    x: &'a [[f64; 3]],
    /// By component: whether it is held, by the rim or the scene, and its mass [kg]; shape `[3 node_count]`.
    held: Vec<bool>,
    mass: Vec<f64>,
    /// Largest displacement of a difference [m].
    reach: f64,
}

impl<'a> Tangent<'a> {
    fn new(engine: &'a mut dyn Engine, model: &Model, x: &'a [[f64; 3]]) -> Self {
        let mut held = vec![false; 3 * x.len()];
        model.mesh.rim.iter().for_each(|&n| held[3 * n as usize..3 * n as usize + 3].fill(true));
        for (n, bits) in model.mesh.held.iter().enumerate() {
            (0..3).filter(|d| bits >> d & 1 == 1).for_each(|d| held[3 * n + d] = true);
        }
        let mass = model.mass.iter().flat_map(|&m| [m; 3]).collect();
        let single = engine.info().precision.is_single();
        let size = model.classes.iter().map(|c| c.volume.cbrt()).fold(f64::INFINITY, f64::min);
        // Difference step: its truncation error (second order in the strain) against the rounding of the forces.
        let reach = size * if single { 2e-3 } else { 1e-6 };
        Tangent { engine, x, held, mass, reach }
    }

    /// Where the iteration starts: from the last vector, if there is one of this size.
    fn start(&self, before: Option<&Critical>) -> Vec<f64> {
        let (held, mass) = (&self.held, &self.mass);
        match before {
            // A little of everything, so that a mode orthogonal to the last one can grow.
            Some(c) if c.vector.len() == mass.len() => {
                let noise = spread(mass.len(), |i| !held[i]);
                let scale = NEW / mass.iter().zip(&noise).map(|(m, n)| m * n * n).sum::<f64>().sqrt();
                c.vector.iter().zip(&noise).map(|(v, n)| v + scale * n).collect()
            }
            _ => spread(mass.len(), |i| !held[i]),
        }
    }

    /// The tangent times w, moving with `velocity` times it.
    fn apply(&mut self, w: &[f64], velocity: f64) -> Result<Vec<f64>> {
        let e = self.reach / w.iter().fold(0.0f64, |m, w| m.max(w.abs()));
        let x = self.x;
        let mut side = |s: f64| {
            let at = |n: usize, d: usize| s * e * w[3 * n + d];
            let moved: Vec<[f64; 3]> =
                (0..x.len()).map(|n| std::array::from_fn(|d| x[n][d] + at(n, d))).collect();
            let moving: Vec<[f64; 3]> =
                (0..x.len()).map(|n| std::array::from_fn(|d| velocity * at(n, d))).collect();
            self.engine.force(&moved, &moving)
        };
        let (f, g) = (side(1.0)?, side(-1.0)?);
        let free = |i: usize| if self.held[i] { 0.0 } else { 1.0 };
        Ok((0..self.mass.len())
            .map(|i| free(i) * (f[i / 3][i % 3] - g[i / 3][i % 3]) / (2.0 * e * self.mass[i]))
            .collect())
    }
}

/// A fixed vector with a share of every mode, zero where `free` is false.
fn spread(count: usize, free: impl Fn(usize) -> bool) -> Vec<f64> {
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    (0..count).map(|i| if free(i) { next() } else { 0.0 }).collect()
}

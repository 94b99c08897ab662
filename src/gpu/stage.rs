//! Programs that depend on the stage: the node pass, its probe, and the free rim.

use super::Gpu;
use super::bound::Bound;
use super::buffers::Buffers;
use super::compose::{Choice, Kernel, RimKind};
use super::meeting::Seat;
use super::program::Program;
use super::resident::Shape;
use super::rim::FreeRim;
use crate::engine::StageSetup;
use crate::error::Result;
use crate::physics::rim::SPIN;
use std::sync::Arc;

/// The stage's programs.
pub struct StagePrograms {
    /// Interior nodes, and those of the road and the rim.
    pub node: Bound,
    pub boundary: Option<Bound>,
    /// All of it in one work group.
    pub resident: Option<Arc<Bound>>,
    pub probe: Bound,
    /// Free rim: its step, and the same on a copy of its state for the probe.
    pub rim: Option<Bound>,
    pub probe_rim: Option<Bound>,
}

impl StagePrograms {
    /// Composes what a stage needs; `choice`: the stage's own.
    pub fn new(
        gpu: &Gpu,
        choice: &Choice,
        constants: &[(&'static str, f64)],
        buffers: &Buffers,
        setup: &StageSetup,
        rim: &FreeRim,
        resident: Option<(Shape, Option<&Seat>)>,
    ) -> Result<StagePrograms> {
        let constants = [constants, &stage_constants(setup, rim)].concat();
        let program = |kernel| Program::new(gpu, choice, kernel, &constants);
        let of = |name: &str| buffers.get(name);
        let of_probe = |name: &str| buffers.get(if name == "rim_state" { "rim_state_probe" } else { name });
        let (rim, probe_rim) = if choice.rim == RimKind::Free {
            let rim = program(Kernel::Rim)?;
            (Some(Bound::new(gpu, rim.clone(), of)), Some(Bound::new(gpu, rim, of_probe)))
        } else {
            (None, None)
        };
        let boundary = if choice.road.is_some() || choice.rim != RimKind::None {
            Some(Bound::new(gpu, program(Kernel::Boundary)?, of))
        } else {
            None
        };
        let resident = match resident {
            Some((shape, seat)) if choice.rim != RimKind::Free => {
                let constants = [&constants[..], &shape.constants()].concat();
                let program = Program::new(gpu, choice, Kernel::Resident, &constants)?;
                let made = Bound::of_all(gpu, program, of);
                Some(match seat {
                    Some(seat) => seat.program(made),
                    None => Arc::new(made),
                })
            }
            _ => None,
        };
        Ok(StagePrograms {
            resident,
            boundary,
            node: Bound::new(gpu, program(Kernel::Node)?, of),
            probe: Bound::new(gpu, program(Kernel::NodeProbe)?, of_probe),
            rim,
            probe_rim,
        })
    }
}

impl Choice {
    /// What a stage makes of the scene's choice.
    pub fn for_stage(&self, setup: &StageSetup) -> Choice {
        let free = setup.free.iter().any(Option::is_some);
        let rim = match self.rim {
            RimKind::None => RimKind::None,
            _ if free => RimKind::Free,
            _ => RimKind::Prescribed,
        };
        Choice { damping: setup.mass_damping > 0.0, rim, ..*self }
    }
}

/// Constants that change from stage to stage.
fn stage_constants(setup: &StageSetup, rim: &FreeRim) -> Vec<(&'static str, f64)> {
    let mut constants = vec![("alpha", setup.mass_damping), ("rim_alpha", setup.mass_damping)];
    let translations = ["free_x", "free_y", "free_z"].into_iter().zip([
        "inverse_mass_x",
        "inverse_mass_y",
        "inverse_mass_z",
    ]);
    for (component, (free, inverse)) in translations.enumerate() {
        let own = setup.free[component];
        constants.push((free, f64::from(u8::from(own.is_some()))));
        constants.push((inverse, own.map_or(0.0, |m| 1.0 / (m + rim.node_mass))));
    }
    constants.push(("free_spin", f64::from(u8::from(setup.free[SPIN].is_some()))));
    constants.push(("inverse_inertia", setup.free[SPIN].map_or(0.0, |i| 1.0 / (i + rim.node_inertia))));
    constants
}

//! Everything that an engine can dispatch: programs of the scene, composed once, and those of the present stage.

use super::Gpu;
use super::bound::Bound;
use super::buffers::{Buffers, step_stride};
use super::compose::{Choice, Kernel, RimKind};
use super::counts::{Counts, GROUP, PARTIALS};
use super::layout::{Real, Wgsl};
use super::meeting::Seat;
use super::program::Program;
use super::resident::Shape;
use super::rim::FreeRim;
use super::stage::StagePrograms;
use crate::engine::StageSetup;
use crate::error::Result;

/// The programs of an engine.
pub struct Programs {
    pub choice: Choice,
    constants: Vec<(&'static str, f64)>,
    pub force: Bound,
    pub gather: Bound,
    pub energy: Bound,
    pub surface_state: Option<Bound>,
    pub rebase: Option<Bound>,
    pub reductions: Reductions,
    /// What the present stage asks for, and its programs, composed when it begins.
    pub setup: StageSetup,
    pub stage: Option<StagePrograms>,
    /// How the mesh fits into one work group, and whether small meshes are kept there.
    pub fits: Option<Shape>,
    pub resident_allowed: bool,
    /// Whether something is done after every step, which a kernel that takes many leaves no place for.
    pub one_by_one: bool,
}

impl Programs {
    /// Programs of a scene, its stage not begun.
    pub fn new(
        gpu: &Gpu,
        choice: Choice,
        constants: Vec<(&'static str, f64)>,
        buffers: &Buffers,
        counts: &Counts,
        fits: Option<Shape>,
    ) -> Result<Programs> {
        let program = |kernel| Program::new(gpu, &choice, kernel, &constants);
        let bound = |kernel| Ok(Bound::new(gpu, program(kernel)?, |name| buffers.get(name)));
        // Forces are read back through the velocities' buffer, which the state does not need while it is on the host.
        let of_gather = |name: &str| buffers.get(if name == "forces" { "velocities" } else { name });
        let force = bound(Kernel::ElementForce)?;
        let surface_state = if counts.surface > 0 { Some(bound(Kernel::SurfaceState)?) } else { None };
        // Double precision has digits enough for any road.
        let rebase = match (counts.rim, choice.precision.real()) {
            (0, _) | (_, Real::Double) => None,
            _ => Some(bound(Kernel::Rebase)?),
        };
        Ok(Programs {
            force,
            surface_state,
            rebase,
            reductions: Reductions::new(gpu, &choice, buffers, counts.rim > 0)?,
            gather: Bound::new(gpu, program(Kernel::Gather)?, of_gather),
            energy: bound(Kernel::ElementEnergy)?,
            setup: StageSetup::default(),
            stage: None,
            fits,
            resident_allowed: false,
            one_by_one: false,
            choice,
            constants,
        })
    }

    /// Composes the present stage's programs.
    pub fn compose_stage(
        &mut self,
        gpu: &Gpu,
        buffers: &mut Buffers,
        counts: &Counts,
        rim: &FreeRim,
        seat: Option<&Seat>,
    ) -> Result<()> {
        let choice = self.choice.for_stage(&self.setup);
        if choice.other_works() && !buffers.has("works") {
            buffers.zeroed(gpu, "works", <[f64; 2]>::size(choice.precision.real()), counts.nodes);
        }
        let resident =
            self.fits.filter(|_| self.resident_allowed && !self.one_by_one).map(|shape| (shape, seat));
        let stage = StagePrograms::new(gpu, &choice, &self.constants, buffers, &self.setup, rim, resident)?;
        self.stage = Some(stage);
        gpu.check()
    }

    /// The present stage's programs.
    pub fn stage(&self) -> &StagePrograms {
        self.stage.as_ref().expect("a stage is composed before its programs are asked for")
    }

    /// Whether the present stage's steps are taken in one work group.
    pub fn is_resident(&self) -> bool {
        self.stage.as_ref().is_some_and(|stage| stage.resident.is_some())
    }

    pub fn has_free_rim(&self) -> bool {
        self.choice.for_stage(&self.setup).rim == RimKind::Free
    }

    /// The passes of one step, in order.
    pub fn passes(&self, counts: &Counts) -> Vec<Pass<'_>> {
        let stage = self.stage();
        let real = self.choice.precision.real();
        let pass = |name, program, groups, share| Pass { name, program, groups, share, real };
        if let Some(program) = &stage.resident {
            return vec![pass("resident", program, [1, 1, 1], 1.0)];
        }
        let share = |count: usize| count as f64 / counts.nodes as f64;
        let edge = counts.surface + counts.rim;
        let mut passes = vec![pass("element_force", &self.force, element_groups(counts), 1.0)];
        passes.extend(stage.rim.as_ref().map(|p| pass("rim", p, [1, 1, 1], share(counts.rim))));
        passes.push(pass("node", &stage.node, counts.groups(counts.nodes), 1.0 - share(edge)));
        passes.extend(stage.boundary.as_ref().map(|p| pass("boundary", p, counts.groups(edge), share(edge))));
        passes
    }
}

/// Work groups of a pass over the chains of elements.
pub fn element_groups(counts: &Counts) -> [u32; 3] {
    counts.groups(GROUP * counts.chain_groups)
}

/// One dispatch of a step.
pub struct Pass<'e> {
    pub name: &'static str,
    pub program: &'e Bound,
    pub groups: [u32; 3],
    /// Share of the nodes that it moves; 1 where it is about elements.
    pub share: f64,
    /// Of the plan.
    pub real: Real,
}

impl Pass<'_> {
    /// Records it for the step whose plan entry is `slot`.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass, slot: usize) {
        self.program.dispatch(pass, self.groups, (slot * step_stride(self.real)) as u32);
    }
}

/// Sums of records.
pub struct Reductions {
    rim: Option<Bound>,
    pub viscous: Option<Bound>,
    loss: Option<Bound>,
    probes: Bound,
    energies: Bound,
}

/// Columns of records, in numbers of four.
const RIM: u32 = 2;
const PROBES: u32 = 4;

impl Reductions {
    fn new(gpu: &Gpu, choice: &Choice, buffers: &Buffers, rim: bool) -> Result<Self> {
        let make =
            |records: &'static str, partials: &'static str, width: u32, least: bool| -> Result<Bound> {
                let constants = [("width", f64::from(width)), ("least_w", f64::from(u8::from(least)))];
                let program = Program::new(gpu, choice, Kernel::Reduce, &constants)?;
                Ok(Bound::new(gpu, program, |name| {
                    buffers.get(if name == "records" { records } else { partials })
                }))
            };
        Ok(Reductions {
            rim: if rim { Some(make("rim_sums", "partials_rim", RIM, false)?) } else { None },
            viscous: if choice.viscous {
                Some(make("viscous_work", "partials_viscous", 1, false)?)
            } else {
                None
            },
            loss: if choice.relaxes { Some(make("viscous_loss", "partials_loss", 1, false)?) } else { None },
            probes: make("probes", "partials_probes", PROBES, false)?,
            energies: make("energies", "partials_energies", 1, true)?,
        })
    }

    /// Adds up the energies of the elements.
    pub fn add_energies(&self, pass: &mut wgpu::ComputePass) {
        self.energies.dispatch(pass, [PARTIALS as u32, 1, 1], 0);
    }

    /// Adds up the rim's sums, if there is one.
    pub fn add_rim(&self, pass: &mut wgpu::ComputePass) {
        self.rim.iter().for_each(|rim| rim.dispatch(pass, [PARTIALS as u32, RIM, 1], 0));
    }

    /// Adds up the viscous works, if there are any.
    pub fn add_viscous(&self, pass: &mut wgpu::ComputePass) {
        self.viscous.iter().for_each(|viscous| viscous.dispatch(pass, [PARTIALS as u32, 1, 1], 0));
    }

    /// Adds up what relaxation and viscosity have lost, if there is any relaxation.
    pub fn add_loss(&self, pass: &mut wgpu::ComputePass) {
        self.loss.iter().for_each(|loss| loss.dispatch(pass, [PARTIALS as u32, 1, 1], 0));
    }

    /// Adds up what the probe left.
    pub fn add_probes(&self, pass: &mut wgpu::ComputePass) {
        self.probes.dispatch(pass, [PARTIALS as u32, PROBES, 1], 0);
    }
}

//! The check as text.

use std::fmt::{Display, Formatter, Result};

use super::body::Limiting;
use super::memory::CpuMemory;
use super::programs::{GpuPlan, Program};
use super::{Body, Check, StagePlan};
use crate::format::{bytes, count, duration, plural, si, updates};

impl Display for Check {
    fn fmt(&self, f: &mut Formatter) -> Result {
        writeln!(f, "{}\n  {} (hash {})", self.title, self.scene_file, &self.scene_hash[..12])?;
        if !self.expected.is_empty() {
            writeln!(f, "  expected: {}", self.expected)?;
        }
        write!(f, "\n{}", self.body)?;
        write!(f, "\n{}", self.curves)?;
        writeln!(f, "\npieces")?;
        for piece in &self.pieces {
            writeln!(f, "  {:<14} {}", piece.name, piece.detail.as_deref().unwrap_or("-  left out"))?;
        }
        writeln!(f, "\nstages")?;
        self.stages.iter().try_for_each(|stage| write!(f, "{stage}"))?;
        self.time(f)?;
        writeln!(f, "\noutputs")?;
        self.outputs.iter().try_for_each(|line| writeln!(f, "  {line}"))?;
        write!(f, "\n{}", self.cpu)?;
        write!(f, "\n{}", self.gpu)?;
        if !self.warnings.is_empty() {
            writeln!(f)?;
        }
        self.warnings.iter().try_for_each(|warning| writeln!(f, "warning: {warning}"))
    }
}

impl Check {
    fn time(&self, f: &mut Formatter) -> Result {
        let steps = &self.steps;
        writeln!(f, "\ntime")?;
        writeln!(
            f,
            "  {:<14} {}, from single elements at rest times the safety factor; a run takes it from the assembled body, \
             usually longer",
            "step",
            si(steps.dt_s, "s")
        )?;
        writeln!(f, "  {:<14} at most {}", "steps", count(steps.total))?;
        for e in &self.estimates {
            let (time, rate) = (duration(e.seconds), updates(e.updates_per_s));
            writeln!(f, "  {:<14} at most {time} on {}: {rate}, measured now", "estimate", e.engine)?;
        }
        Ok(())
    }
}

impl Display for Body {
    fn fmt(&self, f: &mut Formatter) -> Result {
        self.lines().iter().try_for_each(|(name, value)| writeln!(f, "  {name:<14} {value}"))
    }
}

impl Body {
    /// What is said of the body: names, and what they are; a line without a name goes on with the last.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let [e, n] = [self.elements, self.nodes].map(|n| count(n as u64));
        let rim =
            self.rim.as_ref().map_or("no rim".into(), |rim| format!("{} of the rim ({rim})", self.rim_nodes));
        let around = match self.around {
            Some(n) => format!("{n} elements round the axle"),
            None => "no rows of elements round the axle".into(),
        };
        let (G, kappa, E) = (self.shear_modulus_Pa, self.bulk_modulus_Pa, self.youngs_modulus_Pa);
        let [G, kappa, E] = [G, kappa, E].map(|modulus| si(modulus, "Pa"));
        let (c, s) = (self.wave_speed_m_s, self.shear_wave_speed_m_s);
        let mut lines = vec![
            ("mesh", self.mesh.clone()),
            ("", format!("{e} elements of {}, {n} nodes", plural(self.shape_classes, "shape"))),
            ("", format!("{} surface nodes, {rim}", self.surface_nodes)),
            ("", format!("{around}; node sets: {}", self.node_sets.join(", "))),
        ];
        lines.extend(self.quality());
        lines.extend([
            ("element", self.element.clone()),
            ("mass", format!("{}: {}", si(1e3 * self.mass_kg, "g"), self.mass_lumping)),
            ("law", format!("{}: {}", self.law, self.constants)),
            ("", format!("G = {G}, kappa = {kappa}, E = {E}, nu = {:.4}", self.poisson_ratio)),
            (
                "waves",
                format!("{c:.1} m/s of dilatation, {s:.1} m/s of shear; rho = {} kg/m3", self.density_kg_m3),
            ),
        ]);
        lines
    }
}

impl Body {
    /// Volume, shapes of elements, what limits the step, what a file did not say or says beside the mesh.
    fn quality(&self) -> Vec<(&'static str, String)> {
        let cm3 = 1e6 * self.volume_m3;
        let (worst, element) = (self.worst_scaled_jacobian, &self.worst_element);
        let one = |l: &Limiting| {
            let alike = if l.alike > 1 { format!(" and {} alike", l.alike - 1) } else { String::new() };
            format!("{}{alike} ({})", l.element, si(l.step_s, "s"))
        };
        let list: Vec<String> = self.limiting.iter().map(one).collect();
        let mut lines = vec![
            ("", format!("volume {cm3:.4} cm3; worst scaled Jacobian {worst:.3}, element {element}")),
            ("", format!("elements that limit the step: {}", list.join(", "))),
        ];
        lines.extend(self.notes.iter().map(|note| ("of the file", note.clone())));
        lines
    }
}

impl Display for StagePlan {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let steps = count(self.steps_at_most);
        writeln!(
            f,
            "  {:<14} {}, {} or {steps} steps at most",
            self.name,
            self.method,
            si(self.duration_s, "s")
        )?;
        if self.mass_damping_per_s > 0.0 {
            writeln!(f, "  {:<14} mass damping {} 1/s", "", self.mass_damping_per_s)?;
        }
        if let Some(start) = self.initial_velocity {
            writeln!(f, "  {:<14} {start}", "")?;
        }
        self.rim.iter().try_for_each(|motion| writeln!(f, "  {:<14} rim: {motion}", ""))
    }
}

impl Display for CpuMemory {
    fn fmt(&self, f: &mut Formatter) -> Result {
        writeln!(f, "CPU memory of a run, estimated from the element counts")?;
        for run in &self.runs {
            let parts: Vec<String> =
                run.parts.iter().map(|p| format!("{} {}", p.name, bytes(p.bytes))).collect();
            writeln!(f, "  {:<14} {:>10}  {}", run.precision, bytes(run.bytes), parts.join(", "))?;
        }
        if let (Some(there), Some(limit)) = (self.there, self.limit) {
            writeln!(f, "  {:<14} {:>10}  {limit}", "to be had", bytes(there))?;
        }
        Ok(())
    }
}

impl Display for GpuPlan {
    fn fmt(&self, f: &mut Formatter) -> Result {
        writeln!(f, "GPU programs (f32), each of only these parts")?;
        self.programs.iter().try_for_each(|program| write!(f, "{program}"))?;
        writeln!(f, "GPU memory: {}, the largest buffers", bytes(self.bytes))?;
        for buffer in self.buffers.iter().take(5) {
            writeln!(
                f,
                "  {:<14} {:>10}  {} entries",
                buffer.name,
                bytes(buffer.bytes),
                count(buffer.entries)
            )?;
        }
        Ok(())
    }
}

impl Display for Program {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let stages =
            if self.stages.is_empty() { String::new() } else { format!(" in {}", self.stages.join(", ")) };
        writeln!(f, "  {:<14} {}{stages}; {}", self.kernel, self.runs, plural(self.functions, "function"))?;
        writeln!(f, "  {:<14} {}", "  parts", self.parts.join(" "))?;
        let bindings: Vec<String> =
            self.bindings.iter().map(|b| format!("{} {} ({})", b.binding, b.name, b.access)).collect();
        writeln!(f, "  {:<14} {}", "  bindings", bindings.join(", "))
    }
}

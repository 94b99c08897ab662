//! Programs from parts: a kernel and whatever of the parts at hand it reaches, never more.
//!
//! Which parts are at hand is the table in [`roles`]; what a kernel reaches of them follows from the names they use
//! ([`closure`]), which a scanner finds ([`scan`]). Buffers are numbered once it is known which there are ([`numbering`]).
//! naga drops what is left that the entry point does not reach, and validates: what comes out is exactly what runs.

pub mod closure;
pub mod numbering;
mod roles;
pub mod scan;

use super::bindings::capabilities;
use super::layout::{self, Real};
use super::precision::Precision;
use crate::error::{Error, Result};
use crate::scene::{Element, Friction, Law};
use closure::{Fault, Part, Reached};
use naga::keywords::wgsl::{BUILTIN_IDENTIFIER_SET, RESERVED_SET};
use naga::valid::{ValidationFlags, Validator};
use numbering::Numbered;
use roles::Filled;
use std::collections::BTreeMap;
use std::sync::LazyLock;

// Every part: path below `shaders/` without its ending, and source. Written by build.rs from what is in the folder.
include!(concat!(env!("OUT_DIR"), "/parts.rs"));

/// Every part, read; by name.
static LIBRARY: LazyLock<std::result::Result<BTreeMap<&'static str, Part>, Fault>> =
    LazyLock::new(|| PARTS.iter().map(|(name, text)| Ok((*name, Part::new(name, text)?))).collect());

/// The structs that host and shaders share, in single and in double precision.
static STRUCTS: LazyLock<[std::result::Result<Part, Fault>; 2]> = LazyLock::new(|| {
    [Real::Single, Real::Double].map(|real| {
        let text: String = layout::all(real).iter().map(|s| s.text.as_str()).collect();
        Part::new("layout", &text)
    })
});

/// Entry points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kernel {
    ElementForce,
    ElementEnergy,
    /// Interior nodes; those of the road and the rim.
    Node,
    Boundary,
    /// Many steps of a small mesh in plain f32, its rim prescribed or none.
    Resident,
    NodeProbe,
    Rim,
    SurfaceState,
    /// Of histories at a high rate.
    Watch,
    Gather,
    Reduce,
    Rebase,
    CheckSums,
}

impl Kernel {
    pub const ALL: [Kernel; 13] = [
        Kernel::ElementForce,
        Kernel::ElementEnergy,
        Kernel::Node,
        Kernel::Boundary,
        Kernel::Resident,
        Kernel::NodeProbe,
        Kernel::Rim,
        Kernel::SurfaceState,
        Kernel::Watch,
        Kernel::Gather,
        Kernel::Reduce,
        Kernel::Rebase,
        Kernel::CheckSums,
    ];

    /// The file of its entry point.
    fn entry(self, precision: Precision) -> &'static str {
        match self {
            Kernel::ElementForce => "kernels/element_force",
            Kernel::ElementEnergy => "kernels/element_energy",
            Kernel::Node | Kernel::Boundary => "kernels/node",
            Kernel::Resident => "kernels/resident",
            Kernel::NodeProbe => "kernels/node_probe",
            Kernel::Rim => "kernels/rim",
            Kernel::SurfaceState => "kernels/surface_state",
            Kernel::Watch => "kernels/watch",
            Kernel::Gather => "kernels/gather",
            Kernel::Reduce => "kernels/reduce",
            Kernel::Rebase if precision.has_pairs() => "kernels/rebase_plus",
            Kernel::Rebase => "kernels/rebase",
            Kernel::CheckSums => "kernels/check_sums",
        }
    }

    /// What it is called where passes are listed.
    pub fn name(self) -> &'static str {
        match self {
            Kernel::Boundary => "boundary",
            other => other.entry(Precision::F32).trim_start_matches("kernels/"),
        }
    }
}

/// How the rim moves in a stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RimKind {
    None,
    Prescribed,
    Free,
}

/// Everything that decides which code a scene needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    pub element: Element,
    pub law: Law,
    /// Whether velocities are read: a viscosity, or a Prony series.
    pub viscous: bool,
    /// Whether points remember, by a Prony series.
    pub relaxes: bool,
    /// The road's name in a scene file.
    pub road: Option<&'static str>,
    pub friction: Option<Friction>,
    /// Whether some nodes have held components.
    pub held: bool,
    pub gravity: bool,
    pub damping: bool,
    pub rim: RimKind,
    pub precision: Precision,
    /// Whether every element is a plane figure extruded along eta (`Class::is_extruded`).
    pub extruded: bool,
    /// Few shape classes, the same along all chains of a work group.
    pub shared_classes: bool,
    /// Nodes and slots follow from numbers: a generator's mesh.
    pub lattice: bool,
    /// In a lattice: chains side by side in a work group add up their forces before they store them.
    pub joined: bool,
}

/// A program, ready to be compiled.
#[derive(Debug, Clone)]
pub struct Composed {
    /// Files that have a share in it, the entry point's first.
    pub parts: Vec<String>,
    /// All of its WGSL, with the files' own comments and the numbers of its buffers.
    pub text: String,
    /// The same, valid, without anything that the entry point does not reach.
    pub module: naga::Module,
}

impl Choice {
    /// A kernel as this choice needs it.
    ///
    /// # Errors
    /// [`Error::Device`]: a name that no part gives, or that two do, each named with its part; or what naga says.
    pub fn compose(&self, kernel: Kernel) -> Result<Composed> {
        let entry = kernel.entry(self.precision);
        compose(entry, &roles::filled(self, kernel), self.precision.real())
    }

    /// Its WGSL before buffers have their numbers: choices that have it in common have the program in common.
    ///
    /// # Errors
    /// Those of [`Choice::compose`] that are about names.
    pub fn draft(&self, kernel: Kernel) -> Result<String> {
        let entry = kernel.entry(self.precision);
        Ok(join(&reach(entry, &roles::filled(self, kernel), self.precision.real())?, &[]))
    }

    /// What a node needs that has neither road nor rim.
    fn interior(&self) -> Choice {
        Choice { road: None, friction: None, rim: RimKind::None, ..*self }
    }

    /// Whether works other than the internal one are booked by node.
    pub fn other_works(&self) -> bool {
        self.gravity || self.damping
    }
}

/// A kernel that depends on nothing but what its numbers are.
///
/// # Errors
/// Those of [`Choice::compose`].
pub fn plain(entry: &str, real: Real) -> Result<Composed> {
    compose(entry, &[roles::real(real)], real)
}

fn fault_of(entry: &str, detail: impl std::fmt::Display) -> Error {
    Error::Device { adapter: "shader composition".into(), detail: format!("{entry}: {detail}") }
}

/// What an entry point reaches, with these variants at hand.
fn reach(entry: &str, filled: &[Filled], real: Real) -> Result<Vec<Reached<'static>>> {
    let fail = |fault: &Fault| fault_of(entry, fault);
    let library = LIBRARY.as_ref().map_err(fail)?;
    let structs = STRUCTS[usize::from(real == Real::Double)].as_ref().map_err(fail)?;
    let get = |name: &str| library.get(name).ok_or_else(|| fail(&Fault::NoPart(name.into())));
    let mut at_hand = filled.iter().map(|role| get(&roles::part(role))).collect::<Result<Vec<_>>>()?;
    at_hand.extend(library.iter().filter(|(name, _)| name.starts_with("lib/")).map(|(_, part)| part));
    at_hand.push(structs);
    closure::close(get(entry)?, &at_hand, is_of_wgsl).map_err(|fault| fail(&fault))
}

fn compose(entry: &str, filled: &[Filled], real: Real) -> Result<Composed> {
    let fail = |detail: String| fault_of(entry, detail);
    let reached = reach(entry, filled, real)?;
    let draft = join(&reached, &[]);
    let mut module = naga::front::wgsl::parse_str(&draft).map_err(|e| fail(e.emit_to_string(&draft)))?;
    naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
    let declared = reached.iter().flat_map(|(_, own)| own).filter(|d| d.buffer);
    let buffers: Vec<&str> = declared.map(|d| d.name.as_str()).collect();
    let numbered = numbering::number(&mut module, &buffers, fail)?;
    Validator::new(ValidationFlags::all(), capabilities())
        .validate(&module)
        .map_err(|e| fail(format!("{e:?}")))?;
    let parts = reached.iter().map(|(part, _)| part.name.clone()).collect();
    Ok(Composed { parts, text: join(&reached, &numbered), module })
}

/// Names that the language gives. naga lists them but for short ones of vectors and matrices (`vec3f`), and its own `f64`.
fn is_of_wgsl(name: &str) -> bool {
    let long = match name.strip_suffix(['f', 'h', 'i', 'u']) {
        Some(long) if long.starts_with("vec") || long.starts_with("mat") => long,
        _ => name,
    };
    BUILTIN_IDENTIFIER_SET.contains(long) || RESERVED_SET.contains(name) || name == "f64"
}

/// WGSL of what is reached, part by part.
fn join(reached: &[Reached], numbered: &[Numbered]) -> String {
    let mut text = String::new();
    for (part, own) in reached {
        text += &format!("// ---- {}\n", part.name);
        if !part.head.is_empty() {
            text += &format!("{}\n", part.head);
        }
        for declaration in own {
            let number = numbered.iter().find(|n| declaration.buffer && n.name == declaration.name);
            let own = match number {
                Some(number) => numbering::with_number(&declaration.text, number),
                None => declaration.text.clone(),
            };
            text += &format!("\n{own}\n");
        }
        text += "\n";
    }
    text
}

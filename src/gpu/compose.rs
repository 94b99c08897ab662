//! Programs by concatenation: kernel + element + material + whatever the scene uses, never more.
//!
//! Module scope ignores order in WGSL, so the parts are simply joined; naga then drops what the entry point does not
//! reach, and what is left is exactly what runs.

use super::layout::{self, Real};
use super::precision::Precision;
use crate::error::{Error, Result};
use crate::scene::{Element, Friction, Law};
use naga::valid::{Capabilities, ValidationFlags, Validator};

macro_rules! shaders {
    ($($name:literal),* $(,)?) => {
        /// Every part: path below `shaders/` without its ending, and source.
        pub const PARTS: &[(&str, &str)] = &[$(($name, include_str!(concat!("../../shaders/", $name, ".wgsl")))),*];
    };
}
shaders!(
    "chain/lattice",
    "chain/table",
    "class/own",
    "class/shared",
    "contact/areas",
    "contact/areas_none",
    "contact/book",
    "contact/book_none",
    "contact/friction",
    "contact/friction_law",
    "contact/frictionless",
    "contact/landing",
    "contact/landing_none",
    "contact/none",
    "contact/project",
    "contact/step",
    "contact/step_none",
    "contact/step_resident",
    "damping/book",
    "damping/book_none",
    "damping/inertia",
    "damping/inertia_none",
    "damping/mass",
    "damping/none",
    "element/full",
    "element/q1p0",
    "element/uniform_gradient",
    "element/uniform_gradient_extruded",
    "friction/coulomb",
    "friction/pressure_velocity",
    "friction/stribeck",
    "friction/viscous",
    "gather/lattice",
    "gather/table",
    "hold/components",
    "hold/none",
    "kernels/check_sums",
    "kernels/element_energy",
    "kernels/element_force",
    "kernels/gather",
    "kernels/node",
    "kernels/node_probe",
    "kernels/rebase",
    "kernels/rebase_plus",
    "kernels/reduce",
    "kernels/resident",
    "kernels/rim",
    "kernels/surface_state",
    "lib/chains",
    "lib/coupling_any",
    "lib/coupling_plane",
    "lib/gravity",
    "lib/gravity_none",
    "lib/element_report",
    "lib/face",
    "lib/group_sum",
    "lib/hex8",
    "lib/index",
    "lib/alone",
    "lib/lattice",
    "lib/member",
    "lib/roles",
    "lib/invariants_i1",
    "lib/invariants_i2",
    "lib/mean",
    "lib/mean_elastic",
    "lib/mean_viscous",
    "lib/move_node",
    "lib/nodes",
    "lib/point_energy",
    "lib/points",
    "lib/points_elastic",
    "lib/points_viscous",
    "lib/symmetric",
    "lib/take_step",
    "lib/two_sum",
    "material/mooney_rivlin",
    "material/mooney_rivlin_eq4",
    "material/neo_hookean",
    "metric/any",
    "metric/identity",
    "metric/plane",
    "nodes/all",
    "nodes/boundary",
    "nodes/interior",
    "position/now_pairs",
    "position/now_plain",
    "position/pairs",
    "position/plain",
    "position/resident",
    "position/store_pairs",
    "position/store_plain",
    "real/double",
    "real/exp_double",
    "real/exp_single",
    "real/log_double",
    "real/log_single",
    "real/recip_cbrt_double",
    "real/recip_cbrt_single",
    "real/single",
    "real/turn_double",
    "real/turn_single",
    "rim/book",
    "rim/book_none",
    "rim/carried",
    "rim/free",
    "rim/none",
    "rim/prescribed",
    "road/plane",
    "slots/apart",
    "slots/gather_apart",
    "slots/gather_joined",
    "slots/joined",
    "viscosity/book",
    "viscosity/book_none",
    "viscosity/kelvin_voigt",
    "viscosity/rates",
    "viscosity/rates_resident",
    "works/book",
    "works/book_none",
    "works/take",
    "works/take_none",
);

/// Entry points, one a file of `shaders/kernels`.
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
    Gather,
    Reduce,
    Rebase,
    CheckSums,
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
    pub viscous: bool,
    pub road: bool,
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

/// What a shader may use: what every adapter has, and doubles.
pub(super) fn capabilities() -> Capabilities {
    Capabilities::default() | Capabilities::FLOAT64
}

/// A friction law and what finds the force with it; `exponential`: the part with e^x.
fn friction_parts(law: &Friction, exponential: &'static str) -> Vec<&'static str> {
    let areas = if law.needs_area() { "contact/areas" } else { "contact/areas_none" };
    match law {
        Friction::Coulomb(_) => vec!["contact/friction", "friction/coulomb"],
        Friction::Viscous(_) => vec!["contact/friction_law", "friction/viscous", areas],
        Friction::Stribeck(_) => vec!["contact/friction_law", "friction/stribeck", exponential, areas],
        Friction::PressureVelocity(_) => {
            vec!["contact/friction_law", "friction/pressure_velocity", exponential, areas]
        }
    }
}

impl Choice {
    /// Parts of a kernel, in reading order.
    pub fn parts(&self, kernel: Kernel) -> Vec<&'static str> {
        let mut parts = vec![self.of_real("real/single", "real/double")];
        parts.extend(self.own_parts(kernel));
        parts
    }

    fn own_parts(&self, kernel: Kernel) -> Vec<&'static str> {
        match kernel {
            Kernel::ElementForce => {
                let rates: &[&str] = if self.viscous { &["viscosity/rates"] } else { &[] };
                let store: &[&str] =
                    if self.joined { &["slots/joined", "slots/gather_joined"] } else { &["slots/apart"] };
                let own = &["kernels/element_force", "lib/alone", self.position()];
                [own, store, rates, &self.element_parts(), &self.force_parts()].concat()
            }
            Kernel::ElementEnergy => {
                [vec!["kernels/element_energy", self.position()], self.element_parts()].concat()
            }
            Kernel::Resident => self.resident_parts(),
            Kernel::Node => self.interior().step_parts("nodes/interior"),
            Kernel::Boundary => [self.step_parts("nodes/boundary"), vec!["lib/roles"]].concat(),
            Kernel::NodeProbe => [
                vec![
                    "kernels/node_probe",
                    "lib/alone",
                    "lib/group_sum",
                    "lib/roles",
                    self.now(),
                    self.damping_book(),
                ],
                vec![if self.other_works() { "works/take" } else { "works/take_none" }],
                self.node_parts(),
            ]
            .concat(),
            Kernel::Rim => {
                let turn = self.of_real("real/turn_single", "real/turn_double");
                [vec!["kernels/rim", turn, self.now(), self.gravity_part()], self.gather_parts()].concat()
            }
            Kernel::SurfaceState => vec!["kernels/surface_state", "lib/index", self.now()],
            Kernel::Gather => [vec!["kernels/gather", "lib/index"], self.gather_parts()].concat(),
            Kernel::Reduce => vec!["kernels/reduce"],
            Kernel::Rebase if self.precision.has_pairs() => {
                vec!["kernels/rebase_plus", "lib/index", "lib/two_sum"]
            }
            Kernel::Rebase => vec!["kernels/rebase", "lib/index"],
            Kernel::CheckSums => vec!["kernels/check_sums", "lib/two_sum"],
        }
    }

    fn of_real(&self, single: &'static str, double: &'static str) -> &'static str {
        match self.precision.real() {
            Real::Single => single,
            Real::Double => double,
        }
    }

    /// The part with e^x.
    fn exponential(&self) -> &'static str {
        self.of_real("real/exp_single", "real/exp_double")
    }

    /// The part with ln x, and what it needs.
    fn logarithm(&self) -> Vec<&'static str> {
        match self.precision.real() {
            Real::Single => vec!["real/log_single"],
            Real::Double => vec!["real/log_double", self.exponential()],
        }
    }

    fn needs_i2(&self) -> bool {
        self.law.has_i2()
    }

    fn element_parts(&self) -> Vec<&'static str> {
        let recip_cbrt = self.of_real("real/recip_cbrt_single", "real/recip_cbrt_double");
        let law = match self.law {
            Law::NeoHookean(_) => vec!["material/neo_hookean", recip_cbrt],
            Law::MooneyRivlin(_) => vec!["material/mooney_rivlin", recip_cbrt],
            Law::MooneyRivlinEq4(_) => [vec!["material/mooney_rivlin_eq4"], self.logarithm()].concat(),
        };
        let invariants = if self.needs_i2() { "lib/invariants_i2" } else { "lib/invariants_i1" };
        let classes = if self.shared_classes { "class/shared" } else { "class/own" };
        let metric = if self.extruded { "metric/plane" } else { "metric/any" };
        let element = match self.element {
            Element::Q1p0 => vec!["element/q1p0", "lib/point_energy", metric],
            Element::Full => vec!["element/full", "lib/point_energy", metric],
            Element::UniformGradient { .. } => {
                let routine = "element/uniform_gradient";
                let routine = if self.extruded { "element/uniform_gradient_extruded" } else { routine };
                vec![routine, "lib/mean", "metric/identity"]
            }
        };
        let chains: &[&str] = if self.lattice { &["chain/lattice", "lib/lattice"] } else { &["chain/table"] };
        let shared =
            vec![invariants, "lib/symmetric", "lib/chains", "lib/face", classes, "lib/hex8", "lib/index"];
        [element, shared, chains.to_vec(), law].concat()
    }

    /// Which columns of a lattice have their left neighbours' forces.
    fn join_part(&self) -> &'static str {
        if self.joined { "slots/gather_joined" } else { "slots/gather_apart" }
    }

    fn gather_parts(&self) -> Vec<&'static str> {
        if !self.lattice {
            return vec!["gather/table"];
        }
        vec!["gather/lattice", "lib/lattice", "lib/face", self.join_part()]
    }

    fn force_parts(&self) -> Vec<&'static str> {
        let mean = matches!(self.element, Element::UniformGradient { .. });
        let mut parts = vec!["lib/element_report"];
        if !mean {
            let plane = self.extruded && !self.needs_i2();
            parts.extend(["lib/points", if plane { "lib/coupling_plane" } else { "lib/coupling_any" }]);
        }
        parts.extend(match (mean, self.viscous) {
            (false, false) => vec!["lib/points_elastic", "viscosity/book_none"],
            (false, true) => vec!["lib/points_viscous", "viscosity/kelvin_voigt", "viscosity/book"],
            (true, false) => vec!["lib/mean_elastic", "viscosity/book_none"],
            (true, true) => vec!["lib/mean_viscous", "viscosity/kelvin_voigt", "viscosity/book"],
        });
        parts
    }

    fn position(&self) -> &'static str {
        if self.precision.has_pairs() { "position/pairs" } else { "position/plain" }
    }

    /// Element and node pass in one.
    fn resident_parts(&self) -> Vec<&'static str> {
        let mut parts = vec![
            "kernels/resident",
            "lib/member",
            "position/resident",
            "nodes/all",
            "lib/roles",
            "lib/take_step",
        ];
        parts.extend(if self.viscous { vec!["viscosity/rates_resident"] } else { vec![] });
        parts.extend(if self.road { vec!["contact/step_resident"] } else { vec!["contact/step_none"] });
        parts.extend(
            [self.element_parts(), self.force_parts(), self.move_parts(), self.book_parts()].concat(),
        );
        // The index folds dispatches of both passes.
        let mut met = std::collections::BTreeSet::new();
        parts.retain(|part| met.insert(*part));
        parts
    }

    fn node_parts(&self) -> Vec<&'static str> {
        [self.gather_parts(), self.move_parts()].concat()
    }

    fn move_parts(&self) -> Vec<&'static str> {
        let mut parts = vec!["lib/nodes", "lib/index", "lib/move_node", self.gravity_part()];
        parts.push(if self.damping { "damping/mass" } else { "damping/none" });
        parts.extend(match self.rim {
            RimKind::None => vec!["rim/none"],
            RimKind::Prescribed => vec!["rim/carried", "rim/prescribed"],
            RimKind::Free => vec!["rim/carried", "rim/free"],
        });
        if self.road {
            parts.push(if self.damping { "damping/inertia" } else { "damping/inertia_none" });
        }
        parts.extend(match (self.road, self.friction) {
            (false, _) => vec!["contact/none"],
            (true, None) => vec!["contact/project", "contact/frictionless", "road/plane"],
            (true, Some(law)) => {
                [vec!["contact/project", "road/plane"], friction_parts(&law, self.exponential())].concat()
            }
        });
        parts.push(if self.held { "hold/components" } else { "hold/none" });
        parts
    }

    /// What a node needs that has neither road nor rim.
    fn interior(&self) -> Choice {
        Choice { road: false, friction: None, rim: RimKind::None, ..*self }
    }

    /// Whether works other than the internal one are booked by node.
    pub fn other_works(&self) -> bool {
        self.gravity || self.damping
    }

    /// The node kernel over `nodes`.
    fn step_parts(&self, nodes: &'static str) -> Vec<&'static str> {
        [vec!["kernels/node", "lib/alone", "lib/take_step", nodes], self.node_parts(), self.booking_parts()]
            .concat()
    }

    fn book_parts(&self) -> Vec<&'static str> {
        let mut parts = vec![
            if self.other_works() { "works/book" } else { "works/book_none" },
            if self.rim == RimKind::None { "rim/book_none" } else { "rim/book" },
        ];
        if self.other_works() {
            parts.push(self.damping_book());
        }
        parts.push(if self.road { "contact/book" } else { "contact/book_none" });
        parts
    }

    fn booking_parts(&self) -> Vec<&'static str> {
        let mut parts = self.book_parts();
        parts.extend(if self.road {
            vec!["contact/step", "lib/group_sum"]
        } else {
            vec!["contact/step_none"]
        });
        parts.extend(match (self.precision.has_pairs(), self.road) {
            (false, _) => vec!["position/store_plain"],
            (true, false) => vec!["position/store_pairs", "lib/two_sum", "contact/landing_none"],
            (true, true) => vec!["position/store_pairs", "lib/two_sum", "contact/landing"],
        });
        parts
    }

    fn now(&self) -> &'static str {
        if self.precision.has_pairs() { "position/now_pairs" } else { "position/now_plain" }
    }

    fn damping_book(&self) -> &'static str {
        if self.damping { "damping/book" } else { "damping/book_none" }
    }

    fn gravity_part(&self) -> &'static str {
        if self.gravity { "lib/gravity" } else { "lib/gravity_none" }
    }

    /// WGSL of a kernel: shared structs and parts, joined.
    pub fn text(&self, kernel: Kernel) -> String {
        let shared = layout::all(self.precision.real());
        let mut text: String = shared.iter().map(|s| s.text.as_str()).collect();
        text += match self.element {
            Element::UniformGradient { .. } => "alias Class = MeanClass;\n",
            Element::Q1p0 | Element::Full => "alias Class = PointClass;\n",
        };
        for part in self.parts(kernel) {
            let (_, source) =
                PARTS.iter().find(|(name, _)| *name == part).expect("every part is listed in PARTS");
            text += source;
        }
        text
    }

    /// The composed module, reduced to what its entry point reaches, and valid.
    pub fn module(&self, kernel: Kernel) -> Result<naga::Module> {
        let text = self.text(kernel);
        let wrong = |detail: String| Error::Device { adapter: "shader composition".into(), detail };
        let mut module = naga::front::wgsl::parse_str(&text)
            .map_err(|e| wrong(format!("{kernel:?}: {}", e.emit_to_string(&text))))?;
        naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
        Validator::new(ValidationFlags::all(), capabilities())
            .validate(&module)
            .map_err(|e| wrong(format!("{kernel:?}: {e:?}")))?;
        Ok(module)
    }
}

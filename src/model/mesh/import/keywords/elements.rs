//! Element types by name: hexahedra, and how many nodes others have.

/// What an element's lines hold.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shape {
    pub name: String,
    pub is_hexahedron: bool,
    /// Nodes of one; `None`: not known, and lines go on where they end with a comma.
    pub nodes: Option<usize>,
}

/// Eight-node bricks of Abaqus, CalculiX and FrontISTR, with what becomes of each.
pub const HEXAHEDRA: [(&str, &str); 8] = [
    ("C3D8", "body.element = \"q1p0\" is nearest"),
    ("C3D8I", "body.element = \"q1p0\" is nearest: incompatible modes are not there"),
    ("C3D8H", "body.element = \"q1p0\" is nearest: pressures are eliminated, and kappa is finite"),
    ("C3D8IH", "body.element = \"q1p0\" is nearest: incompatible modes are not there"),
    ("C3D8R", "body.element = \"uniform-gradient\" is nearest"),
    ("C3D8RH", "body.element = \"uniform-gradient\" is nearest"),
    ("C3D8B", "body.element = \"q1p0\" is nearest"),
    ("361", "body.element = \"q1p0\" is nearest"),
];

/// Whether a type only marks faces where it stands beside hexahedra, as Gmsh writes the physical groups of surfaces: plane stress
/// and plane strain are nothing on the surface of a solid.
pub fn marks_faces(name: &str) -> bool {
    ["CPS3", "CPS4", "CPE3", "CPE4"].contains(&name)
}

/// Quadrilaterals of axisymmetric sections, and what Gmsh writes them as.
pub fn is_section(name: &str) -> bool {
    let kinds = ["CGAX4", "CAX4", "CPS4", "CPE4"];
    kinds
        .iter()
        .any(|k| name.strip_prefix(k).is_some_and(|rest| ["", "R", "H", "RH", "I", "IH"].contains(&rest)))
}

pub fn shape(name: &str) -> Shape {
    let is_hexahedron = HEXAHEDRA.iter().any(|h| h.0 == name);
    Shape { name: name.into(), is_hexahedron, nodes: is_hexahedron.then_some(8) }
}

/// A type that is left out, whatever it is.
pub fn dropped(name: &str) -> Shape {
    Shape { name: name.into(), is_hexahedron: false, nodes: None }
}

/// What to do about an element that is no hexahedron.
pub fn remedy(name: &str) -> &'static str {
    let begins = |with: &[&str]| with.iter().any(|w| name.starts_with(w));
    match () {
        () if begins(&["C3D4", "C3D10", "341", "342"]) => {
            "mesh it with hexahedra: tetrahedra are not modelled"
        }
        () if begins(&["C3D6", "C3D15", "351", "352"]) => {
            "mesh it with hexahedra alone: wedges are not modelled"
        }
        () if begins(&["C3D20", "C3D27", "362"]) => "mesh it with eight-node hexahedra (C3D8)",
        () if begins(&["CGAX3", "CAX3", "CGAX6", "CAX6"]) => {
            "mesh the section with quadrilaterals of four nodes alone: wedges are not modelled"
        }
        () if begins(&["CGAX", "CAX"]) => {
            "a section becomes a wheel with body.mesh.revolve = { sectors = 96 }"
        }
        () if begins(&["SFM", "M3D", "T3D"]) => {
            "reinforcement is not modelled; to leave it out on purpose, add it to body.mesh.drop"
        }
        () => "not modelled; to leave them out on purpose, add the type to body.mesh.drop",
    }
}

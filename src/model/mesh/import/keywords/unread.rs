//! Keywords whose cards are not read: which are of no consequence, and which say physics that a scene must say instead.

/// Keywords that make or change a mesh in ways that are not followed: a deck with one is refused.
pub const MAKES_MESH: [(&str, &str); 11] = [
    ("NGEN", "let the program that wrote the deck write all nodes"),
    ("NFILL", "let the program that wrote the deck write all nodes"),
    ("NCOPY", "let the program that wrote the deck write all nodes"),
    ("NMAP", "let the program that wrote the deck write all nodes"),
    ("ELGEN", "let the program that wrote the deck write all elements"),
    ("ELCOPY", "let the program that wrote the deck write all elements"),
    ("SYSTEM", "write the coordinates of *NODE in the global system"),
    (
        "SYMMETRIC MODEL GENERATION",
        "revolve the section in the program that made it, and export the solid mesh",
    ),
    ("IMPORT", "export the whole mesh into one deck"),
    ("SUBMODEL", "export the whole mesh into one deck"),
    ("ADAPTIVE MESH", "export the mesh as it is at the start"),
];

/// Keywords without consequence for a mesh and its physics: outputs, headings, ends of blocks.
pub const HARMLESS: [&str; 31] = [
    "HEADING",
    "HEADER",
    "PREPRINT",
    "ASSEMBLY",
    "END ASSEMBLY",
    "END PART",
    "END INSTANCE",
    "END STEP",
    "END",
    "OUTPUT",
    "NODE OUTPUT",
    "ELEMENT OUTPUT",
    "CONTACT OUTPUT",
    "ENERGY OUTPUT",
    "NODE PRINT",
    "EL PRINT",
    "NODE FILE",
    "EL FILE",
    "CONTACT PRINT",
    "CONTACT FILE",
    "FILE OUTPUT",
    "FILE FORMAT",
    "RESTART",
    "MONITOR",
    "PRINT",
    "PARAMETER",
    "NODE PRINT",
    "ORIENTATION",
    "TRANSFORM",
    "DISTRIBUTION",
    "DISTRIBUTION TABLE",
];

/// Keywords that say physics, by what a scene has in their place.
pub const PHYSICS: [(&str, &str); 47] = [
    ("STEP", "[[stage]]"),
    ("STATIC", "[[stage]]"),
    ("DYNAMIC", "[[stage]]"),
    ("VISCO", "[[stage]]"),
    ("STEADY STATE TRANSPORT", "[[stage]]"),
    ("TRANSPORT VELOCITY", "[stage.rim]"),
    ("MOTION", "[stage.rim]"),
    ("BOUNDARY", "[rim], [[hold]] and [stage.rim]"),
    ("CLOAD", "[stage.rim]"),
    ("AMPLITUDE", "the ramps of [stage.rim]"),
    ("DLOAD", "gravity, or nothing"),
    ("DSLOAD", "nothing: pressures on faces are not modelled"),
    ("INITIAL CONDITIONS", "body.velocity"),
    ("RIGID BODY", "[rim]"),
    ("KINEMATIC COUPLING", "[rim]"),
    ("DISTRIBUTING COUPLING", "[rim]"),
    ("COUPLING", "[rim]"),
    ("KINEMATIC", "[rim]"),
    ("MPC", "[rim]"),
    ("EQUATION", "[[hold]], or nothing"),
    ("TIE", "nothing: mesh the parts with common nodes"),
    ("EMBEDDED ELEMENT", "nothing: reinforcement is not modelled"),
    ("REBAR", "nothing: reinforcement is not modelled"),
    ("REBAR LAYER", "nothing: reinforcement is not modelled"),
    ("SURFACE SECTION", "nothing: reinforcement is not modelled"),
    ("MEMBRANE SECTION", "nothing: membranes are not modelled"),
    ("SHELL SECTION", "nothing: shells are not modelled"),
    ("MASS", "the mass of a free rim"),
    ("ROTARY INERTIA", "the inertia of a free rim"),
    ("SPRING", "nothing: springs are not modelled"),
    ("DASHPOT", "nothing: dashpots are not modelled"),
    ("CONNECTOR SECTION", "nothing: connectors are not modelled"),
    ("CONTACT", "[road] and [friction]"),
    ("CONTACT PAIR", "[road] and [friction]"),
    ("CONTACT INCLUSIONS", "[road] and [friction]"),
    ("SURFACE INTERACTION", "[friction]"),
    ("SURFACE BEHAVIOR", "[road]"),
    ("FRICTION", "[friction]"),
    ("CHANGE FRICTION", "[friction]"),
    ("ELASTIC", "[body.material]"),
    ("PLASTIC", "nothing: rubber here is hyperelastic"),
    ("VISCOELASTIC", "body.material.viscosity, which is another law"),
    ("HYPERFOAM", "[body.material]"),
    ("MULLINS EFFECT", "nothing: softening is not modelled"),
    ("DAMPING", "body.material.viscosity, or mass_damping of a stage"),
    ("EXPANSION", "nothing: temperature is not modelled"),
    ("HOURGLASS", "body.hourglass"),
];

/// What a keyword that is not read is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Harmless,
    /// With what the scene has in its place.
    Physics(&'static str),
    /// With what to do instead.
    MakesMesh(&'static str),
    Unknown,
}

pub fn kind(name: &str) -> Kind {
    let find = |table: &[(&'static str, &'static str)]| table.iter().find(|k| k.0 == name).map(|k| k.1);
    if HARMLESS.contains(&name) {
        return Kind::Harmless;
    }
    find(&PHYSICS)
        .map(Kind::Physics)
        .or_else(|| find(&MAKES_MESH).map(Kind::MakesMesh))
        .unwrap_or(Kind::Unknown)
}

/// Surfaces that are no part of a mesh: analytical ones, and those made of others.
pub fn surface(kind: &str) -> bool {
    ["SEGMENTS", "CYLINDER", "REVOLUTION", "USER", "CUTTING SURFACE"].contains(&kind)
}

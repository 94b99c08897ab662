//! Histories of nodes at a high rate, for noise.

use super::NodeSet;

/// A history: what is taken down, where, how often. One file each.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    /// Name of its file.
    pub name: String,
    pub places: Places,
    /// At least one.
    pub quantities: Vec<Quantity>,
    /// Values a second, on an even grid [Hz]: 1 to 50 kHz.
    pub rate: f64,
    /// Names of the stages that are taken down; `None`: every explicit one.
    pub stages: Option<Vec<String>>,
    pub formats: Vec<Format>,
}

/// Where values are taken.
#[derive(Debug, Clone, PartialEq)]
pub enum Places {
    /// At these nodes, which go where the material goes.
    Material(NodeSet),
    /// At points that stand where these nodes stand when the wheel has not turned, and stay there while it turns: on the deformed
    /// surface, at the same angle from the wheel's own axes.
    Unturned(NodeSet),
    /// At points of the outer surface [m], in the reference shape, which go where the material goes.
    Points(Vec<[f64; 3]>),
}

/// What is taken down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// From the reference shape; of unturned points: from where the point would be on a rigid wheel [m].
    Displacement,
    /// Of the material at the place [m/s].
    Velocity,
    /// Of the material at the place [m/s2].
    Acceleration,
    /// Where the place is [m].
    Position,
    /// Force of the road on the node [N].
    ContactForce,
    /// Normal part of that force over the node's area in the reference shape [Pa].
    Pressure,
}

impl Quantity {
    /// By the names that scenes and files give them.
    pub const ALL: [(&'static str, Quantity); 6] = [
        ("displacement", Quantity::Displacement),
        ("velocity", Quantity::Velocity),
        ("acceleration", Quantity::Acceleration),
        ("position", Quantity::Position),
        ("contact-force", Quantity::ContactForce),
        ("pressure", Quantity::Pressure),
    ];

    pub fn name(self) -> &'static str {
        Quantity::ALL.iter().find(|(_, q)| *q == self).map_or("", |(name, _)| name)
    }

    pub fn unit(self) -> &'static str {
        match self {
            Quantity::Displacement | Quantity::Position => "m",
            Quantity::Velocity => "m/s",
            Quantity::Acceleration => "m/s2",
            Quantity::ContactForce => "N",
            Quantity::Pressure => "Pa",
        }
    }

    /// Numbers a place.
    pub fn components(self) -> usize {
        if self == Quantity::Pressure { 1 } else { 3 }
    }

    pub fn is_contact(self) -> bool {
        matches!(self, Quantity::ContactForce | Quantity::Pressure)
    }
}

/// Files that a history is written to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Arrays of NumPy.
    Npz,
    /// Universal file, datasets 2411, 2412 and 58b.
    Uff,
}

impl Format {
    /// Of the file's name.
    pub fn ending(self) -> &'static str {
        match self {
            Format::Npz => "npz",
            Format::Uff => "uff",
        }
    }
}

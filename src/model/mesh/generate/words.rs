//! Descriptions of meshes, for people.

use crate::scene::Grading;

/// A length in millimetres, without the round-off of reading it [m].
pub fn mm(length: f64) -> String {
    format!("{}", (length * 1e9).round() / 1e6)
}

/// What follows the size of a mesh in its description.
pub fn grading(grading: &Grading) -> String {
    match *grading {
        Grading { ratio: [1.0, 1.0, 1.0], .. } => String::new(),
        Grading { ratio: [a, b, c], fine_arc: 0.0 } => format!(", sizes grow by {a}, {b}, {c}"),
        Grading { ratio: [a, b, c], fine_arc } => {
            format!(", sizes grow by {a} (outside {:.0} deg), {b}, {c}", fine_arc.to_degrees())
        }
    }
}

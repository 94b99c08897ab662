//! Sets of nodes whose components follow a motion, or whose reaction at rest is recorded.

use crate::scene::SetMotion;

/// A set of nodes and what some of their components follow.
#[derive(Debug, Clone)]
pub struct Driven {
    /// Ascending; none of the rim's.
    pub nodes: Vec<u32>,
    /// Which components are prescribed.
    pub components: [bool; 3],
    pub motion: SetMotion,
}

impl Driven {
    /// A node that stands at X in the reference shape, from the point that positions of the set are taken from [m].
    pub fn arm(&self, X: [f64; 3]) -> [f64; 3] {
        let about = self.motion.about();
        std::array::from_fn(|d| X[d] - about[d])
    }
}

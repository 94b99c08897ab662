//! Shapes of elements: how far they are from boxes.

use super::{Mesh, SIGNS};
use crate::physics::tensor::{cross, dot, scale, sub};

/// Scaled Jacobian below which an element is nearly flat: forces of such an element are of little use, and the step is that of its
/// thickness.
pub const FLAT: f64 = 0.05;

/// Volume of the box that the edges at each corner span, signed, and the same over the lengths of the three edges there: 1 where they are at right
/// angles, 0 where they lie in a plane.
///
/// P. Knupp et al., "The Verdict Geometric Quality Library" (SAND2007-1751), "scaled Jacobian" of a hexahedron, there with the
/// middle of the element beside the corners.
pub fn corner_jacobians(corners: &[[f64; 3]; 8]) -> [[f64; 2]; 8] {
    std::array::from_fn(|a| {
        let edge = |d: usize| {
            let sign = -SIGNS[a][d];
            let mut other = SIGNS[a];
            other[d] = sign;
            let b = SIGNS.iter().position(|s| *s == other).expect("eight corners");
            scale(sub(corners[b], corners[a]), sign)
        };
        let [u, v, w] = [edge(0), edge(1), edge(2)];
        let det = dot(u, cross(v, w));
        let lengths = [u, v, w].map(|e| dot(e, e).sqrt()).iter().product::<f64>();
        [det, if lengths > 0.0 { det / lengths } else { 0.0 }]
    })
}

/// The smallest scaled Jacobian of an element's corners; not positive where it is inside out or flat.
pub fn scaled_jacobian(corners: &[[f64; 3]; 8]) -> f64 {
    corner_jacobians(corners).iter().map(|j| j[1]).fold(f64::INFINITY, f64::min)
}

/// The smallest scaled Jacobian of a mesh, and its element; none of an empty one.
pub fn worst(mesh: &Mesh) -> Option<(f64, usize)> {
    let all = mesh.hexes.iter().enumerate();
    let all = all.map(|(e, hex)| (scaled_jacobian(&hex.map(|n| mesh.nodes[n as usize])), e));
    all.min_by(|a, b| a.0.total_cmp(&b.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> [[f64; 3]; 8] {
        SIGNS.map(|s| s.map(|c| 0.5 * (c + 1.0)))
    }

    #[test]
    fn a_cube_has_one_and_what_is_sheared_its_sine() {
        assert!((scaled_jacobian(&cube()) - 1.0).abs() < 1e-15);
        let stretched = cube().map(|[x, y, z]| [3.0 * x, 0.1 * y, z]);
        assert!((scaled_jacobian(&stretched) - 1.0).abs() < 1e-15, "lengths do not count");
        // Edges along eta lean by 30 degrees from the normal: cos 30.
        let angle = 30f64.to_radians();
        let sheared = cube().map(|[x, y, z]| [x + y * angle.sin(), y * angle.cos(), z]);
        assert!((scaled_jacobian(&sheared) - angle.cos()).abs() < 1e-15);
    }

    #[test]
    fn the_determinant_is_that_of_the_volume() {
        let box_ = cube().map(|[x, y, z]| [3.0 * x, 2.0 * y, 5.0 * z]);
        assert!(corner_jacobians(&box_).iter().all(|j| (j[0] - 30.0).abs() < 1e-13));
        let mirrored = box_.map(|[x, y, z]| [x, y, -z]);
        assert!(corner_jacobians(&mirrored).iter().all(|j| j[0] < 0.0 && j[1] == -1.0));
    }
}

//! How element sizes vary along a direction: the shares of its length before each node.

use std::f64::consts::TAU;

/// Share of the length before node i of n, sizes growing by `ratio` from end to end.
pub fn share(i: usize, n: usize, ratio: f64) -> f64 {
    let s = i as f64 / n as f64;
    grown(s, ratio)
}

fn grown(s: f64, ratio: f64) -> f64 {
    // Elements that hardly grow: the formula below would divide zero by zero.
    if (ratio - 1.0).abs() < 1e-12 { s } else { (ratio.powf(s) - 1.0) / (ratio - 1.0) }
}

/// The same for sizes that grow from both ends to the middle.
pub fn share_from_ends(i: usize, n: usize, ratio: f64) -> f64 {
    let s = i as f64 / n as f64;
    if s <= 0.5 { 0.5 * grown(2.0 * s, ratio) } else { 1.0 - 0.5 * grown(2.0 * (1.0 - s), ratio) }
}

/// Share of a turn before node i of n round a ring: equal elements within `arc` [rad] about node 0, sizes that grow by
/// `ratio` from there to the far side.
pub fn turn(i: usize, n: usize, ratio: f64, arc: f64) -> f64 {
    let s = i as f64 / n as f64;
    if (ratio - 1.0).abs() < 1e-12 {
        return s;
    }
    // Half a turn is the unit: `equal` of it has equal elements, which take the share `index` of the numbers;
    // sizes agree where the parts meet.
    let equal = (arc / TAU).min(1.0);
    let index = 1.0 / (1.0 + (1.0 - equal) / equal * ratio.ln() / (ratio - 1.0));
    let half = |t: f64| match t <= index {
        true if equal > 0.0 => equal * t / index,
        _ => equal + (1.0 - equal) * grown((t - index) / (1.0 - index), ratio),
    };
    if s <= 0.5 { 0.5 * half(2.0 * s) } else { 1.0 - 0.5 * half(2.0 * (1.0 - s)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::mesh::Mesh;
    use crate::scene::{Grading, MeshSpec};

    fn ring(elements: [usize; 3], ratio: [f64; 3], fine_arc: f64) -> Mesh {
        let spec = MeshSpec::Ring { outer_radius: 2.0, inner_radius: 1.0, width: 0.5, elements };
        Mesh::graded(&spec, &Grading { ratio, fine_arc })
    }

    /// Angles from the bottom of the outermost row at y-min, ascending, in one turn.
    fn angles(mesh: &Mesh, around: usize) -> Vec<f64> {
        let first = mesh.nodes.len() - 2 * around;
        let angle = |n: &[f64; 3]| (-n[0]).atan2(2.0 - n[2]).rem_euclid(TAU);
        mesh.nodes[first..first + around].iter().map(angle).collect()
    }

    #[test]
    fn sizes_grow_by_the_ratio() {
        let spec = MeshSpec::Block { size: [1.0, 2.0, 3.0], elements: [40, 1, 8] };
        let mesh = Mesh::graded(&spec, &Grading { ratio: [4.0, 1.0, 0.5], fine_arc: 0.0 });
        let x: Vec<f64> = (0..=40).map(|i| mesh.nodes[i][0]).collect();
        let sizes: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
        for pair in sizes.windows(2) {
            assert!((pair[1] / pair[0] - 4.0f64.powf(1.0 / 40.0)).abs() < 1e-12, "geometric");
        }
        assert!((x[40] - 1.0).abs() < 1e-15 && x[0] == 0.0);
    }

    #[test]
    fn a_mesh_of_half_as_many_elements_has_every_other_node() {
        let spec = |elements| MeshSpec::Block { size: [1.0; 3], elements };
        let grading = Grading { ratio: [7.0, 0.3, 2.0], fine_arc: 0.0 };
        let [fine, coarse] = [[8, 4, 6], [4, 2, 3]].map(|e| Mesh::graded(&spec(e), &grading));
        for x in &coarse.nodes {
            let near = |y: &[f64; 3]| (0..3).all(|d| (x[d] - y[d]).abs() < 1e-14);
            assert!(fine.nodes.iter().any(near), "{x:?}");
        }
        let [fine, coarse] = [96, 48].map(|n| angles(&ring([n, 1, 1], [9.0, 1.0, 1.0], 0.6), n));
        coarse.iter().zip(fine.iter().step_by(2)).for_each(|(a, b)| assert!((a - b).abs() < 1e-12));
    }

    #[test]
    fn a_ring_is_fine_within_its_arc_and_symmetric() {
        let (n, arc) = (90, 0.8);
        let angles = angles(&ring([n, 1, 1], [10.0, 1.0, 1.0], arc), n);
        let sizes: Vec<f64> = angles.windows(2).map(|w| w[1] - w[0]).collect();
        let fine: Vec<f64> = angles.windows(2).filter(|w| w[1] < 0.5 * arc).map(|w| w[1] - w[0]).collect();
        assert!(fine.len() > 5 && fine.iter().all(|s| (s / fine[0] - 1.0).abs() < 1e-9));
        // The element at the top is nearly ten times as long: it ends half an element's growth before the top.
        assert!((8.5..10.1).contains(&(sizes[n / 2 - 1] / fine[0])), "{}", sizes[n / 2 - 1] / fine[0]);
        for i in 1..n {
            assert!((angles[i] + angles[n - i] - TAU).abs() < 1e-12, "left is right");
        }
        let largest = sizes.windows(2).map(|w| (w[1] / w[0]).max(w[0] / w[1])).fold(0.0, f64::max);
        assert!(largest < 1.12, "no jump: {largest}");
    }
}

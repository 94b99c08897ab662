//! The point that an imported wheel turns about.

use crate::model::mesh::NamedNodes;
use crate::scene::MeshFile;

/// Rim nodes may be this far from a circle, over its radius: a rim may have a shape.
const ROUND: f64 = 0.05;

/// The axle [m], turned as the mesh is, and where it is from, in words: what the scene says; else what is `known`; else the middle of the circle that the
/// rim's nodes stand on (a rim is round, though its nodes need not be on one cylinder), half-way between its sides; else the middle
/// of the box round the body.
pub fn of(
    file: &MeshFile,
    known: Option<[f64; 3]>,
    nodes: &[[f64; 3]],
    rim: Option<&NamedNodes>,
) -> ([f64; 3], String) {
    let shown = |[x, y, z]: [f64; 3]| format!("at ({:.4}, {:.4}, {:.4}) mm", 1e3 * x, 1e3 * y, 1e3 * z);
    if let Some(axle) = file.axle {
        let axle = file.axis.to_y(axle);
        return (axle, format!("{}, as the scene says", shown(axle)));
    }
    if let Some(axle) = known {
        return (axle, format!("{}, which the section is turned about", shown(axle)));
    }
    if let Some(axle) = rim.and_then(|rim| of_circle(nodes, &rim.nodes)) {
        return (axle, format!("{}, the middle of the rim's circle", shown(axle)));
    }
    let (low, high) = bounds(nodes.iter());
    let axle = std::array::from_fn(|d| 0.5 * (low[d] + high[d]));
    (axle, format!("{}, the middle of the body", shown(axle)))
}

fn bounds<'a>(points: impl Iterator<Item = &'a [f64; 3]>) -> ([f64; 3], [f64; 3]) {
    points.fold(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), |(low, high), x| {
        (std::array::from_fn(|d| low[d].min(x[d])), std::array::from_fn(|d| high[d].max(x[d])))
    })
}

/// The circle in the (x, z) plane that fits nodes best: x^2 + z^2 = 2 a x + 2 b z + c by least squares (Kåsa, IEEE Trans. Instrum.
/// Meas. 25 (1976) 8), about the nodes' mean. `None` where they stand on none.
fn of_circle(nodes: &[[f64; 3]], rim: &[u32]) -> Option<[f64; 3]> {
    let count = rim.len() as f64;
    let points = || rim.iter().map(|&n| nodes[n as usize]);
    let mean = points().fold([0.0; 2], |m, x| [m[0] + x[0] / count, m[1] + x[2] / count]);
    // Sums of products of u, v and of u^2 + v^2; those of u and v alone are zero.
    let [mut uu, mut uv, mut vv, mut uq, mut vq, mut qq] = [0.0; 6];
    for x in points() {
        let (u, v) = (x[0] - mean[0], x[2] - mean[1]);
        let q = u * u + v * v;
        (uu, uv, vv) = (uu + u * u, uv + u * v, vv + v * v);
        (uq, vq, qq) = (uq + u * q, vq + v * q, qq + q);
    }
    let det = uu * vv - uv * uv;
    // Nodes in a line are on no circle.
    if rim.len() < 3 || det <= 1e-9 * (uu + vv).powi(2) {
        return None;
    }
    let (a, b) = ((uq * vv - vq * uv) / (2.0 * det), (vq * uu - uq * uv) / (2.0 * det));
    let radius = (qq / count + a * a + b * b).sqrt();
    let (x, z) = (mean[0] + a, mean[1] + b);
    let off = points().map(|p| ((p[0] - x).hypot(p[2] - z) - radius).abs()).fold(0.0, f64::max);
    let (low, high) = bounds(rim.iter().map(|&n| &nodes[n as usize]));
    (off <= ROUND * radius).then_some([x, 0.5 * (low[1] + high[1]), z])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_of_a_rim_gives_its_middle() {
        let on = |i: usize| {
            let (sin, cos) = (0.1 * i as f64).sin_cos();
            [3.0 + 2.0 * cos, [0.4, 0.6][i % 2], -1.0 + 2.0 * sin]
        };
        let nodes: Vec<_> = (0..20).map(on).collect();
        let rim: Vec<u32> = (0..20).collect();
        let axle = of_circle(&nodes, &rim).unwrap();
        for (got, wanted) in axle.into_iter().zip([3.0, 0.5, -1.0]) {
            assert!((got - wanted).abs() < 1e-12, "{axle:?}");
        }
    }

    #[test]
    fn lines_and_squares_are_no_circles() {
        let line: Vec<_> = (0..9).map(|i| [f64::from(i), 0.0, 2.0 * f64::from(i)]).collect();
        assert_eq!(of_circle(&line, &(0..9).collect::<Vec<u32>>()), None);
        let square: Vec<_> = (0..9).map(|i| [f64::from(i % 3), 0.0, f64::from(i / 3)]).collect();
        assert_eq!(of_circle(&square, &(0..9).collect::<Vec<u32>>()), None);
    }
}

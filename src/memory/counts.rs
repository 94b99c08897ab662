//! How many of each thing a mesh will have, before it is made.

use crate::scene::{MeshSpec, Scene};

/// Numbers of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Counts {
    pub elements: u64,
    pub nodes: u64,
    /// Outer quadrilaterals, and nodes that can touch the road.
    pub facets: u64,
    pub surface: u64,
    /// Lines of nodes along the first direction, and nodes of one.
    pub lines: u64,
    pub line_nodes: u64,
    /// Lines of a layer across the third direction.
    pub layer_lines: u64,
    /// Distinct shapes of elements, at most, and of those along the first direction alone.
    pub shapes: u64,
    pub line_shapes: u64,
}

impl Counts {
    /// Of the mesh that a scene describes.
    pub fn of(scene: &Scene) -> Counts {
        if let MeshSpec::File(file) = &scene.body.mesh {
            return Counts::guessed(std::fs::metadata(&file.path).map_or(0, |m| m.len()));
        }
        let grading = &scene.body.grading;
        let even = |d: usize| (grading.ratio[d] - 1.0).abs() < 1e-12;
        let kinds = |n: usize, d: usize| if even(d) { 1 } else { n as u64 };
        // Logical counts: around or along x, across, through; whether the first closes; shapes along each.
        let ([i, j, k], closed, shapes) = match scene.body.mesh {
            MeshSpec::Ring { elements: [around, through, across], .. } => {
                // Sizes grow from the bottom to the top both ways, and from both side faces; radii differ from layer to layer.
                let shapes = [kinds(around / 2 + 1, 0), kinds(across / 2 + 1, 2), through as u64];
                ([around, across, through], true, shapes)
            }
            MeshSpec::Block { elements, .. } => {
                (elements, false, std::array::from_fn(|d| kinds(elements[d], d)))
            }
            MeshSpec::File(_) => unreachable!("counts of a file are guessed from its size"),
        };
        let [i, j, k] = [i as u64, j as u64, k as u64];
        let line_nodes = if closed { i } else { i + 1 };
        let lines = (j + 1) * (k + 1);
        let inside = j.saturating_sub(1) * k.saturating_sub(1);
        let ends = if closed { 0 } else { 2 };
        let boundary = line_nodes * lines - inside * (line_nodes - ends.min(line_nodes));
        // A set that the mesh does not have is an error of the mesh, not of its size.
        let rim = match scene.rim.as_ref().map_or("", |rim| rim.nodes.name.as_str()) {
            "all" => boundary,
            "inner" | "outer" | "z-min" | "z-max" => line_nodes * (j + 1),
            "y-min" | "y-max" => line_nodes * (k + 1),
            "x-min" | "x-max" => lines,
            _ => 0,
        };
        Counts {
            elements: i * j * k,
            nodes: line_nodes * lines,
            facets: 2 * i * (j + k) + ends * j * k,
            surface: boundary - rim,
            lines,
            line_nodes,
            layer_lines: j + 1,
            shapes: shapes.iter().product(),
            line_shapes: shapes[0],
        }
    }

    /// Of a mesh in a file of so many bytes, before it is read: a hexahedron and its share of nodes take about as much in every
    /// format (numbers of eight corners, three coordinates), as text or not. Shapes may all differ; the rest is what a cube has.
    fn guessed(bytes: u64) -> Counts {
        const BYTES: u64 = 100;
        let elements = bytes / BYTES + 1;
        let side = (elements as f64).cbrt().ceil() as u64;
        let facets = 6 * side * side;
        Counts {
            elements,
            nodes: elements + facets / 2 + 8,
            facets,
            surface: facets + 2,
            lines: (side + 1) * (side + 1),
            line_nodes: side + 1,
            layer_lines: side + 1,
            shapes: elements,
            line_shapes: side,
        }
    }
}

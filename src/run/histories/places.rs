//! Where a history is taken: places as weighted sums of nodes, and the surface that they make up.

use std::f64::consts::PI;

use super::points::nearest;
use crate::engine::Watched;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::model::mesh::Mesh;
use crate::physics::tensor::{add, cross, dot, scale, sub};
use crate::scene::Scene;
use crate::scene::history::Places;

/// Coordinates of nodes on one circle about the axle differ by less than this share of its radius.
const SAME_CIRCLE: f64 = 1e-6;
/// Nodes of a circle leave no larger gap than this angle: an eighth of a turn.
const WIDEST: f64 = 1.01 * PI / 4.0;

/// A place, its numbers of nodes being those of the watched nodes.
#[derive(Debug, Clone, PartialEq)]
pub enum Place {
    Node(u32),
    /// Goes with the material of a face: its nodes with weights that add up to one.
    Face([(u32, f64); 4]),
    /// Stands at an angle about the axle [rad] while a circle of nodes turns past it.
    Unturned {
        circle: usize,
        angle: f64,
    },
}

/// Nodes on a circle about the axle, by their angles in the reference shape [rad], ascending from -pi.
pub type Circle = Vec<(f64, u32)>;

/// Places of a history, with the surface in the reference shape.
#[derive(Debug, Clone, Default)]
pub struct Layout {
    pub places: Vec<Place>,
    pub circles: Vec<Circle>,
    /// The mesh's nodes behind the watched ones' numbers.
    pub nodes: Vec<u32>,
    /// By place: the mesh's node (that stands there before the wheel turns; of points the nearest one), position [m], unit normal
    /// outwards (zero inside the body), area [m2].
    pub named: Vec<u32>,
    pub positions: Vec<[f64; 3]>,
    pub normals: Vec<[f64; 3]>,
    pub areas: Vec<f64>,
    /// Outer faces whose four corners are places, by their numbers, counter-clockwise seen from outside.
    pub faces: Vec<[u32; 4]>,
}

impl Layout {
    /// The places of a history of a scene's model.
    ///
    /// # Errors
    /// [`Error::Scene`] for a set that the mesh does not have, points off the surface, and unturned places of nodes that stand on
    /// no circle about the axle.
    pub fn of(scene: &Scene, model: &Model, number: usize) -> Result<Layout> {
        let history = &scene.output.histories[number];
        let mesh = &model.mesh;
        let file = scene.file.display().to_string();
        let key = |key: &str| format!("output.history.{number}.{key}");
        match &history.places {
            Places::Material(set) | Places::Unturned(set) => {
                let nodes = mesh.set(&set.name).map_err(|e| set.unknown(&file, &key("nodes"), &e.known))?;
                if matches!(history.places, Places::Material(_)) {
                    return Ok(Layout::material(mesh, nodes));
                }
                Layout::unturned(mesh, nodes, scene.rim.is_some())
                    .map_err(|problem| set.error(&file, &key("turning"), problem.into(), "write turning = true".into()))
            }
            Places::Points(points) => Layout::points(mesh, points).map_err(|(k, away)| Error::Scene {
                file,
                line: None,
                key: key(&format!("points.{k}")),
                problem: format!("the nearest place of the outer surface is {:.3} mm away", 1e3 * away),
                remedy: "give a point of the surface in the reference shape, before the body is placed and pressed".into(),
            }),
        }
    }

    fn material(mesh: &Mesh, nodes: Vec<u32>) -> Layout {
        let places = (0..nodes.len() as u32).map(Place::Node).collect();
        Layout { places, nodes: nodes.clone(), ..Layout::surface(mesh, nodes) }
    }

    fn unturned(mesh: &Mesh, named: Vec<u32>, rim: bool) -> std::result::Result<Layout, &'static str> {
        if !rim {
            return Err("without a rim nobody knows how far the body has turned");
        }
        let polar = |n: u32| {
            let x = sub(mesh.nodes[n as usize], mesh.axle);
            ([x[0].hypot(x[2]), x[1]], x[0].atan2(x[2]))
        };
        // Outer nodes only: inside a coarse mesh too there are circles, but nobody listens there.
        let mut outer: Vec<u32> = mesh.facets.iter().flatten().copied().collect();
        outer.sort_unstable();
        outer.dedup();
        let mut layout = Layout::default();
        let mut on: Vec<[f64; 2]> = Vec::new();
        for &n in &named {
            let (line, angle) = polar(n);
            let same = |other: &[f64; 2]| {
                (0..2).all(|d| (other[d] - line[d]).abs() <= SAME_CIRCLE * line[0].max(other[0]))
            };
            let circle = match on.iter().position(same) {
                Some(circle) => circle,
                None => {
                    let members = outer.iter().copied().filter(|m| same(&polar(*m).0));
                    let mut circle: Circle = members.map(|m| (polar(m).1, layout.watch(m))).collect();
                    circle.sort_by(|a, b| a.0.total_cmp(&b.0));
                    if !closed(&circle) {
                        return Err("its nodes do not stand on whole circles about the axle");
                    }
                    on.push(line);
                    layout.circles.push(circle);
                    on.len() - 1
                }
            };
            layout.places.push(Place::Unturned { circle, angle });
        }
        Ok(Layout {
            places: layout.places,
            circles: layout.circles,
            nodes: layout.nodes,
            ..Layout::surface(mesh, named)
        })
    }

    /// Number of a node among the watched ones, one that is new if need be.
    fn watch(&mut self, node: u32) -> u32 {
        self.nodes.push(node);
        self.nodes.len() as u32 - 1
    }

    /// Points of the surface; `Err`: a point that is off it, and how far [m].
    fn points(mesh: &Mesh, points: &[[f64; 3]]) -> std::result::Result<Layout, (usize, f64)> {
        let mut layout = Layout::default();
        let size =
            mesh.nodes.iter().map(|x| dot(sub(*x, mesh.axle), sub(*x, mesh.axle)).sqrt()).fold(0.0, f64::max);
        for (k, point) in points.iter().enumerate() {
            let found = nearest(mesh, *point);
            // Coarse meshes cut corners: a sagitta of a tenth of the size is one of seven elements a turn.
            if found.distance > 0.1 * size {
                return Err((k, found.distance));
            }
            let corners = found.nodes.map(|n| layout.watch(n));
            layout.places.push(Place::Face(std::array::from_fn(|k| (corners[k], found.weights[k]))));
            let most = (0..4).max_by(|a, b| found.weights[*a].total_cmp(&found.weights[*b])).unwrap_or(0);
            layout.named.push(found.nodes[most]);
            layout.positions.push(found.position);
            layout.normals.push(found.normal);
            layout.areas.push(0.0);
        }
        Ok(layout)
    }

    /// The surface that some nodes make up.
    fn surface(mesh: &Mesh, named: Vec<u32>) -> Layout {
        let mut number = vec![u32::MAX; mesh.nodes.len()];
        named.iter().enumerate().for_each(|(k, n)| number[*n as usize] = k as u32);
        let is_place = |n: &u32| number[*n as usize] != u32::MAX;
        let whole: Vec<&[u32; 4]> = mesh.facets.iter().filter(|f| f.iter().all(is_place)).collect();
        let mut normals = vec![[0.0; 3]; named.len()];
        let mut areas = vec![0.0; named.len()];
        for (facet, counts) in whole.iter().map(|f| (*f, true)).chain(mesh.facets.iter().map(|f| (f, false)))
        {
            for a in (0..4).filter(|a| is_place(&facet[*a])) {
                let k = number[facet[a] as usize] as usize;
                // Faces that are not wholly of the history give a normal where no other does, and no area.
                if !counts && areas[k] > 0.0 {
                    continue;
                }
                let quarter = quarter(facet.map(|n| mesh.nodes[n as usize]), a);
                normals[k] = add(normals[k], quarter);
                areas[k] += if counts { dot(quarter, quarter).sqrt() } else { 0.0 };
            }
        }
        let unit = |n: &[f64; 3]| match dot(*n, *n).sqrt() {
            0.0 => [0.0; 3],
            size => scale(*n, 1.0 / size),
        };
        Layout {
            positions: named.iter().map(|n| mesh.nodes[*n as usize]).collect(),
            normals: normals.iter().map(unit).collect(),
            areas,
            faces: whole.iter().map(|f| f.map(|n| number[n as usize])).collect(),
            named,
            ..Layout::default()
        }
    }

    /// The watched nodes with their numbers on the surface that can touch the road.
    pub fn watched(&self, mesh: &Mesh) -> Vec<Watched> {
        let surface = |n: &u32| mesh.surface.binary_search(n).ok().map(|k| k as u32);
        self.nodes.iter().map(|node| Watched { node: *node, surface: surface(node) }).collect()
    }

    /// What nodes have, at a place, when the body has turned by `spin` [rad].
    pub fn value(&self, place: &Place, spin: f64, of_node: impl Fn(usize) -> [f64; 3]) -> [f64; 3] {
        let sum = |weights: &[(u32, f64)]| {
            weights.iter().fold([0.0; 3], |sum, (n, weight)| add(sum, scale(of_node(*n as usize), *weight)))
        };
        match place {
            Place::Node(n) => of_node(*n as usize),
            Place::Face(weights) => sum(weights),
            Place::Unturned { circle, angle } => sum(&between(&self.circles[*circle], angle - spin)),
        }
    }
}

/// Whether nodes leave no gap in a circle.
fn closed(circle: &Circle) -> bool {
    let next = circle.iter().skip(1).map(|c| c.0).chain(circle.first().map(|c| c.0 + 2.0 * PI));
    circle.len() >= 3 && circle.iter().zip(next).all(|(a, b)| b - a.0 < WIDEST.max(1.01 * 2.0 * PI / 3.0))
}

/// The two nodes of a circle that the `angle` [rad] lies between, and the weights that put their chord's point there: of equal
/// radii it divides the chord by the sines of the angles to either end.
fn between(circle: &Circle, angle: f64) -> [(u32, f64); 2] {
    let turned = |from: f64| (angle - from).rem_euclid(2.0 * PI);
    let first =
        (0..circle.len()).min_by(|a, b| turned(circle[*a].0).total_cmp(&turned(circle[*b].0))).unwrap_or(0);
    let (a, b) = (circle[first], circle[(first + 1) % circle.len()]);
    let (before, after) = (turned(a.0).sin(), (b.0 - angle).rem_euclid(2.0 * PI).sin());
    let share = before / (before + after);
    [(a.1, 1.0 - share), (b.1, share)]
}

/// Area vector of the quarter of a face that lies nearest to its corner `a` [m2].
fn quarter(p: [[f64; 3]; 4], a: usize) -> [f64; 3] {
    let middle = |i: usize, j: usize| scale(add(p[i % 4], p[j % 4]), 0.5);
    let centre = scale(add(middle(0, 1), middle(2, 3)), 0.5);
    scale(cross(sub(centre, p[a]), sub(middle(a + 3, a), middle(a, a + 1))), 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::MeshSpec;

    fn ring() -> Mesh {
        Mesh::generate(&MeshSpec::Ring {
            outer_radius: 0.04,
            inner_radius: 0.02,
            width: 0.02,
            elements: [12, 1, 2],
        })
    }

    #[test]
    fn unturned_places_keep_their_angle_exactly() {
        let mesh = ring();
        let layout = Layout::unturned(&mesh, mesh.set("outer").unwrap(), true).unwrap();
        assert_eq!((layout.places.len(), layout.circles.len(), layout.nodes.len()), (36, 3, 36));
        for spin in [0.0, 0.1, 1.0, -2.5, 7.0, 400.0] {
            for (place, X) in layout.places.iter().zip(&layout.positions) {
                assert!(
                    (layout.value(place, spin, |_| [1.0; 3])[0] - 1.0).abs() < 1e-12,
                    "weights add up to one"
                );
                // Nodes turned by the spin about +y, which takes z towards x.
                let turned = |n: usize| {
                    let [x, y, z] = sub(mesh.nodes[layout.nodes[n] as usize], mesh.axle);
                    let (sin, cos) = spin.sin_cos();
                    [x * cos + z * sin, y, z * cos - x * sin]
                };
                let at = layout.value(place, spin, turned);
                let wanted = sub(*X, mesh.axle);
                let off = at[0] * wanted[2] - at[2] * wanted[0];
                assert!(
                    off.abs() < 1e-12 * 0.04 && at[0] * wanted[0] + at[2] * wanted[2] > 0.0,
                    "{spin}: {off}"
                );
                assert!((at[1] - wanted[1]).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn the_surface_has_its_area_and_looks_outwards() {
        let mesh = ring();
        let layout = Layout::material(&mesh, mesh.set("outer").unwrap());
        let chord = 2.0 * 0.04 * (PI / 12.0).sin();
        let area: f64 = layout.areas.iter().sum();
        assert!((area - 12.0 * chord * 0.02).abs() < 1e-12, "{area}");
        assert_eq!(layout.faces.len(), 24);
        for (normal, X) in layout.normals.iter().zip(&layout.positions) {
            let out = sub(*X, mesh.axle);
            let cosine = (normal[0] * out[0] + normal[2] * out[2]) / out[0].hypot(out[2]);
            assert!((cosine - 1.0).abs() < 1e-12 && normal[1].abs() < 1e-12, "{normal:?}");
        }
        // Faces seen from outside are counter-clockwise.
        for face in &layout.faces {
            let p = face.map(|k| layout.positions[k as usize]);
            let around = cross(sub(p[1], p[0]), sub(p[2], p[0]));
            assert!(dot(around, layout.normals[face[0] as usize]) > 0.0);
        }
        // Of nodes inside the body nothing is known.
        let inside = Layout::material(
            &Mesh::generate(&MeshSpec::Block { size: [1.0; 3], elements: [2; 3] }),
            vec![13],
        );
        assert_eq!((inside.normals[0], inside.areas[0]), ([0.0; 3], 0.0));
    }

    #[test]
    fn a_point_is_interpolated_on_its_face() {
        let mesh = Mesh::generate(&MeshSpec::Block { size: [4.0, 2.0, 2.0], elements: [2, 1, 1] });
        let layout = Layout::points(&mesh, &[[2.5, 0.0, 1.0], [4.0, 1.5, 0.5]]).unwrap();
        for (place, X) in layout.places.iter().zip([[2.5, 0.0, 1.0], [4.0, 1.5, 0.5]]) {
            let at = layout.value(place, 0.0, |n| mesh.nodes[layout.nodes[n] as usize]);
            assert!((0..3).all(|d| (at[d] - X[d]).abs() < 1e-12), "{at:?}");
        }
        assert_eq!(layout.normals, [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0]]);
        let (k, away) = Layout::points(&mesh, &[[1.0, 0.0, 1.0], [4.0, 1.0, 5.0]]).unwrap_err();
        assert!(k == 1 && (away - 3.0).abs() < 1e-12, "{away}");
    }

    #[test]
    fn what_stands_on_no_circle_is_refused() {
        let block = Mesh::generate(&MeshSpec::Block { size: [2.0, 1.0, 1.0], elements: [4, 2, 2] });
        assert!(Layout::unturned(&block, block.set("z-min").unwrap(), true).is_err());
        let ring = ring();
        assert!(Layout::unturned(&ring, ring.set("outer").unwrap(), false).is_err(), "no rim");
    }
}

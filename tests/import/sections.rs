//! Axisymmetric sections, revolved.

use hexroll::model::mesh::Mesh;
use hexroll::scene::{Grading, MeshFile, MeshSpec, Revolve};

use crate::rig::{numbers, parts, read_with};

/// Nodes (radius, width) of a section of a ring of radii 1 and 2 m and 0.5 m width, row by row from the inside, with every digit.
fn section([through, across]: [usize; 2]) -> Vec<[f64; 2]> {
    let mut nodes = Vec::new();
    for k in 0..=through {
        for j in 0..=across {
            let s = j as f64 / across as f64;
            let share = if s <= 0.5 { 0.5 * (2.0 * s) } else { 1.0 - 0.5 * (2.0 * (1.0 - s)) };
            nodes.push([1.0 + k as f64 / through as f64, 0.5 * (share - 0.5)]);
        }
    }
    nodes
}

/// Quadrilaterals of it by place, counter-clockwise in (width, radius), the widths inside.
fn quads([through, across]: [usize; 2]) -> Vec<[usize; 4]> {
    let at = |k: usize, j: usize| k * (across + 1) + j;
    let quad = |e: usize| {
        let (k, j) = (e / across, e % across);
        [at(k, j), at(k, j + 1), at(k + 1, j + 1), at(k + 1, j)]
    };
    (0..through * across).map(quad).collect()
}

fn deck(counts: [usize; 2], kind: &str, clockwise: bool) -> String {
    let mut text = String::from("*NODE\n");
    for (n, [r, y]) in section(counts).iter().enumerate() {
        text += &format!("{}, {r:e}, {y:e}\n", n + 1);
    }
    text += &format!("*ELEMENT, TYPE={kind}, ELSET=RUBBER\n");
    for (e, [a, b, c, d]) in quads(counts).into_iter().enumerate() {
        let [b, d] = if clockwise { [d, b] } else { [b, d] };
        text += &format!("{}, {}, {}, {}, {}\n", e + 1, a + 1, b + 1, c + 1, d + 1);
    }
    text + &format!("*NSET, NSET=INNER, GENERATE\n1, {}\n", counts[1] + 1)
}

fn msh(counts: [usize; 2]) -> String {
    let (nodes, quads) = (section(counts), quads(counts));
    let mut text = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", nodes.len());
    for (n, [r, y]) in nodes.iter().enumerate() {
        text += &format!("{} {r:e} {y:e} 0\n", n + 1);
    }
    text += &format!("$EndNodes\n$Elements\n{}\n", quads.len());
    for (e, q) in quads.iter().enumerate() {
        text += &format!("{} 3 2 1 1 {} {} {} {}\n", e + 1, q[0] + 1, q[1] + 1, q[2] + 1, q[3] + 1);
    }
    text + "$EndElements\n"
}

fn revolved(how: Revolve) -> impl FnOnce(&mut MeshFile) {
    move |file| file.revolve = Some(how)
}

fn bits(nodes: &[[f64; 3]]) -> Vec<[u64; 3]> {
    nodes.iter().map(|x| x.map(f64::to_bits)).collect()
}

/// Evenly, and finer at the road: nodes, elements, axle and boundary of the ring generator, to the bit.
#[test]
fn a_revolved_section_is_the_ring_of_the_generator() {
    let (sectors, counts) = (14, [3, 4]);
    for (grading, fine_arc) in [(1.0, 0.0), (5.0, 0.7)] {
        let spec = MeshSpec::Ring {
            outer_radius: 2.0,
            inner_radius: 1.0,
            width: 0.5,
            elements: [sectors, counts[0], counts[1]],
        };
        let ring = Mesh::graded(&spec, &Grading { ratio: [grading, 1.0, 1.0], fine_arc });
        let how = Revolve { sectors, grading, fine_arc };
        let files = [
            ("a.inp", deck(counts, "CGAX4H", false)),
            ("a.inp", deck(counts, "CAX4", false)),
            ("a.msh", msh(counts)),
        ];
        for (name, text) in files {
            let mesh = read_with(name, text, revolved(how)).unwrap();
            assert_eq!(bits(&mesh.nodes), bits(&ring.nodes), "{name}");
            assert_eq!(
                (&mesh.hexes, &mesh.facets, &mesh.surface),
                (&ring.hexes, &ring.facets, &ring.surface)
            );
            assert_eq!(mesh.axle, ring.axle);
            assert_eq!(mesh.lattice(), ring.lattice());
        }
        // Drawn the other way round it is the same body.
        let other = read_with("a.inp", deck(counts, "CGAX4", true), revolved(how)).unwrap();
        assert_eq!(bits(&other.nodes), bits(&ring.nodes));
        assert_eq!(other.facets.len(), ring.facets.len());
        assert!(!other.notes.iter().any(|n| n.contains("mended")), "{:?}", other.notes);
    }
}

/// A set is the rings of its nodes, and numbers are those of the section.
#[test]
fn sets_and_numbers_go_round() {
    let how = Revolve { sectors: 5, grading: 1.0, fine_arc: 0.0 };
    let mesh = read_with("a.inp", deck([1, 2], "CGAX4", false), revolved(how)).unwrap();
    assert_eq!(mesh.set("INNER").unwrap(), (0..15).collect::<Vec<u32>>());
    assert_eq!(mesh.set("RUBBER").unwrap().len(), mesh.nodes.len());
    assert_eq!(numbers(&mesh, "INNER")[4..6], ["1", "2"]);
    assert_eq!(mesh.element_name(5), "2");
}

#[test]
fn what_cannot_be_revolved_is_refused() {
    let how = Revolve { sectors: 8, grading: 1.0, fine_arc: 0.0 };
    let refused =
        |name: &str, text: String| parts(read_with(name, text, revolved(how)).map(|m| m.description));
    let (_, problem, _) = refused("a.inp", deck([1, 2], "CGAX4", false).replace("\n1, 1e0,", "\n1, 0e0,"));
    assert!(problem.contains("1 nodes of the section are on the axle or beyond it: 1"), "{problem}");
    let triangle = deck([1, 2], "CGAX4", false) + "*ELEMENT, TYPE=CGAX3H\n9, 1, 2, 4\n";
    let (_, problem, remedy) = refused("a.inp", triangle);
    assert!(problem.contains("1 of type CGAX3H") && remedy.contains("wedges"), "{problem}; {remedy}");
    let cords = deck([1, 2], "CGAX4", false) + "*ELEMENT, TYPE=SFMGAX1\n9, 1, 2\n";
    let (_, problem, remedy) = refused("a.inp", cords);
    assert!(
        problem.contains("1 of type SFMGAX1") && remedy.contains("body.mesh.drop"),
        "{problem}; {remedy}"
    );
    let (_, problem, _) = refused("a.inp", crate::rig::cube(""));
    assert!(problem.contains("1 of type C3D8"), "{problem}");
    // And a section that is not revolved says how it could be.
    let (_, _, remedy) = crate::rig::refused("a.inp", deck([1, 2], "CGAX4", false));
    assert!(remedy.contains("revolve = { sectors"), "{remedy}");
}

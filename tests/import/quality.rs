//! What is wrong with a mesh is mended and said, or refused with the numbers of the file.

use hexroll::scene::{Axis, Gaps, LengthUnit};

use crate::rig::{cube, numbers, read, read_with, refused};

/// Two cubes side by side along x that share a face, numbered 101 and 102; the face's nodes twice if `apart`.
fn two(apart: bool) -> String {
    let mut text = String::from("*NODE\n");
    for i in 0..3 {
        for (n, (y, z)) in [(0, 0), (1, 0), (1, 1), (0, 1)].iter().enumerate() {
            text += &format!("{}, {i}., {y}., {z}.\n", 10 * (i + 1) + n + 1);
        }
    }
    if apart {
        text += "41, 1., 0., 0.\n42, 1., 1., 0.\n43, 1., 1., 1.\n44, 1., 0., 1.\n";
    }
    let near = if apart { "41, 42, 43, 44" } else { "21, 22, 23, 24" };
    text + &format!("*ELEMENT, TYPE=C3D8\n101, 11, 12, 13, 14, 21, 22, 23, 24\n102, {near}, 31, 32, 33, 34\n")
}

#[test]
fn unused_nodes_are_dropped_and_said() {
    let deck = cube("*NODE\n77, 9., 9., 9.\n78, 8., 8., 8.\n*NSET, NSET=A\n1, 77\n*NSET, NSET=LOST\n78\n");
    let mesh = read("a.inp", deck).unwrap();
    assert_eq!(mesh.nodes.len(), 8);
    assert_eq!(numbers(&mesh, "A"), ["1"]);
    let notes = mesh.notes.join("\n");
    assert!(notes.contains("2 nodes that no hexahedron has are left out: 77, 78"), "{notes}");
    assert!(notes.contains("\"LOST\""), "{notes}");
}

#[test]
fn other_orders_of_corners_are_mended_and_said() {
    let good = read("a.inp", cube("")).unwrap();
    let volume = |order: &str| {
        let mesh =
            read("a.inp", cube("").replace("1, 1, 2, 3, 4, 5, 6, 7, 8", &format!("1, {order}"))).unwrap();
        assert!(mesh.notes.iter().any(|n| n.contains("was mended: 1")), "{:?}", mesh.notes);
        assert_eq!(mesh.facets.len(), 6);
        hexroll::model::mesh::quality::worst(&mesh).unwrap().0
    };
    assert_eq!(hexroll::model::mesh::quality::worst(&good).unwrap().0, 1.0);
    assert_eq!(volume("5, 6, 7, 8, 1, 2, 3, 4"), 1.0, "mirrored");
    assert_eq!(volume("1, 2, 4, 3, 5, 6, 8, 7"), 1.0, "as a voxel");
    assert_eq!(volume("5, 6, 8, 7, 1, 2, 4, 3"), 1.0, "a mirrored voxel");
}

#[test]
fn inside_out_elements_are_refused_with_their_numbers() {
    // A corner pushed through the opposite one.
    let (_, problem, remedy) = refused("a.inp", cube("").replace("7, 1., 1., 1.", "7, -1., -1., -1."));
    assert!(problem.contains("1 elements are inside out or flat: 1; the first at its node"), "{problem}");
    assert!(remedy.contains("mend"), "{remedy}");
    let (_, problem, _) =
        refused("a.inp", cube("").replace("1, 2, 3, 4, 5, 6, 7, 8", "1, 2, 3, 3, 5, 6, 7, 7"));
    assert!(problem.contains("have a node twice") && problem.ends_with(": 1"), "{problem}");
}

#[test]
fn nearly_flat_elements_are_named() {
    // A corner just above the plane of its three neighbours, x + y + z = 2: (0.675 - 0.65) / 0.5446 = 0.046.
    let deck = cube("").replace("7, 1., 1., 1.", "7, 0.675, 0.675, 0.675");
    let mesh = read("a.inp", deck).unwrap();
    assert!(
        mesh.notes.iter().any(|n| n.contains("1 elements are nearly flat") && n.ends_with(": 1")),
        "{:?}",
        mesh.notes
    );
}

#[test]
fn numbers_that_are_there_twice_are_refused() {
    let (_, problem, _) = refused("a.inp", cube("*NODE\n3, 5., 5., 5.\n"));
    assert!(problem.contains("node 3 is there twice"), "{problem}");
    let (_, problem, _) = refused("a.inp", cube("*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"));
    assert!(problem.contains("element 1 is there twice"), "{problem}");
    let (_, problem, _) = refused("a.inp", cube("*ELEMENT, TYPE=C3D8\n2, 1, 2, 3, 4, 5, 6, 7, 8\n"));
    assert!(problem.contains("elements 1, 2 lie on the same side"), "{problem}");
}

#[test]
fn parts_that_touch_without_common_nodes_are_refused_or_merged() {
    let whole = read("a.inp", two(false)).unwrap();
    assert_eq!((whole.facets.len(), whole.surface.len()), (10, 12));
    let (_, problem, remedy) = refused("a.inp", two(true));
    assert!(
        problem.contains("4 pairs of nodes at the same place") && problem.contains("21, 41"),
        "{problem}"
    );
    assert!(remedy.contains("merge") && remedy.contains("gaps"), "{remedy}");
    let merged = read_with("a.inp", two(true), |file| file.merge = Some(1e-6)).unwrap();
    assert_eq!(merged.nodes, whole.nodes);
    assert_eq!(merged.hexes, whole.hexes);
    let kept = read_with("a.inp", two(true), |file| file.gaps = Gaps::Keep).unwrap();
    let notes = kept.notes.join("\n");
    assert!(notes.contains("4 pairs") && notes.contains("2 parts"), "{notes}");
    assert_eq!((kept.nodes.len(), kept.facets.len()), (16, 12));
}

/// One large face against four small ones: the node in its middle and those of its edges hang.
#[test]
fn hanging_nodes_are_refused_with_their_numbers() {
    let mut deck = cube("").replace("ELSET=ALL_OF_IT", "ELSET=LARGE");
    deck += "*NODE\n";
    let number = |i: i32, j: i32, k: i32| match (i, j, k) {
        (1, 0, 0) => 2,
        (1, 2, 0) => 3,
        (1, 0, 2) => 6,
        (1, 2, 2) => 7,
        _ => 100 * i + 10 * j + k,
    };
    for i in 1..3 {
        for j in 0..3 {
            for k in 0..3 {
                if number(i, j, k) >= 100 {
                    deck += &format!(
                        "{}, {i}., {}, {}\n",
                        number(i, j, k),
                        0.5 * f64::from(j),
                        0.5 * f64::from(k)
                    );
                }
            }
        }
    }
    deck += "*ELEMENT, TYPE=C3D8\n";
    for j in 0..2 {
        for k in 0..2 {
            let corner =
                [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
            let nodes: Vec<String> =
                corner.iter().map(|[a, b, c]| number(1 + a, j + b, k + c).to_string()).collect();
            deck += &format!("{}, {}\n", 20 + 2 * j + k, nodes.join(", "));
        }
    }
    let (_, problem, remedy) = refused("a.inp", deck);
    assert!(
        problem.contains("5 nodes hang on faces") && problem.contains("101, 110, 111, 112, 121"),
        "{problem}"
    );
    assert!(problem.contains("2, 3, 7, 6"), "{problem}");
    assert!(remedy.contains("common nodes"), "{remedy}");
}

/// 39 mm are 0.039 m to the last digit, as in a scene; axes turn without a mirror.
#[test]
fn units_and_axes() {
    let unit = |name: &str, metres: f64| LengthUnit { name: name.into(), metres };
    let deck = cube("").replace("1.", "39.");
    let mm = read_with("a.inp", &deck, |file| file.unit = unit("mm", 1e-3)).unwrap();
    assert_eq!(mm.nodes[6], [0.039; 3]);
    let inch = read_with("a.inp", &deck, |file| file.unit = unit("in", 0.0254)).unwrap();
    assert_eq!(inch.nodes[6], [39.0 * 0.0254; 3]);
    let flat = cube("").replace("7, 1., 1., 1.", "7, 1., 1.5, 2.").replace("8, 0., 1., 1.", "8, 0., 1.5, 2.");
    for (axis, wanted) in [(Axis::Y, [1.0, 1.5, 2.0]), (Axis::X, [2.0, 1.0, 1.5]), (Axis::Z, [1.5, 2.0, 1.0])]
    {
        let mesh = read_with("a.inp", &flat, |file| file.axis = axis).unwrap();
        assert_eq!(mesh.nodes[6], wanted);
        assert!(!mesh.notes.iter().any(|n| n.contains("mended")), "a turn mirrors nothing");
    }
}

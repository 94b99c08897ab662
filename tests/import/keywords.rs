//! Abaqus' keywords as users write them.

use hexroll::model::mesh::Mesh;

use crate::rig::{cube, numbers, parts, read, read_with, refused};

#[test]
fn case_blanks_comments_and_line_ends_do_not_matter() {
    let plain = read("a.inp", cube("*NSET, NSET=BOTTOM\n1, 2, 3, 4\n")).unwrap();
    let messy = "*heading\r\n any text\r\n** comment\r\n*Node\r\n1 , 0. ,0.,0.\r\n 2, 1.D0, 0., 0.\r\n**\r\n3, 1E+0, 1., 0.\r\n\
                 4, 0., 1.,\r\n5, , , 1.\r\n6, 1., 0., 1.\r\n7, 1., 1., 1.\r\n8, 0., 1., 1.\r\n\r\n\
                 *ELEMENT,\r\n TYPE = c3d8 ,\r\n elset=ALL_OF_IT\r\n1, 1, 2, 3, 4,\r\n  5, 6, 7, 8\r\n\
                 *nset , nset = bottom\r\n1, 2\r\n3,4,\r\n*END STEP";
    let messy = read("a.inp", format!("\u{feff}{messy}")).unwrap();
    assert_eq!(messy.nodes, plain.nodes);
    assert_eq!(messy.hexes, plain.hexes);
    assert_eq!(messy.set("bottom").unwrap(), plain.set("BOTTOM").unwrap());
}

/// A node line with a number only is the origin; the last line may lack its end.
#[test]
fn what_is_left_out_is_zero() {
    let deck = cube("").replace("1, 0., 0., 0.\n", "1,\n") + "*NSET, NSET=A\n1";
    let mesh = read("a.inp", deck).unwrap();
    assert_eq!(mesh.nodes[0], [0.0; 3]);
    assert_eq!(numbers(&mesh, "A"), ["1"]);
}

#[test]
fn sets_add_up_and_hold_one_another() {
    let behind = "*NSET, NSET=A\n1, 2\n*NSET, NSET=B, GENERATE\n3, 7, 2\n8, 8\n*NSET, NSET=A, GEN\n5, 6\n\
                  *NSET, NSET=C\nA, 4, b\n*ELSET, ELSET=E\nALL_OF_IT\n*NSET, NSET=D, ELSET=E\n*NSET, NSET=EMPTY\n";
    let mesh = read("a.inp", cube(behind)).unwrap();
    assert_eq!(numbers(&mesh, "A"), ["1", "2", "5", "6"]);
    assert_eq!(numbers(&mesh, "B"), ["3", "5", "7", "8"]);
    assert_eq!(numbers(&mesh, "C"), ["1", "2", "3", "4", "5", "6", "7", "8"]);
    assert_eq!(mesh.set("D").unwrap().len(), 8);
    assert_eq!(mesh.set("E").unwrap().len(), 8);
    assert!(mesh.set("EMPTY").unwrap().is_empty());
}

#[test]
fn nodes_and_elements_name_their_sets() {
    let deck = cube("").replacen("*NODE\n", "*NODE, NSET=FIRST\n", 1).replacen(
        "5, 0., 0., 1.",
        "*NODE, NSET=REST\n5, 0., 0., 1.",
        1,
    );
    let mesh = read("a.inp", deck).unwrap();
    assert_eq!(numbers(&mesh, "FIRST"), ["1", "2", "3", "4"]);
    assert_eq!(numbers(&mesh, "REST"), ["5", "6", "7", "8"]);
    assert_eq!(mesh.set("ALL_OF_IT").unwrap().len(), 8);
}

/// Every face by its number, of a set or an element; free faces without a number; nodes.
#[test]
fn surfaces_are_faces_by_number() {
    let faces = [
        ["1", "2", "3", "4"],
        ["5", "6", "7", "8"],
        ["1", "2", "5", "6"],
        ["2", "3", "6", "7"],
        ["3", "4", "7", "8"],
        ["1", "4", "5", "8"],
    ];
    for (k, nodes) in faces.iter().enumerate() {
        for of in ["ALL_OF_IT", "1"] {
            let mesh =
                read("a.inp", cube(&format!("*SURFACE, TYPE=ELEMENT, NAME=S\n{of}, S{}\n", k + 1))).unwrap();
            assert_eq!(numbers(&mesh, "S"), *nodes, "S{}", k + 1);
        }
    }
    let mesh =
        read("a.inp", cube("*SURFACE, NAME=S\nALL_OF_IT,\n*SURFACE, TYPE=NODE, NAME=N\n3,\n7\n")).unwrap();
    assert_eq!(mesh.set("S").unwrap().len(), 8);
    assert_eq!(numbers(&mesh, "N"), ["3", "7"]);
}

/// Two instances of one part: one moved, one turned by 90 degrees about z through (1, 0) and moved before.
#[test]
fn instances_stand_where_they_are_put() {
    let part = cube("*NSET, NSET=NEAR\n1, 4\n*SURFACE, NAME=TOP\nALL_OF_IT, S2\n");
    let deck = format!(
        "*PART, NAME=CUBE\n{part}*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=ONE, PART=cube\n*END INSTANCE\n\
         *INSTANCE, NAME=TWO, PART=CUBE\n0., 0., 5.\n1., 0., 0., 1., 0., 1., 90.\n*END INSTANCE\n\
         *NSET, NSET=BOTH, INSTANCE=ONE\n1\n*NSET, NSET=BOTH, INSTANCE=TWO\n2, NEAR\n*NSET, NSET=DOT\nTWO.3, ONE.NEAR\n*END ASSEMBLY\n"
    );
    let mesh = read_with("a.inp", &deck, |file| file.gaps = hexroll::scene::Gaps::Keep).unwrap();
    assert_eq!((mesh.nodes.len(), mesh.hexes.len()), (16, 2));
    let near = |x: [f64; 3], y: [f64; 3]| (0..3).all(|d| (x[d] - y[d]).abs() < 1e-15);
    // Node 1 at the origin: moved to z = 5, arm (-1, 0) about (1, 0) turned to (0, -1).
    assert!(near(mesh.nodes[8], [1.0, -1.0, 5.0]), "{:?}", mesh.nodes[8]);
    // Node 3 at (1, 1, 0): arm (0, 1) turned to (-1, 0).
    assert!(near(mesh.nodes[10], [0.0, 0.0, 5.0]), "{:?}", mesh.nodes[10]);
    assert_eq!(numbers(&mesh, "BOTH"), ["ONE.1", "TWO.1", "TWO.2", "TWO.4"]);
    assert_eq!(numbers(&mesh, "DOT"), ["ONE.1", "ONE.4", "TWO.3"]);
    assert_eq!(numbers(&mesh, "TWO.NEAR"), ["TWO.1", "TWO.4"]);
    assert_eq!(mesh.set("ONE.TOP").unwrap().len(), 4);
    assert_eq!(mesh.element_name(1), "TWO.1");
    // Nothing connects the two, which is an error unless it is meant.
    let (_, problem, remedy) = refused("a.inp", &deck);
    assert!(problem.contains("2 parts") && remedy.contains("gaps = \"keep\""), "{problem}; {remedy}");
}

/// An only instance shares its names with the whole.
#[test]
fn sets_of_an_only_instance_have_plain_names() {
    let deck = format!(
        "*PART, NAME=P\n{}*END PART\n*INSTANCE, NAME=P-1, PART=P\n*END INSTANCE\n*NSET, NSET=MINE, INSTANCE=P-1\n7\n",
        cube("*NSET, NSET=RIM\n1, 2\n")
    );
    let mesh = read("a.inp", deck).unwrap();
    assert_eq!(numbers(&mesh, "RIM"), ["P-1.1", "P-1.2"]);
    assert_eq!(numbers(&mesh, "MINE"), ["P-1.7"]);
}

#[test]
fn included_files_are_read_where_they_are_named() {
    let folder = tempfile::TempDir::new().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    let deck = cube("*INCLUDE, INPUT=sub/sets.inp\n5, 6\n");
    let nodes_end = deck.find("*ELEMENT").unwrap();
    write("nodes.dat", deck[..nodes_end].trim_start_matches("*NODE\n"));
    write("sub/sets.inp", "*NSET, NSET=A\n1, 2\n*INCLUDE, INPUT=../more.inp\n");
    write("more.inp", "3, 4\n");
    write("a.inp", &format!("*NODE, INPUT=nodes.dat\n{}", &deck[nodes_end..]));
    let mesh = Mesh::imported(&crate::rig::metres(&folder.path().join("a.inp")), None).unwrap();
    // What follows the include belongs to the last card, wherever that was.
    assert_eq!(numbers(&mesh, "A"), ["1", "2", "3", "4", "5", "6"]);
    write("more.inp", "*INCLUDE, INPUT=a.inp\n");
    let (line, problem, remedy) =
        parts(Mesh::imported(&crate::rig::metres(&folder.path().join("a.inp")), None));
    assert_eq!(line, Some(1));
    assert!(problem.contains("includes itself") && remedy.contains("circle"), "{problem}; {remedy}");
}

/// What is physics is listed with what a scene has in its place; what is not known is listed too; headings are not.
#[test]
fn what_is_not_taken_over_is_listed() {
    let behind = "*HEADING\nx\n*OUTPUT, FIELD\n*BOUNDARY\n1, 1, 3\n*STEP\n*STATIC\n*DSLOAD\nA, P, 1.\n*END STEP\n*TIE, NAME=T\nA, B\n\
                  *BOUNDARY\n2, 1\n*FLUFF, X=1\n1\n";
    let mesh = read("a.inp", cube(behind)).unwrap();
    let notes = mesh.notes.join("\n");
    for (keyword, line, instead) in [
        ("BOUNDARY (2 times)", 15, "[rim]"),
        ("STEP", 17, "[[stage]]"),
        ("DSLOAD", 19, "pressures"),
        ("TIE", 22, "common nodes"),
    ] {
        let wanted = format!("a.inp:{line}: *{keyword} is not taken over");
        assert!(notes.contains(&wanted) && notes.contains(instead), "{wanted}\n{notes}");
    }
    assert!(notes.contains("a.inp:26: *FLUFF is not known"), "{notes}");
    assert!(!notes.contains("HEADING") && !notes.contains("OUTPUT") && !notes.contains("END"), "{notes}");
}

#[test]
fn keywords_that_make_meshes_are_refused() {
    for keyword in ["NGEN", "ELGEN", "SYSTEM", "SYMMETRIC MODEL GENERATION, REVOLVE"] {
        let (line, problem, remedy) = refused("a.inp", cube(&format!("*{keyword}\n1, 2, 3\n")));
        assert_eq!(line, Some(12), "{keyword}");
        assert!(problem.contains("makes or changes a mesh") && !remedy.is_empty(), "{problem}");
    }
}

/// Each type is named with its count and what helps; the scene may leave some out.
#[test]
fn other_elements_are_refused_by_name_unless_dropped() {
    let behind = "*ELEMENT, TYPE=SFM3D4R, ELSET=CORDS\n10, 1, 2, 3, 4\n11, 5, 6, 7, 8\n*ELEMENT, TYPE=MASS, ELSET=M\n20, 1\n";
    let (line, problem, remedy) = refused("a.inp", cube(behind));
    assert_eq!(line, Some(12));
    assert!(problem.contains("2 of type SFM3D4R") && problem.contains("1 of type MASS"), "{problem}");
    assert!(remedy.contains("body.mesh.drop"), "{remedy}");
    let mesh =
        read_with("a.inp", cube(behind), |file| file.drop = vec!["sfm3d4r".into(), "MASS".into()]).unwrap();
    assert_eq!(mesh.hexes.len(), 1);
    // Sets of what is left out still say where it was.
    assert_eq!(numbers(&mesh, "CORDS"), ["1", "2", "3", "4", "5", "6", "7", "8"]);
    assert_eq!(numbers(&mesh, "M"), ["1"]);
    assert!(
        mesh.notes.iter().any(|n| n.contains("2 elements of type SFM3D4R are left out")),
        "{:?}",
        mesh.notes
    );
    for (kind, nodes) in [("C3D4", 4), ("C3D10", 10), ("C3D20R", 20), ("C3D6", 6), ("CGAX4H", 4)] {
        let list: Vec<String> = (0..nodes).map(|n| (n % 8 + 1).to_string()).collect();
        let (_, problem, _) =
            refused("a.inp", cube(&format!("*ELEMENT, TYPE={kind}\n9, {}\n", list.join(", "))));
        assert!(problem.contains(&format!("1 of type {kind}")), "{problem}");
    }
}

/// Bricks of every kind are hexahedra, and which of the elements here is nearest is said.
#[test]
fn every_brick_is_a_hexahedron() {
    for (kind, nearest) in [
        ("C3D8", "q1p0"),
        ("C3D8R", "uniform-gradient"),
        ("C3D8H", "q1p0"),
        ("C3D8RH", "uniform-gradient"),
        ("C3D8I", "q1p0"),
    ] {
        let mesh = read("a.inp", cube("").replace("TYPE=C3D8", &format!("TYPE={kind}"))).unwrap();
        let note = format!("1 elements of type {kind}: body.element = {nearest:?}");
        assert!(mesh.notes.iter().any(|n| n.starts_with(&note)), "{:?}", mesh.notes);
    }
}

//! Maps from files, and what is wrong with them.

use std::path::Path;

use hexroll::Error;
use hexroll::physics::road::{Border, Road};
use hexroll::scene::Scene;
use hexroll::scene::heights::{Map, crg, grid, picture};
use image::{ImageBuffer, ImageFormat, Luma, LumaA};

use crate::{data, near};

fn read(name: &str) -> Map {
    crg::read(&std::fs::read(data(name)).unwrap()).unwrap_or_else(|fault| panic!("{name}: {fault:?}"))
}

/// Heights of the hand-made file, by pyopencrg 0.2.2, which has also written it in the other formats.
#[test]
fn opencrg_heights_are_those_of_another_reader() {
    let text = std::fs::read_to_string(data("pyopencrg.csv")).unwrap();
    let rows: Vec<[f64; 3]> = (text.lines().filter(|line| !line.starts_with('#')))
        .map(|line| {
            let numbers: Vec<f64> = line.split(',').map(|f| f.parse().unwrap()).collect();
            numbers.try_into().unwrap()
        })
        .collect();
    assert_eq!(rows.len(), 60);
    for (name, digits) in [
        // What its interpolation leaves at a sample.
        ("hand_made.crg", 2e-12),
        ("ldfi.crg", 2e-12),
        ("kdbi.crg", 2e-12),
        // Single precision.
        ("krbi.crg", 6e-8),
    ] {
        let map = read(name);
        assert_eq!((map.size, map.border), ([6, 10], Some(Border::Periodic)), "{name}");
        near("increment along", map.spacing[0], 0.02, 1e-15);
        near("increment across", map.spacing[1], 0.01, 1e-15);
        near("right edge", map.origin[1], -0.05, 1e-15);
        for [u, v, z] in &rows {
            let (i, j) = (((u - 100.0) / 0.02).round() as usize, ((v + 0.05) / 0.01).round() as usize);
            let found = map.heights[6 * j + i];
            // On the last row and section that program is a rounding beyond the edge now and then, where the road comes again.
            let (last_row, last_section) = (i == 5, j == 9);
            let again = [
                last_row.then_some(6 * j),
                last_section.then_some(i),
                (last_row && last_section).then_some(0),
            ];
            if again.into_iter().flatten().any(|k| (z - map.heights[k]).abs() < digits) {
                continue;
            }
            match z.is_nan() {
                true => assert!(found.is_nan(), "{name}: {u} {v}"),
                false => near(name, found, *z, digits),
            }
        }
    }
}

/// The hand-made file with one text for another, its problem and a part of the remedy.
#[track_caller]
fn bad_crg(from: &str, to: &str, problem: &str) {
    let text = std::fs::read_to_string(data("hand_made.crg")).unwrap();
    assert!(text.contains(from), "{from:?}");
    let fault = crg::read(text.replacen(from, to, 1).as_bytes()).expect_err(to);
    assert!(fault.problem.contains(problem), "{to:?}: {fault:?}");
}

#[test]
fn opencrg_that_is_not_read_says_why() {
    bad_crg("#:LRFI", "#:LRBI", "no format \"LRBI\"");
    bad_crg("LONG_SECTION_V_INCREMENT", "LONG_SECTION_V_RIGHT", "a second time");
    bad_crg("REFERENCE_LINE_INCREMENT", "REFERENCE_LINE_INCREMEMT", "no increment along");
    bad_crg("= -0.05", "= -0,05", "is no value");
    bad_crg(
        "REFERENCE_LINE_INCREMENT",
        "REFERENCE_LINE_END_PHI = 0.3\nREFERENCE_LINE_START_PHI = 0.2\nREFERENCE_LINE_INCREMENT",
        "curved reference line",
    );
    bad_crg(
        "REFERENCE_LINE_INCREMENT",
        "REFERENCE_LINE_START_S = 0.01\nREFERENCE_LINE_INCREMENT",
        "slope, banking",
    );
    bad_crg(
        "REFERENCE_LINE_INCREMENT",
        "REFERENCE_LINE_END_U = 100.2\nREFERENCE_LINE_INCREMENT",
        "do not reach",
    );
    bad_crg("BORDER_MODE_U = 3", "BORDER_MODE_U = 4", "border modes 4 along");
    bad_crg("$KD_Definition", "$ROAD_CRG_MODS\nSCALE_Z_GRID = 2\n$\n$KD_Definition", "not applied");
    bad_crg("$KD_Definition", "$ROAD_CRG_FILE\nother.crg\n$\n$KD_Definition", "another file");
    bad_crg("D:long section 3,m", "D:long section 3,mm", "the unit of");
    bad_crg("D:long section 3,m", "D:reference line phi,rad", "curved reference line");
    bad_crg("D:long section 3,m", "D:reference line slope,m/m", "slopes or banks");
    bad_crg("D:long section 3,m", "D:latitude,deg", "is no column");
    bad_crg("D:long section 3,m\n", "", "more than");
    bad_crg(" *missing*", " missing**", "is no number");
    bad_crg(&"$".repeat(72), "$$", "no line $$$$");
    let binary = std::fs::read(data("kdbi.crg")).unwrap();
    let fault = crg::read(&binary[..binary.len() - 88]).expect_err("cut");
    assert!(fault.problem.contains("bytes of data"), "{fault:?}");
}

/// A grid of text seen from above: its first line is the largest v.
#[test]
fn grids_of_text_are_seen_from_above() {
    let map = grid::csv("1, 2; 3\n4,,6\n", 0.01, 1e-3).unwrap();
    assert_eq!((map.size, map.spacing), ([3, 2], [0.01; 2]));
    assert_eq!(map.heights[..1], [4e-3]);
    assert!(map.heights[1].is_nan());
    assert_eq!(map.heights[2..], [6e-3, 1e-3, 2e-3, 3e-3]);
    let text = "ncols 2\nnrows 3\nxllcorner 7\nyllcorner 8\ncellsize 0.5\nNODATA_value -1\n1 2\n3 -1\n5 6\n";
    let map = grid::esri(text, 2.0).unwrap();
    assert_eq!((map.size, map.spacing), ([2, 3], [1.0; 2]));
    assert_eq!([map.heights[0], map.heights[1], map.heights[4], map.heights[5]], [10.0, 12.0, 2.0, 4.0]);
    assert!(map.heights[3].is_nan());
    for (text, problem) in [
        (text.replace("nrows 3", "nrows 4"), "6 heights where"),
        (text.replace("cellsize 0.5", ""), "no cellsize"),
        (text.replace("cellsize", "cellsise"), "no line of a header"),
        (text.replace("5 6", "5 six"), "is no number"),
    ] {
        let fault = grid::esri(&text, 1.0).expect_err(problem);
        assert!(fault.problem.contains(problem), "{fault:?}");
    }
    for (text, problem) in
        [("1,2\n3\n", "has 1 numbers"), ("1,2\n", "are no field"), ("nan,nan\nnan,nan", "every sample")]
    {
        let fault = grid::csv(text, 1.0, 1.0).expect_err(problem);
        assert!(fault.problem.contains(problem), "{fault:?}");
    }
}

fn png(picture: impl Into<image::DynamicImage>) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.into().write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

#[test]
fn a_picture_has_65536_heights() {
    let grey = ImageBuffer::from_fn(3, 2, |x, y| Luma([(1000 * x + 30_000 * (1 - y)) as u16]));
    let map = picture::read(&png(grey), 1e-4, 65.535e-3).unwrap();
    assert_eq!((map.size, map.spacing), ([3, 2], [1e-4; 2]));
    for (height, micrometres) in map.heights.iter().zip([0.0, 1000.0, 2000.0, 30_000.0, 31_000.0, 32_000.0]) {
        near("height", *height, 1e-6 * micrometres, 1e-15);
    }
    let holes = ImageBuffer::from_fn(2, 2, |x, y| LumaA([7u16, if x == 1 && y == 0 { 0 } else { 9 }]));
    let map = picture::read(&png(holes), 1.0, 1.0).unwrap();
    assert_eq!(map.heights.iter().map(|h| h.is_nan()).collect::<Vec<_>>(), [false, false, false, true]);
    let coarse = ImageBuffer::from_fn(2, 2, |_, _| Luma([7u8]));
    let fault = picture::read(&png(coarse), 1.0, 1.0).unwrap_err();
    assert!(fault.problem.contains("65,536 levels"), "{fault:?}");
    assert!(picture::read(b"no picture", 1.0, 1.0).is_err());
}

/// A wheel's scene with a road, in a folder.
fn scene(folder: &Path, road: &str) -> Result<Scene, Error> {
    let text =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lat100_static.toml"));
    let text = text.unwrap().replace("shape = \"plane\"", road);
    Scene::parse(&text, &folder.join("scene.toml").to_string_lossy(), &[])
}

/// The same scene with other heights in its file is another scene; its copy in another folder finds the file.
#[test]
fn a_scene_is_told_by_the_content_of_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let road = "shape = \"height-field\"\nfile = \"map.csv\"\npixel = \"50 mm\"\nborder = \"keep\"";
    let write = |text: &str| std::fs::write(folder.path().join("map.csv"), text).unwrap();
    write("0 0 0\n0 0 0");
    let first = scene(folder.path(), road).unwrap();
    write("0 0 0\n0 0 1");
    let second = scene(folder.path(), road).unwrap();
    assert_ne!(first.hash, second.hash);
    let text =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lat100_static.toml"));
    let text = text.unwrap().replace("shape = \"plane\"", road);
    let file = folder.path().join("scene.toml");
    let copy = Scene::effective_text(&text, &file.to_string_lossy(), &[]).unwrap();
    let copied = Scene::parse(&copy, "elsewhere/scene.toml", &[]).unwrap();
    assert_eq!((copied.hash, copied.road), (second.hash, second.road));
}

/// What is wrong with the keys of a shape, by key and problem.
#[test]
fn bad_shapes_are_answered_with_key_and_remedy() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("map.csv"), "0 0 0\n0 x 0").unwrap();
    std::fs::write(folder.path().join("back.csv"), "u,h\n0,0\n2,1\n1,0").unwrap();
    std::fs::write(folder.path().join("open.csv"), "0,0\n2,1\n").unwrap();
    let profile = |form: &str| format!("shape = \"profile\"\nform = {form}");
    let rough = |more: &str| {
        format!(
            "shape = \"height-field\"\ngenerate = \"self-affine\"\nlength = \"64 mm\"\nhurst = 0.8\nrms = \"1 mm\"\n{more}"
        )
    };
    for (road, key, problem) in [
        ("shape = \"profile\"".into(), "road.form", "missing"),
        (
            profile("\"cosine\"\nwavelength = \"0 mm\"\namplitude = \"1 mm\""),
            "road.wavelength",
            "not positive",
        ),
        (profile("\"cosine\"\nwavelength = \"9 mm\""), "road.amplitude", "missing"),
        (profile("\"step\"\nheight = \"0 mm\""), "road.height", "without height"),
        (
            profile("\"cleat\"\nheight = \"5 mm\"\nlength = \"9 mm\"\nradius = \"6 mm\""),
            "road.radius",
            "do not fit",
        ),
        (
            profile("\"cleat\"\nheight = \"5 mm\"\nlength = \"9 mm\"\nspacing = \"9 mm\""),
            "road.spacing",
            "leave no gap",
        ),
        (profile("\"points\"\nfile = \"no.csv\""), "road.file", "no.csv"),
        (profile("\"points\"\nfile = \"back.csv\""), "road.file", "line 4: 1 m is before"),
        (profile("\"points\"\nfile = \"open.csv\"\nborder = \"periodic\""), "road.border", "differ"),
        ("shape = \"height-field\"".into(), "road.file", "missing"),
        ("shape = \"height-field\"\nfile = \"map.xyz\"".into(), "road.file", ".xyz"),
        (
            "shape = \"height-field\"\nfile = \"map.csv\"\npixel = \"1 mm\"".into(),
            "road.file",
            "line 2: \"x\" is no number",
        ),
        ("shape = \"height-field\"\nfile = \"map.csv\"".into(), "road.pixel", "missing"),
        (rough("seed = 1\nspacing = \"1 mm\"\nshortest = \"1.5 mm\""), "road.generate", "waves of"),
        (
            rough("seed = 1\nspacing = \"1 mm\"\nlongest = \"3 mm\"\nshortest = \"4 mm\""),
            "road.generate",
            "no wave",
        ),
        (rough("spacing = \"1 mm\""), "road.seed", "missing"),
        (rough("seed = 1\nspacing = \"1 um\""), "road.spacing", "samples, above"),
        (rough("seed = 1\nspacing = \"1 mm\"").replace("0.8", "1.8"), "road.hurst", "Hurst exponent"),
    ] {
        let shown = scene(folder.path(), &road).expect_err(&road).to_string();
        let (_, rest) = shown.split_once(": ").unwrap();
        assert!(rest.starts_with(&format!("{key}: ")), "{road}: {shown}");
        assert!(shown.contains(problem), "{road}: {problem:?} is not in {shown:?}");
    }
    let moving =
        scene(folder.path(), "shape = \"profile\"\nform = \"step\"\nheight = \"1 mm\"\nvelocity = 1")
            .unwrap_err();
    assert!(moving.to_string().contains("let the rim move"), "{moving}");
}

/// OpenCRG's first long section is the rightmost one.
#[test]
fn an_opencrg_road_lies_round_its_reference_line() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(data("ldfi.crg"), folder.path().join("road.crg")).unwrap();
    let road = "shape = \"height-field\"\nfile = \"road.crg\"\npoint = [\"1 m\", \"2 m\", \"3 m\"]\nangle = \"90 deg\"";
    let Some(Road::HeightField(field)) = scene(folder.path(), road).unwrap().road else { panic!("no field") };
    // u along y, v along -x: the first sample, 50 mm to the right of the line, is at +x.
    for (found, expected) in field.base.point.iter().zip([1.05, 2.0, 3.0]) {
        near("point", *found, expected, 1e-15);
    }
    assert_eq!(field.samples.border(), Border::Periodic);
}

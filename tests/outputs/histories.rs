//! `history_<name>.npz` as an archiver reads it that shares nothing with ours, its headers taken apart by hand; and the
//! universal file's records.

use std::io::{Cursor, Read};

use hexroll::output::history::{read, write_npz, write_uff};
use hexroll::record::{History, Values};
use hexroll::scene::history::Format;

fn history() -> History {
    let times: Vec<f64> = (0..5).map(|k| f64::from(k + 2) * 5e-5).collect();
    let velocity = (0..5 * 4 * 3).map(|k| k as f32 * 0.5).collect();
    History {
        name: "tread".into(),
        rate: 20e3,
        turning: false,
        nodes: vec![7, 8, 12, 11],
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, -0.125]],
        normals: vec![[0.0, 0.0, 1.0]; 4],
        areas: vec![0.25; 4],
        faces: vec![[0, 1, 2, 3]],
        times,
        values: vec![
            Values { name: "velocity", unit: "m/s", components: 3, values: velocity },
            Values {
                name: "pressure",
                unit: "Pa",
                components: 1,
                values: (0..20).map(|k| k as f32).collect(),
            },
        ],
        road_force: Some((0..15).map(|k| k as f32 - 7.0).collect()),
        formats: vec![Format::Npz],
    }
}

/// Type, shape and bytes of an array in the archive.
fn array(archive: &[u8], name: &str) -> (String, String, Vec<u8>) {
    let mut archive = zip::ZipArchive::new(Cursor::new(archive)).unwrap();
    let mut file = Vec::new();
    // The archiver checks the sum.
    archive.by_name(&format!("{name}.npy")).unwrap().read_to_end(&mut file).unwrap();
    assert_eq!(&file[..8], b"\x93NUMPY\x01\x00");
    let length = usize::from(u16::from_le_bytes([file[8], file[9]]));
    assert_eq!((10 + length) % 64, 0, "data begin at a multiple of 64");
    let header = String::from_utf8(file[10..10 + length].to_vec()).unwrap();
    assert!(header.ends_with('\n') && header.contains("'fortran_order': False"), "{header:?}");
    let after = |key: &str, ends: char| {
        let rest = header.split_once(key).unwrap().1;
        rest.split_once(ends).unwrap().0.trim_start_matches([':', ' ', '\'', '(']).to_string()
    };
    (after("'descr'", ','), after("'shape'", ')'), file[10 + length..].to_vec())
}

#[test]
fn an_archiver_finds_every_array_with_its_type_and_shape() {
    let mut bytes = Vec::new();
    write_npz(&mut bytes, &history()).unwrap();
    let mut names: Vec<String> = zip::ZipArchive::new(Cursor::new(&bytes))
        .unwrap()
        .file_names()
        .map(|n| n.unwrap().into_owned())
        .collect();
    names.sort();
    let expected = [
        "area",
        "face",
        "filter",
        "node",
        "normal",
        "pressure",
        "rate",
        "reference_position",
        "road_force",
        "time",
        "turning",
        "velocity",
    ];
    assert_eq!(names, expected.map(|name| format!("{name}.npy")));
    for (name, descr, shape) in [
        ("time", "<f8", "5,"),
        ("rate", "<f8", ""),
        ("turning", "|b1", ""),
        ("node", "<u4", "4,"),
        ("reference_position", "<f8", "4, 3"),
        ("face", "<u4", "1, 4"),
        ("velocity", "<f4", "5, 4, 3"),
        ("pressure", "<f4", "5, 4"),
        ("road_force", "<f4", "5, 3"),
    ] {
        let (found, dimensions, _) = array(&bytes, name);
        assert_eq!((found.trim_end_matches('\''), dimensions.as_str()), (descr, shape), "{name}");
    }
    let (_, _, velocity) = array(&bytes, "velocity");
    let velocity: Vec<f32> = velocity.as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
    // Time 2, place 1, component 2.
    assert_eq!(velocity[2 * 12 + 3 + 2], 0.5 * 29.0);
    let (_, _, x) = array(&bytes, "reference_position");
    assert_eq!(f64::from_le_bytes(*x.last_chunk().unwrap()), -0.125);
    // The same history gives the same bytes.
    let mut again = Vec::new();
    write_npz(&mut again, &history()).unwrap();
    assert_eq!(bytes, again);
}

#[test]
fn what_is_read_back_is_what_was_written_and_damage_is_named() {
    let temp = tempfile::tempdir().unwrap();
    let path = temp.path().join("history_tread.npz");
    let mut bytes = Vec::new();
    write_npz(&mut bytes, &history()).unwrap();
    std::fs::write(&path, &bytes).unwrap();
    let (stored, of) = (read(&path).unwrap(), history());
    assert_eq!((stored.times, stored.rate, stored.turning), (of.times, of.rate, of.turning));
    assert_eq!((stored.normals, stored.areas), (of.normals, of.areas));
    assert_eq!((stored.velocity.as_ref(), stored.road_force), (Some(&of.values[0].values), of.road_force));
    for cut in [0, 3, 40, bytes.len() / 2] {
        std::fs::write(&path, &bytes[..cut]).unwrap();
        let error = read(&path).unwrap_err().to_string();
        assert!(error.contains("not a history"), "{cut}: {error}");
    }
}

#[test]
fn the_universal_file_has_nodes_faces_and_functions_in_fixed_columns() {
    // A gap: two stretches.
    let gap = History { times: vec![1e-4, 1.5e-4, 2e-4, 9e-4, 9.5e-4], ..history() };
    let mut bytes = Vec::new();
    write_uff(&mut bytes, &gap).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[..2], ["    -1", "  2411"]);
    assert_eq!(lines[8], "         4         1         1        11");
    let [x, y, z] = [0, 25, 50].map(|at| lines[9][at..at + 25].trim().parse::<f64>().unwrap());
    assert_eq!([x, y, z], [0.0, 1.0, -0.125]);
    assert_eq!(lines[10..13], ["    -1", "    -1", "  2412"]);
    assert_eq!(lines[14], "         1         2         3         4");
    // Four places with three components of velocity and one of pressure, in two stretches.
    let heads: Vec<usize> = (0..lines.len()).filter(|i| lines[*i].starts_with("    58b")).collect();
    assert_eq!(heads.len(), 2 * 4 * 4);
    let head = heads[4];
    assert_eq!(
        lines[head],
        "    58b     1     2          11          12     0     0           0           0"
    );
    // Place 2, y: response in time, real single precision with an even abscissa.
    assert_eq!(
        lines[head + 6],
        "    1         0    0         0 NONE               2   2 NONE               0   0"
    );
    assert_eq!(lines[head + 7], "         2         3         1  1.00000E-04  5.00000E-05  0.00000E+00");
    assert_eq!(&lines[head + 9][..10], "        11");
}

//! Damaged and hostile files: each ends in an error with a remedy, quickly, and without more memory than a small multiple of the file.

use std::alloc::{GlobalAlloc, Layout, System};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use hexroll::Error;
use hexroll::model::mesh::Mesh;
use hexroll::output::mesh::{Msh, write_inp, write_msh, write_vtu};
use hexroll::scene::MeshSpec;

use crate::rig::{cube, metres, read, refused};

/// Counts what is allocated at once.
struct Counting;

static NOW: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

// SAFETY: passes everything on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    // SAFETY: as the system's allocator asks.
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let now = NOW.fetch_add(layout.size(), Ordering::Relaxed) + layout.size();
        MOST.fetch_max(now, Ordering::Relaxed);
        // SAFETY: the caller keeps to the contract.
        unsafe { System.alloc(layout) }
    }

    // SAFETY: as the system's allocator asks.
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller keeps to the contract.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// More than any file of these tests needs, and far less than what one of them claims to hold.
const BOUND: usize = 512 << 20;

/// The file must be refused, with line and remedy, within bounds.
fn bad(name: &str, text: impl AsRef<[u8]>, line: Option<usize>, what: &str) {
    MOST.store(NOW.load(Ordering::Relaxed), Ordering::Relaxed);
    let (at, problem, remedy) = refused(name, text);
    assert!(problem.contains(what), "{problem}; {remedy}");
    assert_eq!(at, line, "{problem}");
    assert!(MOST.load(Ordering::Relaxed) < BOUND, "{problem}");
}

#[test]
fn decks() {
    let of = |from: &str, to: &str| cube("").replacen(from, to, 1);
    let set = |behind: &str| cube(behind);
    let cases: &[(String, Option<usize>, &str)] = &[
        (String::new(), None, "no hexahedra"),
        ("\n\n".into(), None, "no hexahedra"),
        ("just text".into(), None, "no hexahedra"),
        (of("3, 1., 1., 0.", "3, NaN, 1., 0."), Some(4), "NaN is not a finite number"),
        (of("3, 1., 1., 0.", "3, 1e400, 1., 0."), Some(4), "inf is not a finite number"),
        (of("3, 1., 1., 0.", "3, 1e200, 1., 0."), Some(4), "too large"),
        (of("3, 1., 1., 0.", "3, 1..5, 1., 0."), Some(4), "\"1..5\" is not a number"),
        (of("3, 1., 1., 0.", "-3, 1., 1., 0."), Some(4), "\"-3\" is not a whole number"),
        (of("3, 1., 1., 0.", "99999999999999999999, 1., 1., 0."), Some(4), "is not a whole number"),
        (of("3, 1., 1., 0.\n", ""), None, "has the node 3, which is not there"),
        (of("1, 1, 2, 3", "1, 1, 2, 3000000000"), None, "which is not there"),
        (of(", 7, 8\n", ", 7, 8, 9\n"), Some(11), "9 nodes where 8 are needed"),
        (of(", 7, 8\n", ", 7\n"), Some(11), "and the file ends"),
        (of(", 7, 8\n", ", 7,\n*STEP\n"), Some(12), "in the middle of a data line"),
        (of("*ELEMENT, TYPE=C3D8,", "*ELEMENT,"), Some(10), "TYPE= is missing"),
        (set("*NSET, NSET=A\nNOBODY\n"), Some(13), "the set \"NOBODY\" is not there"),
        (set("*NSET, NSET=A\n1, 2, 99\n"), Some(13), "the node 99 is not there"),
        (set("*ELSET, ELSET=A\n5\n"), Some(13), "the element 5 is not there"),
        (set("*NSET, NSET=A\nB\n*NSET, NSET=B\nA\n"), Some(15), "has itself as a member"),
        (set("*NSET, NSET=A, GENERATE\n5, 1, 1\n"), Some(13), "1 comes before 5"),
        (set("*NSET, NSET=A, GENERATE\n1, 5, 0\n"), Some(13), "step of zero"),
        (set("*NSET\n1\n"), Some(12), "NSET= is missing"),
        (set("*SURFACE, NAME=S\nALL_OF_IT, S9\n"), Some(13), "is not a face"),
        (set("*SURFACE, NAME=S\nNOBODY, S1\n"), Some(13), "\"NOBODY\" is not there"),
        (set("*INCLUDE, INPUT=nowhere.inp\n"), Some(12), "there is no file"),
        (set("*INCLUDE, INPUT=bad.inp\n"), Some(12), "includes itself"),
        (set("*INSTANCE, NAME=I, PART=P\n"), Some(12), "there is no part"),
        (format!("*PART, NAME=P\n{}*END PART\n", cube("")), None, "parts without an instance"),
        (set("*NSET,\n*NODE\n"), Some(13), "does not end"),
        (set(&format!("*NSET, NSET=A\n{}", "1, ".repeat(1_000_000))), Some(13), "a line of more than"),
        (of("3, 1., 1., 0.", "3, 1., 1., 0.\u{0}"), Some(4), "is not a number"),
    ];
    for (text, line, what) in cases {
        bad("bad.inp", text, *line, what);
    }
    // Sets in sets, deeper than a stack is; and more of them than anybody needs.
    let chain =
        |count: usize| (0..count).map(|i| format!("*NSET, NSET=S{i}\nS{}\n", i + 1)).collect::<String>();
    bad("bad.inp", cube(&(chain(100_000) + "*NSET, NSET=S100000\n1\n")), Some(211), "more than 100 deep");
    let many: String = (0..20_000).map(|i| format!("*NSET, NSET=S{i}\n1\n")).collect();
    bad("bad.inp", cube(&many), None, "20001 sets, and at most");
}

/// Ranges and numbers that say much cost nothing.
#[test]
fn large_numbers_cost_no_memory() {
    MOST.store(NOW.load(Ordering::Relaxed), Ordering::Relaxed);
    let deck = cube("*NSET, NSET=A, GENERATE\n1, 999999999999999999, 1\n")
        .replace("8, 0., 1., 1.", "888888888888888, 0., 1., 1.");
    let mesh = read("a.inp", deck.replace("6, 7, 8", "6, 7, 888888888888888")).unwrap();
    assert_eq!(mesh.set("A").unwrap().len(), 8);
    assert!(MOST.load(Ordering::Relaxed) < BOUND);
}

fn block() -> Mesh {
    Mesh::generate(&MeshSpec::Block { size: [1.0; 3], elements: [2, 1, 1] })
}

fn msh(old: bool, binary: bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_msh(&mut bytes, &block(), Msh { old, binary }).unwrap();
    bytes
}

#[test]
fn gmsh_meshes() {
    let text = |old: bool| String::from_utf8(msh(old, false)).unwrap();
    let of = |old: bool, from: &str, to: &str| {
        let whole = text(old);
        assert!(whole.contains(from), "{from} in\n{whole}");
        whole.replacen(from, to, 1)
    };
    let line = |text: &str, section: &str| text.lines().position(|l| l == section).unwrap() + 2;
    let (nodes2, nodes4) = (line(&text(true), "$Nodes"), line(&text(false), "$Nodes"));
    bad("a.msh", "", None, "does not begin with $MeshFormat");
    bad("a.msh", of(true, "2.2 0 8", "1.0 0 8"), Some(2), "version \"1.0\" is not read");
    bad("a.msh", of(false, "4.1 0 8", "4.1 0 4"), Some(2), "no line of version");
    bad("a.msh", of(true, "$Nodes\n12", "$Nodes\n13"), Some(nodes2 + 13), "stands where numbers should");
    bad("a.msh", of(true, "$Nodes\n12", "$Nodes\n11"), Some(nodes2 + 12), "stands where $EndNodes should");
    bad(
        "a.msh",
        of(true, "$Nodes\n12", "$Nodes\n99999999999999"),
        Some(nodes2 + 13),
        "stands where numbers should",
    );
    bad(
        "a.msh",
        of(false, "$Nodes\n1 12 ", "$Nodes\n1 999999999999 "),
        Some(nodes4 + 25),
        "are announced, and 12 are there",
    );
    bad(
        "a.msh",
        of(false, "$Nodes\n1 12 ", "$Nodes\n1 5 "),
        Some(nodes4 + 1),
        "a block of 12 nodes where 5 are left",
    );
    bad("a.msh", of(true, "1 0e0 0e0 0e0", "1 nan 0e0 0e0"), Some(nodes2 + 1), "NaN is not a finite number");
    bad("a.msh", of(true, "1 0e0 0e0 0e0", "1 1e99 0e0 0e0"), Some(nodes2 + 1), "too large");
    bad("a.msh", of(true, "1 0e0 0e0 0e0", "2 0e0 0e0 0e0"), None, "node 2 is there twice");
    bad("a.msh", of(true, "1 5 2 1 1 1 ", "1 5 2 1 1 77 "), None, "has the node 77, which is not there");
    bad(
        "a.msh",
        of(true, "1 5 2 1 1 1 ", "1 555 2 1 1 1 "),
        Some(line(&text(true), "$Elements") + 1),
        "elements of type 555",
    );
    bad(
        "a.msh",
        of(true, "1 5 2 1 1 1 ", "1 5 4000000000 1 1 1 "),
        Some(line(&text(true), "$Elements") + 1),
        "4000000000 tags",
    );
    bad(
        "a.msh",
        of(true, "$EndElements", "$EndElement"),
        Some(text(true).lines().count()),
        "stands where $EndElements should",
    );
}

/// Binary counts that claim more than the file has, of both versions.
/// A binary file must be refused within bounds; a line says little there.
fn lies(bytes: &[u8], what: &str) {
    MOST.store(NOW.load(Ordering::Relaxed), Ordering::Relaxed);
    let (_, problem, remedy) = refused("a.msh", bytes);
    assert!(problem.contains(what), "{problem}; {remedy}");
    assert!(MOST.load(Ordering::Relaxed) < BOUND, "{problem}");
}

#[test]
fn binary_counts_that_lie() {
    let find =
        |bytes: &[u8], what: &[u8]| bytes.windows(what.len()).position(|w| w == what).unwrap() + what.len();
    let mut bytes = msh(false, true);
    let at = find(&bytes, b"$Nodes\n") + 8;
    bytes[at..at + 8].copy_from_slice(&(1_u64 << 60).to_ne_bytes());
    let block = at + 24 + 12;
    bytes[block..block + 8].copy_from_slice(&(1_u64 << 50).to_ne_bytes());
    lies(&bytes, "the file ends after");
    let mut bytes = msh(true, true);
    let at = find(&bytes, b"$Elements\n");
    let at = at + find(&bytes[at..], b"\n") + 4;
    bytes[at..at + 4].copy_from_slice(&i32::MAX.to_ne_bytes());
    lies(&bytes, "a block of");
    bytes[at..at + 4].copy_from_slice(&(-1_i32).to_ne_bytes());
    lies(&bytes, "negative number");
    // Another byte order.
    let mut bytes = msh(false, true);
    let at = find(&bytes, b"4.1 1 8\n");
    bytes[at..at + 4].reverse();
    bad("a.msh", &bytes, Some(2), "byte order");
}

#[test]
fn vtk_grids() {
    let mut bytes = Vec::new();
    write_vtu(&mut bytes, &block()).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let of = |from: &str, to: &str| {
        assert!(text.contains(from), "{from} in\n{text}");
        text.replacen(from, to, 1)
    };
    bad("a.vtu", "", None, "not a complete XML file");
    bad("a.vtu", "<VTKFile", None, "not a complete XML file");
    bad("a.vtu", of("UnstructuredGrid", "ImageData"), None, "no <VTKFile");
    bad(
        "a.vtu",
        of("NumberOfPoints=\"12\"", "NumberOfPoints=\"99999999999\""),
        None,
        "are no 99999999999 points",
    );
    bad("a.vtu", of("NumberOfCells=\"2\"", "NumberOfCells=\"-2\""), None, "not a whole number");
    bad(
        "a.vtu",
        of("header_type", "compressor=\"vtkLZ4DataCompressor\" header_type"),
        None,
        "vtkLZ4DataCompressor",
    );
    // A header that is taken for that of compressed blocks.
    bad("a.vtu", of("header_type", "compressor=\"vtkZLibDataCompressor\" header_type"), None, "");
    bad(
        "a.vtu",
        of("Name=\"connectivity\"", "Name=\"connections\""),
        None,
        "there is no array \"connectivity\"",
    );
    bad("a.vtu", of("offset=\"0\"", "offset=\"99999999\""), None, "behind the end");
    bad(
        "a.vtu",
        of("type=\"Float64\" Name=\"points\"", "type=\"Float32\" Name=\"points\""),
        None,
        "are no 12 points",
    );
    let plain = |points: &str, connectivity: &str| {
        format!(
            "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"8\" NumberOfCells=\"1\"><Points>\
             <DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">{points}</DataArray></Points><Cells>\
             <DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">{connectivity}</DataArray>\
             <DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">8</DataArray>\
             <DataArray type=\"Int32\" Name=\"types\" format=\"ascii\">12</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>"
        )
    };
    let points = "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1";
    assert!(read("a.vtu", plain(points, "0 1 2 3 4 5 6 7")).is_ok());
    bad(
        "a.vtu",
        plain(&points.replacen("1 1 1", "1 nan 1", 1), "0 1 2 3 4 5 6 7"),
        None,
        "NaN is not a finite number",
    );
    bad("a.vtu", plain(points, "0 1 2 3 4 5 6 8"), None, "the point 8, and there are 8");
    bad("a.vtu", plain(points, "0 1 2 3 4 5 6 -1"), None, "is no number of type");
    bad("a.vtu", plain(points, "0 1 2 3"), None, "ends at entry 8 of 4");
    bad("a.vtu", plain(points, "0 1 2 3 4 5 6 6"), None, "have a node twice");
}

/// Cut anywhere, a file is refused, or is another whole one; nothing panics.
#[test]
fn files_cut_anywhere() {
    let mut files = vec![
        ("a.msh", msh(false, false)),
        ("a.msh", msh(false, true)),
        ("a.msh", msh(true, false)),
        ("a.msh", msh(true, true)),
    ];
    for (name, write) in [
        ("a.inp", write_inp as fn(&mut dyn std::io::Write, &Mesh) -> std::io::Result<()>),
        ("a.vtu", write_vtu),
    ] {
        let mut bytes = Vec::new();
        write(&mut bytes, &block()).unwrap();
        files.push((name, bytes));
    }
    let folder = tempfile::TempDir::new().unwrap();
    for (name, whole) in files {
        let path = folder.path().join(name);
        let (mut refused, cuts) = (0, (0..whole.len()).step_by(7));
        let count = cuts.len();
        for cut in cuts {
            std::fs::write(&path, &whole[..cut]).unwrap();
            match Mesh::imported(&metres(&path), None) {
                Err(Error::Scene { problem, remedy, .. }) => {
                    assert!(!problem.is_empty() && !remedy.is_empty());
                    refused += 1;
                }
                Err(other) => panic!("{name} cut at {cut}: {other:?}"),
                // A deck has no end: one without its last sets is a deck. Other files may lack the end of their last line.
                Ok(_) => assert!(name == "a.inp" || cut + 1 == whole.len(), "{name} cut at {cut}"),
            }
        }
        assert!(refused > count / 3, "{name}: {refused} of {count}");
    }
}

/// A byte changed anywhere: an error or a mesh, no panic.
#[test]
fn bytes_changed_anywhere() {
    let folder = tempfile::TempDir::new().unwrap();
    let mut inp = Vec::new();
    write_inp(&mut inp, &block()).unwrap();
    let mut vtu = Vec::new();
    write_vtu(&mut vtu, &block()).unwrap();
    for (name, whole) in
        [("a.inp", inp), ("a.vtu", vtu), ("a.msh", msh(false, true)), ("a.msh", msh(true, false))]
    {
        let path = folder.path().join(name);
        for at in (0..whole.len()).step_by(5) {
            let mut bytes = whole.clone();
            bytes[at] ^= [0x01, 0x80, 0x10, 0xff][at % 4];
            std::fs::write(&path, &bytes).unwrap();
            MOST.store(NOW.load(Ordering::Relaxed), Ordering::Relaxed);
            _ = Mesh::imported(&metres(&path), None);
            assert!(MOST.load(Ordering::Relaxed) < BOUND, "{name} at {at}");
        }
    }
}

#[test]
fn what_is_no_file_is_said() {
    let missing = Mesh::imported(&metres(Path::new("nowhere/wheel.inp")), None);
    assert!(matches!(missing, Err(Error::Io { .. })));
    let folder = tempfile::TempDir::new().unwrap();
    std::fs::create_dir(folder.path().join("a.inp")).unwrap();
    let (_, problem, _) = crate::rig::parts(Mesh::imported(&metres(&folder.path().join("a.inp")), None));
    assert!(problem.contains("no plain file"), "{problem}");
}

//! Memory: what a run holds at most is what was estimated from element counts, before anything was allocated. The
//! allocator of this test counts every byte.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use hexroll::memory::Counts;
use hexroll::model::Model;
use hexroll::record::{Sample, Snapshot};
use hexroll::run::{Observer, Progress, run};
use hexroll::scene::Scene;
use hexroll::{Precision, cpu};
use hexroll_cli::choose::need;

struct Counting;
static HELD: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

// SAFETY: the system's allocator does the work.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        MOST.fetch_max(HELD.fetch_add(layout.size(), Relaxed) + layout.size(), Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Most bytes held since, beyond those held now.
fn peak_of<R>(of: impl FnOnce() -> R) -> (R, usize) {
    let before = HELD.load(Relaxed);
    MOST.store(before, Relaxed);
    let result = of();
    (result, MOST.load(Relaxed) - before)
}

fn scene(mesh: &str, viscosity: &str) -> Scene {
    let text = format!(
        r#"title = "memory"
[body]
density = "1100 kg/m3"
[body.mesh]
{mesh}
[body.material]
law = "mooney-rivlin"
shear_modulus = "2.64 MPa"
bulk_modulus = "65.1 MPa"
{viscosity}
[rim]
nodes = "inner"
[road]
shape = "plane"
[friction]
coefficient = 1.0
[[stage]]
name = "press"
method = "explicit"
duration = "3 us"
[stage.rim]
z = {{ velocity = "-0.1 m/s" }}
[output]
sample = "1 us"
snapshots = "stage-ends"
"#
    );
    Scene::parse(&text, "memory.toml", &[]).unwrap()
}

const RING: &str =
    "generator = \"ring\"\nouter_radius = \"39 mm\"\ninner_radius = \"17 mm\"\nwidth = \"17.5 mm\"\n";

struct Silent;
impl Observer for Silent {
    fn sample(&mut self, _: &Sample, _: &Progress) -> hexroll::Result<()> {
        Ok(())
    }
    fn snapshot(&mut self, _: &Snapshot, _: &str) -> hexroll::Result<()> {
        Ok(())
    }
}

/// Most bytes of the body, and of all of a run.
fn measured(scene: &Scene, precision: Precision) -> [f64; 2] {
    let (result, all) = peak_of(|| {
        let (model, body) = peak_of(|| Model::new(scene));
        let model = model?;
        let mut engine = cpu::engine(&model, scene, precision, 1)?;
        let before = MOST.load(Relaxed);
        run(scene, &model, &mut *engine, &mut Silent)?;
        println!("before the run {:.2} MB", 1e-6 * before as f64);
        Ok::<_, hexroll::Error>(body)
    });
    [result.unwrap() as f64, all as f64]
}

/// The estimate is the peak within 15 %: what counts leave out (columns of a few numbers a row, growth of arrays by doubling) is
/// some per cent, and so is what lanes of another width read beyond the ends of lines.
#[test]
fn the_estimate_is_the_peak() {
    let cases = [
        (format!("{RING}elements = [132, 12, 15]"), "", "a ring of 23,760 elements"),
        (
            format!("{RING}elements = [176, 16, 20]"),
            "viscosity = \"20 Pa s\"",
            "a viscous ring of 56,320 elements",
        ),
        (
            format!("{RING}elements = [132, 12, 16]\ngrading = [4, 1, 2]"),
            "",
            "a graded ring of 25,344 elements",
        ),
    ];
    let mut wrong = Vec::new();
    for (mesh, viscosity, name) in cases {
        let scene = scene(&mesh, viscosity);
        for precision in cpu::PRECISIONS {
            let [body, all] = measured(&scene, precision);
            let all_of = need(&scene, Some(precision));
            let [of_body, of_all] = [need(&scene, None), all_of.clone()].map(|n| n.bytes() as f64);
            println!("{name} {precision}: body {:.2}, all {:.2} of {all_of}", of_body / body, of_all / all);
            if [of_body / body, of_all / all].iter().any(|share| (share - 1.0).abs() > 0.15) {
                wrong.push(format!(
                    "{name}, {precision}: {of_body:.3e} of {body:.3e}, {of_all:.3e} of {all:.3e}"
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

fn shipped(name: &str, sets: &[&str]) -> Scene {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenes/{name}.toml"));
    Scene::load(&file, &sets.iter().map(ToString::to_string).collect::<Vec<_>>()).unwrap()
}

#[test]
fn counts_are_those_of_the_mesh_that_is_made() {
    for (name, sets) in [
        ("lat100_straight", &["body.mesh.elements=[44, 4, 5]"][..]),
        ("lat100_straight", &["body.mesh.elements=[7, 1, 1]"]),
        ("lat100_straight", &["body.mesh.elements=[24, 3, 5]", "body.mesh.grading=[3, 1, 2]"]),
        ("spinning_block", &["body.mesh.elements=[3, 4, 5]"]),
        ("pressed_block", &["body.mesh.elements=[3, 4, 5]", "body.mesh.grading=[2, 1, 1]"]),
    ] {
        let scene = shipped(name, sets);
        let (counts, model) = (Counts::of(&scene), Model::new(&scene).unwrap());
        let mesh = &model.mesh;
        let made = [mesh.hexes.len(), mesh.nodes.len(), mesh.facets.len(), mesh.surface.len()];
        let counted = [counts.elements, counts.nodes, counts.facets, counts.surface];
        assert_eq!(counted, made.map(|n| n as u64), "{name} {sets:?}");
        assert!(model.classes.len() as u64 <= counts.shapes, "{} {}", model.classes.len(), counts.shapes);
        assert_eq!(counts.lines * counts.line_nodes, counts.nodes);
    }
}

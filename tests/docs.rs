//! The pages for users: every key, column and file is described, and every link leads somewhere.

use hexroll::Error;
use hexroll::record::Sample;
use hexroll::scene::{Friction, Law, Scene};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn text(path: impl AsRef<Path>) -> String {
    let path = root().join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// A scene with every section that may have keys of its own.
const SCENE: &str = r#"
title = "all sections"
[body]
density = "1100 kg/m3"
[body.mesh]
generator = "ring"
outer_radius = "39 mm"
inner_radius = "17 mm"
width = "17.5 mm"
elements = [16, 2, 3]
[body.material]
shear_modulus = "2.64 MPa"
bulk_modulus = "65.1 MPa"
[rim]
nodes = "inner"
[[hold]]
nodes = "outer"
components = "x"
[[motion]]
nodes = "y-max"
x = { displacement = "1 mm", ramp = "5 ms" }
y = { table = [["0 ms", "0 mm"]] }
[road]
[friction]
coefficient = 0.5
[time_step]
[[stage]]
method = "quasi-static"
duration = "10 ms"
mass_damping = "100 1/s"
settle = {}
[stage.rim]
z = { displacement = "-1 mm", ramp = "5 ms" }
[[stage]]
method = "implicit"
duration = "10 ms"
implicit = { scheme = "static" }
[stage.rim]
spin = { moment = "0 N m", inertia = "1 kg m2" }
steer = { velocity = "1 rad/s" }
[[stage]]
method = "explicit"
duration = "10 ms"
[stage.rim]
x = { velocity = "1 m/s" }
y = { force = "1 N", mass = "1 kg" }
spin = { slip = 0.1, free_radius = "38 mm" }
camber = { angle = "1 deg", ramp = "5 ms" }
[output]
sample = "1 ms"
[[output.history]]
name = "tread"
nodes = "outer"
"#;

/// Keys that the section takes, as the answer to one that it does not know lists them (the one of these changes, or of the scene).
fn keys(section: &str, changes: &[&str]) -> Vec<String> {
    let unknown = format!("{section}qqqqqq=1");
    let changes: Vec<String> = changes.iter().map(|c| c.to_string()).chain([unknown]).collect();
    match Scene::parse(SCENE, "scene.toml", &changes) {
        Err(Error::Scene { key, problem, remedy, .. }) if key.starts_with(section) => {
            assert!(problem.starts_with("unknown key"), "{key}: {problem}");
            let (_, list) = remedy.split_once("known here: ").expect("a list of keys");
            list.split(", ").map(|key| key.trim().to_string()).collect()
        }
        other => panic!("{section}: {other:?}"),
    }
}

#[test]
fn the_guide_has_every_key_of_the_reader() {
    let mut sections: Vec<(&str, Vec<String>)> = [
        "",
        "body.",
        "body.mesh.",
        "body.material.",
        "rim.",
        "hold.0.",
        "motion.0.",
        "motion.0.x.",
        "motion.0.y.",
        "road.",
        "friction.",
        "time_step.",
        "stage.0.",
        "stage.0.settle.",
        "stage.0.rim.",
        "stage.2.rim.x.",
        "stage.2.rim.y.",
        "stage.0.rim.z.",
        "stage.2.rim.spin.",
        "stage.2.rim.camber.",
        "stage.1.implicit.",
        "stage.1.rim.spin.",
        "stage.1.rim.steer.",
        "output.",
        "output.history.0.",
    ]
    .map(|section| (section, keys(section, &[])))
    .into();
    for motion in ["y={ amplitude = \"1 mm\" }", "turn={ axis = [0, 1, 0], angle = \"1 deg\" }"] {
        let section = if motion.starts_with('y') { "motion.0.y." } else { "motion.0.turn." };
        sections.push((section, keys(section, &[&format!("motion.0.{motion}")])));
    }
    for road in ["drum", "disk"] {
        sections.push(("road.", keys("road.", &[&format!("road.shape={road}")])));
    }
    for form in ["cosine", "cleat", "step", "points"] {
        let form = format!("road.form={form}");
        sections.push(("road.", keys("road.", &["road.shape=profile", &form])));
    }
    for source in
        ["file=a.png", "file=a.csv", "file=a.asc", "file=a.crg", "generate=iso-8608", "generate=self-affine"]
    {
        let source = format!("road.{source}");
        sections.push(("road.", keys("road.", &["road.shape=height-field", &source])));
    }
    let file = "body.mesh={ file = \"a.inp\", unit = \"mm\" }";
    sections.push(("body.mesh.", keys("body.mesh.", &[file])));
    sections.push(("body.mesh.revolve.", keys("body.mesh.revolve.", &[file, "body.mesh.revolve.sectors=9"])));
    for kind in Friction::KINDS {
        sections.push(("friction.", keys("friction.", &[&format!("friction.law={}", kind.name)])));
    }
    let guide = text("docs/guide/scene.md");
    let names: BTreeSet<&str> =
        guide.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '-')).collect();
    let mut count = 0;
    for (section, keys) in &sections {
        for key in keys {
            assert!(names.contains(key.as_str()), "docs/guide/scene.md does not have {section}{key}");
            count += 1;
        }
    }
    assert!(count > 100, "{count} keys");
    for name in Law::KINDS.iter().map(|k| k.name).chain(Friction::KINDS.iter().map(|k| k.name)) {
        assert!(names.contains(name), "docs/guide/scene.md does not have the law {name}");
    }
}

#[test]
fn the_guide_has_every_column_and_file() {
    let guide = text("docs/guide/outputs.md");
    for name in Sample::COLUMNS.iter().map(|(name, _)| *name).chain(["time_s", "stage"]) {
        assert!(
            guide.contains(&format!("`{name}`")),
            "docs/guide/outputs.md does not have the column {name}"
        );
    }
    for file in [
        "history.csv",
        "summary.json",
        "implicit.csv",
        "reactions.csv",
        "curves.csv",
        "run.pvd",
        "scene.toml",
        "contact_<k>.csv",
        "snapshot_<k>.vtu",
        "history_<name>.npz",
        "history_<name>.uff",
        "spectrum_<name>.csv",
        "bands_<name>.csv",
        "report.html",
    ] {
        assert!(guide.contains(&format!("`{file}`")), "docs/guide/outputs.md does not have the file {file}");
    }
}

/// Markdown of the repository's root and of `docs/`.
fn pages() -> Vec<PathBuf> {
    let mut pages = Vec::new();
    let mut folders = vec![root().join("docs")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => folders.push(path),
                false => pages.push(path),
            }
        }
    }
    pages.extend(std::fs::read_dir(root()).unwrap().map(|entry| entry.unwrap().path()));
    pages.retain(|path| path.extension().is_some_and(|e| e == "md"));
    pages
}

/// Anchors that a page's headings give, as GitHub makes them.
fn anchors(page: &str) -> BTreeSet<String> {
    let anchor = |heading: &str| -> String {
        let kept = heading.trim().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        kept.map(|c| if c == ' ' { '-' } else { c.to_ascii_lowercase() }).collect()
    };
    let headings = page.lines().filter(|l| l.starts_with('#')).map(|l| anchor(l.trim_start_matches('#')));
    let named = page.split("<a name=\"").skip(1).map(|rest| rest.split('"').next().unwrap_or("").to_string());
    headings.chain(named).collect()
}

#[test]
fn links_lead_somewhere() {
    let mut count = 0;
    for path in pages() {
        let page = text(&path);
        for link in page.split("](").skip(1).map(|rest| rest.split(')').next().unwrap_or("")) {
            if link.starts_with("http") {
                continue;
            }
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { path.clone() } else { path.parent().unwrap().join(file) };
            assert!(target.exists(), "{}: no {link}", path.display());
            if !anchor.is_empty() {
                let there = anchors(&text(&target));
                assert!(there.contains(anchor), "{}: {link}: only {there:?}", path.display());
            }
            count += 1;
        }
    }
    assert!(count > 50, "{count} links");
}

#[test]
fn the_readme_is_short() {
    let lines = text("README.md").lines().count();
    assert!(lines <= 120, "{lines} lines");
}

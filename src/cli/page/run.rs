//! The page of a run.

use std::path::Path;

use super::{Pictures, histories, no_run};
use crate::check::{Body, stages};
use crate::estimate::Steps;
use crate::format::{count, si};
use crate::table;
use hexroll::model::Model;
use hexroll::output::stages::{Span, spans};
use hexroll::output::summary::{StageMeans, Versions, WorstBalance};
use hexroll::output::{Summary, folder, read};
use hexroll::plot::page::{Mood, Page};
use hexroll::record::Sample;
use hexroll::scene::Scene;
use hexroll::{Error, Result};

/// What a run's folder holds, as far as it can be read.
struct Found {
    history: Vec<Sample>,
    spans: Vec<Span>,
    summary: Option<Summary>,
    /// The scene as it was run, and what it says.
    text: Option<String>,
    scene: Option<Scene>,
    /// What could not be read.
    gaps: Vec<String>,
}

/// The page on the run in `dir`.
///
/// # Errors
/// [`Error::Format`] if there is no run; a damaged file of one is named on the page.
pub fn page(dir: &Path, pictures: Pictures) -> Result<Page> {
    if !folder::is_run(dir) {
        return Err(no_run(dir));
    }
    let found = Found::of(dir);
    let title = found.title(dir);
    let state = found.state(dir);
    let mut page = Page::new(&title, Some((state.0, &state.1)));
    opening(&mut page, &found);
    results(&mut page, &found);
    pictures_of(&mut page, dir, pictures)?;
    let events = histories::starts(&found.spans);
    for (title, panels) in [
        ("Forces and motion", histories::motion(&found.history)),
        ("Footprint", histories::footprint(&found.history)),
    ] {
        if !panels.is_empty() {
            page.section(title);
            page.remark("Forces are means over a window, from every step. A pointer that rests on a plot is told the values.");
            page.plots(&panels, &events);
        }
    }
    page.section("Energies and balances");
    balances(&mut page, &found);
    page.plots(&histories::energy(&found.history), &events);
    modelled(&mut page, &found);
    again(&mut page, dir, &found);
    Ok(page)
}

impl Found {
    fn of(dir: &Path) -> Found {
        let mut gaps = Vec::new();
        let mut kept = |error: Error| gaps.push(error.to_string());
        let history = read::history(dir).map_err(&mut kept).unwrap_or_default();
        let summary = read::summary(dir).map_err(&mut kept).ok().flatten();
        let text = read::scene_text(dir).map_err(&mut kept).ok().flatten();
        let file = dir.join(folder::SCENE);
        let read = |text: &String| Scene::parse(text, &file.to_string_lossy(), &[]).map_err(&mut kept).ok();
        let scene = text.as_ref().and_then(read);
        Found { spans: spans(&history), history, summary, text, scene, gaps }
    }

    fn title(&self, dir: &Path) -> String {
        let of_summary = self.summary.as_ref().map(|s| s.title.clone());
        let title = of_summary.or_else(|| self.scene.as_ref().map(|s| s.title.clone()));
        title.filter(|t| !t.is_empty()).unwrap_or_else(|| dir.display().to_string())
    }

    /// Whether the run has come to its end, in words.
    fn state(&self, dir: &Path) -> (Mood, String) {
        let reached = self.history.last().map_or(0.0, |s| s.time_s);
        let end = self.scene.as_ref().map(|s| s.stages.iter().map(|stage| stage.duration).sum::<f64>());
        let of = end.map_or(String::new(), |end| format!(" of at most {}", si(end, "s")));
        let reached = format!("{}{of}", si(reached, "s"));
        match &self.summary {
            Some(summary) if summary.finished => (Mood::Good, "finished".into()),
            Some(_) => (Mood::Bad, format!("ended early, at {reached}")),
            None if folder::is_being_written(dir) => (Mood::Care, format!("still running, at {reached}")),
            None => (
                Mood::Bad,
                format!("half-written: the run was killed, or its machine went down, at {reached}"),
            ),
        }
    }
}

/// What was asked, what must not be missed, and how it was computed.
fn opening(page: &mut Page, found: &Found) {
    if let Some(scene) = &found.scene {
        [("Expected: ", &scene.expected), ("Source: ", &scene.source)]
            .into_iter()
            .filter(|(_, text)| !text.is_empty())
            .for_each(|(name, text)| page.remark(&format!("{name}{text}")));
    }
    found.gaps.iter().for_each(|gap| page.note(Mood::Bad, gap));
    let Some(summary) = &found.summary else {
        page.note(
            Mood::Bad,
            "There is no summary.json: engine, errors and tyre figures of this run are not known. What follows is what it \
             has written so far.",
        );
        return;
    };
    let ended = |warning: &str| warning.starts_with("the run did not finish");
    for warning in &summary.warnings {
        page.note(if ended(warning) { Mood::Bad } else { Mood::Care }, warning);
    }
    page.section("Summary");
    page.facts(joined(table::lines(summary)));
}

/// Rows of one name each: a row without a name goes on with the last.
fn joined(lines: Vec<(&'static str, String)>) -> Vec<(&'static str, String)> {
    let mut rows: Vec<(&str, String)> = Vec::new();
    for (name, value) in lines {
        match rows.last_mut() {
            Some((_, last)) if name.is_empty() => {
                last.push_str("; ");
                last.push_str(&value);
            }
            _ => rows.push((name, value)),
        }
    }
    rows
}

/// Means of the stages, and the figures of those that roll.
fn results(page: &mut Page, found: &Found) {
    let of_history = || StageMeans::of(&found.history, &[]);
    let means = found.summary.as_ref().map_or_else(of_history, |s| s.stages.clone());
    if means.is_empty() {
        page.note(Mood::Care, "No window has ended yet: there are no numbers.");
        return;
    }
    page.section("Means of the stages");
    page.remark("Over the last 30 % of a stage's time; a stage that settles: at its end.");
    let row = |s: &StageMeans| {
        let numbers = [
            s.mean_road_fx_N,
            s.mean_road_fy_N,
            s.mean_road_fz_N,
            s.mean_rim_mx_Nm,
            s.mean_rim_my_Nm,
            s.mean_rim_mz_Nm,
            1e3 * s.mean_axle_z_m,
            1e6 * s.mean_contact_area_m2,
        ];
        let times = [s.start_s, s.end_s].map(|t| format!("{t:.4}"));
        let numbers = numbers.iter().map(|v| table::four_digits(*v));
        [s.stage.clone()].into_iter().chain(times).chain(numbers).collect::<Vec<_>>()
    };
    let head = [
        "stage",
        "from [s]",
        "to [s]",
        "road fx [N]",
        "fy [N]",
        "fz [N]",
        "rim mx [N m]",
        "my [N m]",
        "mz [N m]",
        "axle z [mm]",
        "area [mm2]",
    ];
    page.table(&head, &means.iter().map(row).collect::<Vec<_>>());
    for stage in &means {
        let mut figures = stage.rolling.as_ref().map(table::figures).unwrap_or_default();
        figures.extend(stage.contact.as_ref().map(|c| ("contact force", table::scatter(c))));
        if !figures.is_empty() {
            page.part(&format!("Stage {}", stage.stage));
            page.facts(figures);
        }
    }
}

/// Pictures of the folder: a name, a number, a file.
fn pictures_of(page: &mut Page, dir: &Path, wanted: Pictures) -> Result<()> {
    let mut found = folder::pictures(dir)?;
    let times: Vec<f64> = read::snapshots(dir).unwrap_or_default().iter().map(|s| s.time).collect();
    let last = |name: &str| found.iter().filter(|p| p.name == name).map(|p| p.snapshot).max();
    let keep: Vec<bool> = found
        .iter()
        .map(|p| match wanted {
            Pictures::All => true,
            Pictures::None => false,
            Pictures::Last => last(&p.name) == Some(p.snapshot),
        })
        .collect();
    let count_all = found.len();
    let mut keep = keep.into_iter();
    found.retain(|_| keep.next() == Some(true));
    if found.is_empty() {
        return Ok(());
    }
    page.section("Pictures");
    let left_out = count_all - found.len();
    if left_out > 0 {
        page.remark(&format!(
            "Of the last snapshot; {left_out} of earlier ones are in the folder (--pictures all)."
        ));
    }
    let mut shown = Vec::new();
    for picture in &found {
        let time = times.get(picture.snapshot).map_or(String::new(), |t| format!(", {}", si(*t, "s")));
        let caption = format!("{}: snapshot {}{time}", picture.name.replace('_', " "), picture.snapshot);
        let bytes = std::fs::read(&picture.path).map_err(Error::io(&picture.path, "read this file"))?;
        shown.push((bytes, caption));
    }
    page.pictures(shown.iter().map(|(bytes, caption)| (bytes.as_slice(), caption.as_str())));
    Ok(())
}

fn balances(page: &mut Page, found: &Found) {
    page.remark(
        "By work done: kinetic energy less every work, exact to round-off whatever the step; more is a force that nobody \
         booked. By stored energy: the same with the stored energy in place of the internal work; it shows the error of the \
         time integration.",
    );
    let text = |b: WorstBalance| {
        format!("{:.2e} J, {:.1e} of the largest term", b.worst_error_J, b.share_of_largest_term)
    };
    page.facts([
        ("worst error by work done", text(WorstBalance::of(&found.history))),
        ("worst error by stored energy", text(WorstBalance::of_stored(&found.history))),
    ]);
}

/// The scene, meshed again.
fn modelled(page: &mut Page, found: &Found) {
    let Some(scene) = &found.scene else { return };
    page.section("What was modelled");
    let meshed = hexroll::memory::ensure(scene, |scene| crate::choose::need(scene, None))
        .and_then(|()| Model::new(scene));
    match meshed.and_then(|model| Ok((Steps::of(scene, &model)?, model))) {
        Ok((steps, model)) => {
            page.facts(joined(Body::of(scene, &model, &steps.bounds).lines()));
            let pieces = stages::pieces(scene, &model.mesh.sets);
            page.facts(pieces.into_iter().map(|p| (p.name, p.detail.unwrap_or_else(|| "–".into()))));
            page.part("Stages");
            let row = |plan: stages::StagePlan| {
                let start = plan.initial_velocity.into_iter().map(String::from);
                let damping = (plan.mass_damping_per_s > 0.0)
                    .then(|| format!("mass damping {} 1/s", plan.mass_damping_per_s));
                let told: Vec<String> = start.chain(damping).chain(plan.rim).collect();
                vec![plan.name, plan.method, si(plan.duration_s, "s"), told.join("; ")]
            };
            let rows: Vec<Vec<String>> = stages::plans(scene, &steps).into_iter().map(row).collect();
            page.table(&["stage", "method", "at most", "motion of the rim, damping, start"], &rows);
        }
        Err(error) => page.note(Mood::Care, &format!("The mesh was not made again for this page: {error}")),
    }
}

/// How to run it again, and with what it was made.
fn again(page: &mut Page, dir: &Path, found: &Found) {
    page.section("How to run it again");
    page.paragraph("The scene as it was run, with every change of the command line in it, is the folder's scene.toml, and stands below.");
    let engine = found.summary.as_ref().map_or(String::new(), |s| {
        let threads = if s.engine == "cpu" { format!(" --threads {}", s.threads) } else { String::new() };
        format!(" --engine {} --precision {}{threads}", s.engine, s.precision)
    });
    page.listing(&format!("hexroll run {}{engine} --out runs/again", dir.join(folder::SCENE).display()));
    let mut facts = vec![("page made by", format!("hexroll {}", Versions::current().hexroll))];
    if let Some(s) = &found.summary {
        facts.insert(0, ("run made by", format!("hexroll {}, wgpu {}", s.versions.hexroll, s.versions.wgpu)));
        facts.push(("scene file", s.scene_file.clone()));
        facts.push(("hash of the scene", s.scene_hash.clone()));
        let adapter = s.adapter.iter().chain(&s.driver).cloned().collect::<Vec<_>>().join(", driver ");
        facts.extend((!adapter.is_empty()).then_some(("adapter", adapter)));
        facts.push(("steps", count(s.steps)));
    }
    facts.push(("folder", dir.display().to_string()));
    page.facts(facts);
    if let Some(text) = &found.text {
        page.folded("scene.toml", text);
    }
}

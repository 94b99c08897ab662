//! The pages of a study and of a sweep.

use std::path::Path;

use hexroll::Result;
use hexroll::output::summary::Versions;
use hexroll::plot::page::{Mood, Page};
use hexroll::study::index::{Index, Planned, STUDY, SWEEP};

pub fn study(dir: &Path) -> Result<Page> {
    page(dir, STUDY, "Mesh study", |page, planned| {
        let (study, missing) = planned.study(dir);
        if !study.runs.is_empty() {
            page.markdown(&study.markdown(""));
            page.plots(&study.panels(), &[]);
        }
        missing
    })
}

pub fn sweep(dir: &Path) -> Result<Page> {
    page(dir, SWEEP, "Sweep", |page, planned| {
        let (sweep, missing) = planned.sweep(dir);
        if !sweep.points.is_empty() {
            page.markdown(&sweep.markdown("", None));
            page.plots(&sweep.panels(), &[]);
        }
        missing
    })
}

/// A page with a section a scene: what has finished, and what is missing.
fn page(
    dir: &Path,
    name: &str,
    title: &str,
    mut fill: impl FnMut(&mut Page, &Planned) -> Vec<String>,
) -> Result<Page> {
    let index = Index::read(dir, name)?;
    let names: Vec<&str> = index.scenes.iter().map(|s| s.name.as_str()).collect();
    let title = format!("{title}: {}", names.join(", "));
    // The state stands above what is only known when the rest is written.
    let mut rest = Page::new("", None);
    let missing: Vec<String> = index.scenes.iter().flat_map(|planned| fill(&mut rest, planned)).collect();
    let runs: usize = index.scenes.iter().map(|s| s.runs.len()).sum();
    let done = runs - missing.len();
    let mut page = match missing.is_empty() {
        true => Page::new(&title, Some((Mood::Good, &format!("all {runs} runs have finished")))),
        false => Page::new(&title, Some((Mood::Care, &format!("{done} of {runs} runs have finished")))),
    };
    missing.iter().for_each(|line| page.note(Mood::Care, line));
    page.append(rest);
    page.section("How to make it again");
    page.paragraph(
        "Finished runs are kept: in the folder where it was typed, this goes on where it stopped.",
    );
    page.listing(&index.command);
    page.facts([
        ("folder", dir.display().to_string()),
        ("runs made by", format!("hexroll {}", index.version)),
        ("page made by", format!("hexroll {}", Versions::current().hexroll)),
    ]);
    Ok(page)
}

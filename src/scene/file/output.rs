//! `[output]`: windows, snapshots, pictures.

use super::history;
use crate::error::Result;
use crate::scene::reader::{Bound, Item, Later};
use crate::scene::units::TIME;
use crate::scene::{Field, Output, Picture, Snapshots, Stage};

const SPECTRA: [Later; 1] =
    [("spectra", "write [[output.history]], run the scene, and then hexroll spectrum on its folder")];

const PICTURES: [(&str, Picture); 8] = [
    ("footprint", Picture::Footprint),
    ("body:displacement", Picture::Body(Field::Displacement)),
    ("body:velocity", Picture::Body(Field::Velocity)),
    ("body:contact-force", Picture::Body(Field::ContactForce)),
    ("body:pressure", Picture::Body(Field::Pressure)),
    ("body:volume-ratio", Picture::Body(Field::VolumeRatio)),
    ("body:von-mises", Picture::Body(Field::VonMises)),
    ("body:friction-energy", Picture::Body(Field::FrictionEnergy)),
];

pub(super) fn output(item: &Item, stages: &[Stage], has_road: bool) -> Result<Output> {
    let table = item.table()?;
    table.only(&["sample", "snapshots", "pictures", "chatter_limit", "history"], &SPECTRA)?;
    let sample = table.quantity("sample", &TIME, Bound::Positive)?;
    if let Some(stage) = stages.iter().find(|s| s.duration < sample) {
        return Err(table.at("sample").error(
            format!("a window of {sample} s is longer than stage {:?} of {} s", stage.name, stage.duration),
            "write a sample no longer than the shortest stage",
        ));
    }
    let snapshots = table.get("snapshots").map_or(Ok(Snapshots::StageEnds), |s| snapshots(&s, sample))?;
    let pictures = table.get("pictures").map_or(Ok(Vec::new()), |p| pictures(&p, has_road))?;
    let chatter_limit = table.number_or("chatter_limit", 0.05, Bound::Positive)?;
    let histories =
        table.get("history").map_or(Ok(Vec::new()), |h| history::histories(&h, stages, has_road))?;
    Ok(Output { sample, snapshots, pictures, chatter_limit, histories })
}

fn snapshots(item: &Item, sample: f64) -> Result<Snapshots> {
    // What has a digit is meant as a time, and so is what is not even a string.
    let name = item.text().ok().filter(|t| !t.contains(|c: char| c.is_ascii_digit()));
    match name {
        Some("none") => return Ok(Snapshots::None),
        Some("stage-ends") => return Ok(Snapshots::StageEnds),
        Some(name) => {
            return Err(item.error(
                format!("{name:?} is not known here"),
                "write \"none\", \"stage-ends\" or a time such as \"10 ms\"",
            ));
        }
        None => {}
    }
    let every = item.quantity(&TIME, Bound::Positive)?;
    if every < sample {
        let problem = format!("{every} s is shorter than a sample of {sample} s");
        return Err(item.error(problem, "write a time of one or more samples"));
    }
    Ok(Snapshots::Every(every))
}

fn pictures(item: &Item, has_road: bool) -> Result<Vec<Picture>> {
    let of_contact =
        |p| matches!(p, Picture::Footprint | Picture::Body(Field::ContactForce | Field::FrictionEnergy));
    let picture = |entry: &Item| {
        let picture = entry.choice(&PICTURES, &[])?;
        if of_contact(picture) && !has_road {
            return Err(
                entry.error("there is no contact without a road", "add a section [road], or remove it")
            );
        }
        Ok(picture)
    };
    item.entries()?.iter().map(picture).collect()
}

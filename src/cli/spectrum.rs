//! `hexroll spectrum`.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::Args;

use super::study::{save_picture, save_text};
use super::terminal;
use hexroll::output::folder;
use hexroll::output::history;
use hexroll::output::spectrum::Spectra;
use hexroll::plot::{Mark, Panel, Series, figure};
use hexroll::{Error, Result};

pub const HELP: &str = "\
Power spectra of a run's histories at a high rate (a scene asks for them with [[output.history]]): of the road's force, and of
the mean-square velocity of the surface, by Welch's method with Hann windows that overlap by half; their coherence; and levels in
the one-third-octave bands of IEC 61260-1 from 100 to 5000 Hz. Writes spectrum_<name>.csv, bands_<name>.csv and
spectrum_<name>.png.

Examples:
  hexroll spectrum runs/rolling
  hexroll spectrum runs/rolling --history tread --from 0.05 --lines 5";

#[derive(Debug, Args)]
pub struct SpectrumArgs {
    /// Folder of the run
    dir: PathBuf,
    /// Which history; may be left out where there is one
    #[arg(long, value_name = "NAME")]
    history: Option<String>,
    /// Leave out what is earlier [s]
    #[arg(long, value_name = "SECONDS")]
    from: Option<f64>,
    /// Leave out what is later [s]
    #[arg(long, value_name = "SECONDS")]
    to: Option<f64>,
    /// Distance of the lines [Hz]; wider where the record is short
    #[arg(long, value_name = "HZ", default_value_t = 10.0, value_parser = positive)]
    lines: f64,
    /// Folder to write to; default the run's
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

fn positive(text: &str) -> std::result::Result<f64, String> {
    text.parse()
        .ok()
        .filter(|v: &f64| v.is_finite() && *v > 0.0)
        .ok_or_else(|| "write a number above 0".into())
}

pub fn execute(args: &SpectrumArgs) -> Result<()> {
    let name = chosen(args)?;
    let path = args.dir.join(folder::history_name(&name, "npz"));
    let stored = history::read(&path)?;
    let span = [args.from.unwrap_or(f64::NEG_INFINITY), args.to.unwrap_or(f64::INFINITY)];
    let spectra = Spectra::of(&stored, span, args.lines).ok_or_else(|| Error::Format {
        path: path.clone(),
        problem: "no spectrum can be made of it: there are fewer than 32 values in a stretch, or neither velocities nor a \
                  road's force"
            .into(),
    })?;
    let out = args.out.as_deref().unwrap_or(&args.dir);
    let files = [format!("spectrum_{name}.csv"), format!("bands_{name}.csv"), format!("spectrum_{name}.png")];
    let [lines, bands, picture] = files.map(|file| out.join(file));
    save_text(&lines_csv(&spectra), &lines)?;
    save_text(&bands_csv(&spectra), &bands)?;
    save_picture(&figure(&format!("Spectra of {name}"), &panels(&spectra), 2)?, &picture)?;
    terminal::print(&text(&spectra, [&lines, &bands, &picture]))
}

/// The history that is meant.
fn chosen(args: &SpectrumArgs) -> Result<String> {
    let names = folder::histories(&args.dir)?;
    let bad = |problem: String| Err(Error::Format { path: args.dir.clone(), problem });
    match (&args.history, names.as_slice()) {
        (_, []) => {
            bad("this folder has no history_<name>.npz; a scene asks for one with [[output.history]]".into())
        }
        (None, [one]) => Ok(one.clone()),
        (None, _) => {
            bad(format!("there are several histories: choose one with --history: {}", names.join(", ")))
        }
        (Some(name), _) if names.contains(name) => Ok(name.clone()),
        (Some(name), _) => bad(format!("there is no history {name:?}, only {}", names.join(", "))),
    }
}

fn lines_csv(spectra: &Spectra) -> String {
    let mut text = String::from("frequency_Hz");
    spectra.lines.iter().for_each(|l| _ = write!(text, ",{}", l.name));
    text += if spectra.coherence.is_some() { ",coherence_fz_velocity\n" } else { "\n" };
    for (k, frequency) in spectra.welch.frequencies().iter().enumerate() {
        _ = write!(text, "{frequency}");
        spectra.lines.iter().for_each(|l| _ = write!(text, ",{:e}", l.density[k]));
        spectra.coherence.iter().for_each(|c| _ = write!(text, ",{:.6}", c[k]));
        text.push('\n');
    }
    text
}

fn bands_csv(spectra: &Spectra) -> String {
    let mut text = String::from("nominal_Hz,low_Hz,high_Hz");
    spectra.lines.iter().for_each(|l| _ = write!(text, ",{}_dB", short(l.name)));
    text.push('\n');
    for (band, levels) in spectra.bands() {
        _ = write!(text, "{},{:.2},{:.2}", band.nominal, band.low, band.high);
        levels.iter().for_each(|l| _ = write!(text, ",{}", l.map_or(String::new(), |l| format!("{l:.2}"))));
        text.push('\n');
    }
    text
}

/// A column's name without its unit.
fn short(name: &str) -> &str {
    ["_N2_per_Hz", "_m2_s2_per_Hz"].iter().find_map(|unit| name.strip_suffix(unit)).unwrap_or(name)
}

fn panels(spectra: &Spectra) -> Vec<Panel> {
    let frequencies = spectra.welch.frequencies();
    let level = |density: &f64, reference: f64| 10.0 * (density / reference).log10();
    // A force that symmetry makes zero has round-off for a spectrum.
    let largest = |of: &[f64]| of.iter().copied().fold(0.0, f64::max);
    let loudest =
        spectra.lines.iter().filter(|l| l.unit == "N2").map(|l| largest(&l.density)).fold(0.0, f64::max);
    let shown = |l: &&hexroll::output::spectrum::Line| l.unit != "N2" || largest(&l.density) > 1e-9 * loudest;
    let mut panels: Vec<Panel> = Vec::new();
    for line in spectra.lines.iter().filter(shown) {
        let points =
            frequencies.iter().zip(&line.density).skip(1).map(|(f, d)| [*f, level(d, line.reference)]);
        panels.push(Panel {
            title: line.title.into(),
            x: "frequency [Hz]".into(),
            y: format!("level [dB re ({})2/Hz]", line.reference_text),
            series: vec![curve(points.collect(), Mark::Curve)],
            log_x: true,
        });
        let at = spectra.lines.iter().position(|l| l.name == line.name).unwrap_or(0);
        let points = spectra.bands().into_iter().filter_map(|(b, levels)| Some([b.middle, levels[at]?]));
        panels.push(Panel {
            title: format!("{}, one-third-octave bands", line.title),
            x: "frequency [Hz]".into(),
            y: format!("level [dB re {}]", line.reference_text),
            series: vec![curve(points.collect(), Mark::Line)],
            log_x: true,
        });
    }
    if let Some(coherence) = &spectra.coherence {
        panels.push(Panel {
            title: "coherence of the road's force (z) and the surface's mean normal velocity".into(),
            x: "frequency [Hz]".into(),
            y: "coherence".into(),
            series: vec![curve(
                frequencies.iter().zip(coherence).skip(1).map(|(f, c)| [*f, *c]).collect(),
                Mark::Curve,
            )],
            log_x: true,
        });
    }
    panels
}

fn curve(points: Vec<[f64; 2]>, mark: Mark) -> Series {
    Series { label: String::new(), points, bars: Vec::new(), mark }
}

/// The bands as a table, and what they are of.
fn text(spectra: &Spectra, files: [&Path; 3]) -> String {
    let mut text = format!(
        "{:.4} .. {:.4} s, {} of {:.1} ms, lines every {:.2} Hz\n\n  {:>8}",
        spectra.from,
        spectra.to,
        super::format::plural(spectra.segments, "segment"),
        1e3 / spectra.welch.width(),
        spectra.welch.width(),
        "band [Hz]"
    );
    spectra.lines.iter().for_each(|l| _ = write!(text, " {:>24}", format!("{} [dB]", short(l.name))));
    text.push('\n');
    for (band, levels) in spectra.bands() {
        _ = write!(text, "  {:>9}", band.nominal);
        levels.iter().for_each(|l| _ = write!(text, " {:>24}", l.map_or("–".into(), |l| format!("{l:.1}"))));
        text.push('\n');
    }
    let mut references: Vec<String> =
        spectra.lines.iter().map(|l| format!("{} re {}", short(l.name), l.reference_text)).collect();
    references.dedup();
    _ = writeln!(text, "\nlevels: {}", references.join(", "));
    if spectra.bands().iter().any(|(_, levels)| levels.iter().any(Option::is_none)) {
        text += "–: the band is narrower than two lines, or beyond the history's frequencies\n";
    }
    files.iter().for_each(|file| _ = writeln!(text, "{}", file.display()));
    text
}

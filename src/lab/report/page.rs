//! Pages of a report in Markdown: where and when it was made, and a table a case.

use std::time::Duration;

use super::{Case, Claim};

/// What came of a case.
pub struct Finding<'a> {
    pub case: &'a Case,
    /// Claims, or why there are none.
    pub claims: std::result::Result<Vec<Claim>, String>,
    pub wall: Duration,
}

impl Finding<'_> {
    /// Whether every claim holds.
    pub fn holds(&self) -> bool {
        self.claims.as_ref().is_ok_and(|c| !c.is_empty() && c.iter().all(Claim::holds))
    }

    fn counts(&self) -> String {
        match &self.claims {
            Ok(claims) => {
                format!("{} of {}", claims.iter().filter(|c| c.holds()).count(), claims.len())
            }
            Err(_) => "failed".into(),
        }
    }
}

/// A table in Markdown.
pub fn table(head: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let head: Vec<String> = head.iter().map(|h| h.to_string()).collect();
    let rule = vec!["---".to_string(); head.len()];
    let mut text = line(&head) + &line(&rule);
    // A bar would end the cell.
    let escaped = |row: Vec<String>| row.into_iter().map(|c| c.replace('|', "\\|")).collect::<Vec<_>>();
    rows.into_iter().for_each(|row| text += &line(&escaped(row)));
    text
}

/// The machine, the program and the command that made a page.
pub fn provenance(command: &str) -> String {
    let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
    let build = if cfg!(debug_assertions) { "with debug assertions" } else { "release" };
    format!(
        "Made by `{command}`, hexroll {} ({build}), {}, {cores} cores, {:?} lanes.\n",
        env!("CARGO_PKG_VERSION"),
        processor(),
        hexroll::physics::lanes::Level::detect(),
    )
}

/// The processor's own name, where the system tells it.
pub fn processor() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info.lines().find(|l| l.starts_with("model name")).and_then(|l| l.split(": ").nth(1));
    name.map_or_else(|| std::env::consts::ARCH.into(), str::to_string)
}

/// A page of its own: title, introduction, where it was made, and what follows.
pub fn titled(title: &str, intro: &str, command: &str, body: &str) -> String {
    format!("# {title}\n\n{intro}\n\n{}\n{body}", provenance(command))
}

/// The whole page.
pub fn page(title: &str, intro: &str, command: &str, findings: &[Finding]) -> String {
    titled(title, intro, command, &sections(findings))
}

/// A summary table, and a section a case.
pub fn sections(findings: &[Finding]) -> String {
    let summary = findings.iter().map(|f| {
        let pass = if f.holds() { "yes" } else { "**no**" };
        vec![
            format!("[{}](#{})", f.case.title, f.case.name.replace('_', "-")),
            f.counts(),
            pass.into(),
            if f.case.everyday { "every day" } else { "`make verify`" }.into(),
            format!("{:.1} s", f.wall.as_secs_f64()),
        ]
    });
    let head = ["case", "claims that hold", "pass", "runs in", "took"];
    let mut text = table(&head, summary);
    findings.iter().for_each(|f| text += &section(f));
    text
}

fn section(finding: &Finding) -> String {
    let case = finding.case;
    let anchor = case.name.replace('_', "-");
    let mut text = format!(
        "\n<a name=\"{anchor}\"></a>\n## {}\n\nSource: {}.\n\nBody and loads: {}.\n\n",
        case.title, case.source, case.setup
    );
    match &finding.claims {
        Err(error) => text += &format!("The case did not run: {error}\n"),
        Ok(claims) => {
            let rows = claims.iter().map(|c| [&c.cells()[..], &[c.reason.to_string()]].concat());
            let head = ["claim", "expected", "got", "error", "tolerance", "pass", "reason of the tolerance"];
            text += &table(&head, rows);
        }
    }
    text
}

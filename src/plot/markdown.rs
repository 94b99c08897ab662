//! Markdown as this program writes it (headings, paragraphs, tables, bold, code), as HTML.

use super::page::table;
use super::svg::escaped;

/// Pictures are left out: a page has its own.
pub(super) fn html(text: &str) -> String {
    let mut out = String::new();
    let lines: Vec<&str> = text.lines().collect();
    let mut at = 0;
    while at < lines.len() {
        let line = lines[at].trim();
        let block = |same: fn(&str) -> bool| lines[at..].iter().take_while(|l| same(l.trim())).count();
        if line.is_empty() || line.starts_with("![") {
            at += 1;
        } else if let Some((level, title)) = heading(line) {
            out += &format!("<h{level}>{}</h{level}>\n", inline(title));
            at += 1;
        } else if line.starts_with('|') {
            let rows = block(|l| l.starts_with('|'));
            out += &of_table(&lines[at..at + rows]);
            at += rows;
        } else {
            let rows = block(|l| !l.is_empty() && !l.starts_with(['|', '#', '!']));
            out += &format!("<p>{}</p>\n", inline(&lines[at..at + rows].join(" ")));
            at += rows.max(1);
        }
    }
    out
}

/// Level and text of a heading; the page's own title is the only one of level 1.
fn heading(line: &str) -> Option<(usize, &str)> {
    let level = line.bytes().take_while(|b| *b == b'#').count();
    (level > 0).then(|| (level.max(2), line[level..].trim()))
}

fn of_table(lines: &[&str]) -> String {
    let cells = |line: &&str| -> Vec<String> {
        line.trim().trim_matches('|').split('|').map(|cell| inline(cell.trim())).collect()
    };
    let rule = |line: &&&str| !line.contains("---");
    let mut rows = lines.iter().filter(rule).map(cells);
    let head = rows.next().unwrap_or_default();
    table(head.into_iter(), rows.map(Vec::into_iter))
}

/// `**bold**` and `` `code` ``.
fn inline(text: &str) -> String {
    let alternate = |text: &str, mark: &str, tag: &str| -> String {
        let parts = text.split(mark).enumerate();
        parts
            .map(|(i, part)| if i % 2 == 1 { format!("<{tag}>{part}</{tag}>") } else { part.into() })
            .collect()
    };
    alternate(&alternate(&escaped(text), "**", "b"), "`", "code")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_reports_are_made_of_becomes_html() {
        let text = "# Study\n\n`hexroll study a.toml`, version 1.\n\n## wheel\n\n| a | F [N] |\n|---|---|\n| x | 1.5 |\n\n![p](p.png)\n\nlast\nline\n";
        let found = html(text);
        assert!(
            found.contains("<h2>Study</h2>") && found.contains("<code>hexroll study a.toml</code>"),
            "{found}"
        );
        assert!(found.contains("<th class=\"number\">F [N]</th>") && found.contains("<td>x</td>"), "{found}");
        assert!(found.contains("<p>last line</p>") && !found.contains("p.png"), "{found}");
    }
}

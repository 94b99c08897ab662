//! A page of HTML in one file: style, pictures and plots are in it, nothing is loaded, and no script runs.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::svg::{self, Event, escaped};
use super::{Panel, markdown};

const STYLE: &str = include_str!("page.css");

/// Browsers are told to load nothing, whatever the texts of a scene say.
const POLICY: &str = "default-src 'none'; img-src data:; style-src 'unsafe-inline'";

/// A page that is being written, from top to bottom.
#[derive(Debug, Clone)]
pub struct Page {
    title: String,
    body: String,
}

/// How a word or a note is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mood {
    Good,
    Care,
    Bad,
}

impl Mood {
    fn class(self) -> &'static str {
        match self {
            Mood::Good => "good",
            Mood::Care => "care",
            Mood::Bad => "bad",
        }
    }
}

impl Page {
    /// A page with this title, and a state in a word or two beside it.
    pub fn new(title: &str, state: Option<(Mood, &str)>) -> Page {
        let mut body = format!("<h1>{}</h1>\n", escaped(title));
        if let Some((mood, word)) = state {
            _ = writeln!(body, "<p><span class=\"state {}\">{}</span></p>", mood.class(), escaped(word));
        }
        Page { title: title.into(), body }
    }

    /// What another page says below its title.
    pub fn append(&mut self, other: Page) {
        let below = other.body.split_once("</h1>\n").map_or("", |(_, below)| below);
        self.body += below;
    }

    /// A heading of a section.
    pub fn section(&mut self, title: &str) {
        _ = writeln!(self.body, "<h2>{}</h2>", escaped(title));
    }

    /// A heading within a section.
    pub fn part(&mut self, title: &str) {
        _ = writeln!(self.body, "<h3>{}</h3>", escaped(title));
    }

    pub fn paragraph(&mut self, text: &str) {
        _ = writeln!(self.body, "<p>{}</p>", escaped(text));
    }

    /// A paragraph of less weight.
    pub fn remark(&mut self, text: &str) {
        _ = writeln!(self.body, "<p class=\"soft\">{}</p>", escaped(text));
    }

    /// A note that must not be missed.
    pub fn note(&mut self, mood: Mood, text: &str) {
        _ = writeln!(self.body, "<div class=\"note {}\">{}</div>", mood.class(), escaped(text));
    }

    /// Names and what they are, a row each.
    pub fn facts<N: AsRef<str>, V: AsRef<str>>(&mut self, rows: impl IntoIterator<Item = (N, V)>) {
        self.body += "<div class=\"wide\"><table>\n";
        for (name, value) in rows {
            let [name, value] = [name.as_ref(), value.as_ref()].map(escaped);
            _ = writeln!(self.body, "<tr><th>{name}</th><td>{value}</td></tr>");
        }
        self.body += "</table></div>\n";
    }

    /// A table: cells that begin with a digit or a sign stand to the right.
    pub fn table(&mut self, head: &[&str], rows: &[Vec<String>]) {
        self.body +=
            &table(head.iter().map(|h| escaped(h)), rows.iter().map(|r| r.iter().map(|c| escaped(c))));
    }

    /// Text as it stands, in a fixed-width font.
    pub fn listing(&mut self, text: &str) {
        _ = writeln!(self.body, "<pre>{}</pre>", escaped(text));
    }

    /// The same, shown on demand.
    pub fn folded(&mut self, title: &str, text: &str) {
        let (title, text) = (escaped(title), escaped(text));
        _ = writeln!(self.body, "<details><summary>{title}</summary><pre>{text}</pre></details>");
    }

    /// Plots side by side as far as the window has room.
    pub fn plots(&mut self, panels: &[Panel], events: &[Event]) {
        self.body += "<div class=\"plots\">\n";
        for panel in panels {
            _ = writeln!(self.body, "<figure>{}</figure>", svg::panel(panel, events));
        }
        self.body += "</div>\n";
    }

    /// PNG files side by side, each with its caption.
    pub fn pictures<'a>(&mut self, pictures: impl IntoIterator<Item = (&'a [u8], &'a str)>) {
        self.body += "<div class=\"pictures\">\n";
        for (png, caption) in pictures {
            let (data, caption) = (STANDARD.encode(png), escaped(caption));
            _ = writeln!(
                self.body,
                "<figure><img alt=\"{caption}\" src=\"data:image/png;base64,{data}\"/><figcaption>{caption}</figcaption></figure>"
            );
        }
        self.body += "</div>\n";
    }

    /// Markdown as this program writes it; its pictures are left out.
    pub fn markdown(&mut self, text: &str) {
        self.body += &markdown::html(text);
    }

    /// The whole file.
    pub fn html(&self) -> String {
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\"/>\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
             <title>{}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
            escaped(&self.title),
            self.body
        )
    }
}

/// A table of cells that are HTML already.
pub(super) fn table<R: Iterator<Item = String>>(
    head: impl Iterator<Item = String>,
    rows: impl Iterator<Item = R>,
) -> String {
    let rows: Vec<Vec<String>> = rows.map(Iterator::collect).collect();
    // A column's head stands where its first cell does.
    let right = |column: usize| {
        rows.iter().filter_map(|r| r.get(column)).find(|c| *c != "–").is_some_and(|c| is_number(c))
    };
    let class = |right: bool| if right { " class=\"number\"" } else { "" };
    let mut text = String::from("<div class=\"wide\"><table>\n<tr>");
    for (column, cell) in head.enumerate() {
        _ = write!(text, "<th{}>{cell}</th>", class(right(column)));
    }
    text += "</tr>\n";
    for row in &rows {
        text += "<tr>";
        for (column, cell) in row.iter().enumerate() {
            _ = write!(text, "<td{}>{cell}</td>", class(is_number(cell) || (cell == "–" && right(column))));
        }
        text += "</tr>\n";
    }
    text + "</table></div>\n"
}

fn is_number(cell: &str) -> bool {
    let digits = cell.trim_start_matches(['-', '+']);
    digits.starts_with(|c: char| c.is_ascii_digit())
        && !digits.contains(|c: char| c.is_ascii_alphabetic() && c != 'e')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_one_well_formed_file_that_asks_for_nothing() {
        let mut page = Page::new("a <wheel> & \"more\"", Some((Mood::Good, "finished")));
        page.section("numbers");
        page.facts([("engine", "cpu <f64>")]);
        page.table(&["name", "value"], &[vec!["x".into(), "-1.5".into()], vec!["y".into(), "–".into()]]);
        page.note(Mood::Bad, "<script>alert(1)</script>");
        page.pictures([(&[0x89, b'P', b'N', b'G'][..], "a picture")]);
        page.folded("scene", "a = 1\nb = \"</pre>\"");
        page.markdown("## Head\n\n| a | b |\n|---|---|\n| 1 | **x** |\n");
        let html = page.html();
        let document = roxmltree::Document::parse(html.strip_prefix("<!DOCTYPE html>\n").unwrap()).unwrap();
        assert_eq!(document.descendants().filter(|n| n.has_tag_name("script")).count(), 0);
        let loads = document
            .descendants()
            .flat_map(|n| n.attributes())
            .filter(|a| matches!(a.name(), "src" | "href" | "srcset") && !a.value().starts_with("data:"));
        assert_eq!(loads.count(), 0);
        assert!(html.contains("data:image/png;base64,iVBORw=="), "the bytes of the picture are in it");
        assert!(
            html.contains("<td class=\"number\">-1.5</td>") && html.contains("<td class=\"number\">–</td>")
        );
        assert!(html.contains("<b>x</b>"));
    }
}

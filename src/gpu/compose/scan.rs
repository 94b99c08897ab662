//! WGSL at module scope: what a text declares, and which names each declaration uses that it does not declare itself.
//!
//! A scanner, not a parser: it knows comments, names, numbers and brackets. What it cannot see (a local variable that
//! hides a name of the module below a use of that name) makes naga complain about a missing name, never a wrong program.

use std::collections::BTreeSet;

/// A declaration at module scope.
#[derive(Debug, Clone, PartialEq)]
pub struct Declaration {
    pub name: String,
    /// From the comments right above it to its end.
    pub text: String,
    /// Names it uses and does not declare.
    pub needs: BTreeSet<String>,
    /// Whether the host binds something to it: a storage or uniform variable.
    pub buffer: bool,
}

/// What a text says before its first declaration, and what it declares; `Err`: where it cannot be read.
pub fn scan(text: &str) -> Result<(&str, Vec<Declaration>), String> {
    let tokens = tokens(text);
    let mut declarations = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let end = end_of(&tokens, at).ok_or_else(|| {
            format!("the declaration that begins with `{}` has no end", first_line(&text[tokens[at].start..]))
        })?;
        let all = &tokens[at..=end];
        let start = comments_above(text, all[0].start);
        let body = &text[start..tokens[end].end()];
        declarations.push(
            declaration(all, body)
                .ok_or_else(|| format!("`{}` declares nothing", first_line(&text[all[0].start..])))?,
        );
        at = end + 1;
    }
    let first = tokens.first().map_or(text.len(), |t| comments_above(text, t.start));
    Ok((text[..first].trim(), declarations))
}

fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}

#[derive(Debug, Clone, Copy)]
struct Token<'t> {
    text: &'t str,
    start: usize,
}

impl Token<'_> {
    fn end(&self) -> usize {
        self.start + self.text.len()
    }

    fn is_name(&self) -> bool {
        self.text.starts_with(|c: char| c.is_alphabetic() || c == '_')
    }
}

/// Names, numbers and single characters; comments are left out.
fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut all = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |n| n + 2)
        } else if c.is_alphanumeric() || c == '_' {
            // The point of a number belongs to it, that before a member does not.
            let part =
                |c: char| c.is_alphanumeric() || c == '_' || (rest.starts_with(char::is_numeric) && c == '.');
            rest.find(|c| !part(c)).unwrap_or(rest.len())
        } else {
            c.len_utf8()
        };
        if !(c.is_whitespace() || rest.starts_with("//") || rest.starts_with("/*")) {
            all.push(Token { text: &rest[..length], start: at });
        }
        at += length;
    }
    all
}

/// The last token of the declaration that begins at `at`: a semicolon outside all brackets, or the brace that closes a body.
fn end_of(tokens: &[Token], at: usize) -> Option<usize> {
    let mut depth = 0;
    for (k, token) in tokens.iter().enumerate().skip(at) {
        match token.text {
            "{" | "(" | "[" => depth += 1,
            ")" | "]" => depth -= 1,
            "}" => {
                depth -= 1;
                if depth == 0 {
                    // A struct may have one behind it.
                    let semicolon = tokens.get(k + 1).is_some_and(|t| t.text == ";");
                    return Some(k + usize::from(semicolon));
                }
            }
            ";" if depth == 0 => return Some(k),
            _ => {}
        }
    }
    None
}

/// Where the comments begin that stand on what begins at `start`, with no empty line between.
fn comments_above(text: &str, start: usize) -> usize {
    let mut first = text[..start].rfind('\n').map_or(0, |n| n + 1);
    while first > 0 {
        let above = text[..first - 1].rfind('\n').map_or(0, |n| n + 1);
        if !text[above..first].trim_start().starts_with("//") {
            break;
        }
        first = above;
    }
    first
}

fn declaration(tokens: &[Token], text: &str) -> Option<Declaration> {
    let kinds = ["fn", "struct", "alias", "const", "override", "var"];
    let at = tokens.iter().position(|t| kinds.contains(&t.text))?;
    let name_at = after_template(tokens, at + 1);
    let name = tokens.get(name_at).filter(|t| t.is_name())?.text.to_string();
    let space = tokens[at + 1..name_at].get(1).map(|t| t.text);
    let mut needs = BTreeSet::new();
    let mut own = BTreeSet::from([name.as_str()]);
    for k in 0..tokens.len() {
        match role(tokens, k) {
            Role::Use => drop(needs.insert(tokens[k].text)),
            Role::Declares => drop(own.insert(tokens[k].text)),
            Role::Neither => {}
        }
    }
    let needs = needs.difference(&own).map(|n| n.to_string()).collect();
    let buffer = tokens[at].text == "var" && matches!(space, Some("storage" | "uniform"));
    Some(Declaration { name, text: text.into(), needs, buffer })
}

/// Behind the `<...>` that begins at `at`, if one does.
fn after_template(tokens: &[Token], at: usize) -> usize {
    if tokens.get(at).is_none_or(|t| t.text != "<") {
        return at;
    }
    let close = tokens[at..].iter().position(|t| t.text == ">");
    close.map_or(at, |n| at + n + 1)
}

enum Role {
    Use,
    Declares,
    Neither,
}

/// What a token is to the declaration it stands in.
fn role(tokens: &[Token], k: usize) -> Role {
    let text = |k: Option<usize>| k.and_then(|k| tokens.get(k)).map_or("", |t| t.text);
    let (before, after) = (text(k.checked_sub(1)), text(Some(k + 1)));
    let built_in = before == "(" && text(k.checked_sub(2)) == "builtin";
    if !tokens[k].is_name() || before == "." || before == "@" || built_in {
        return Role::Neither;
    }
    // Of a variable with an address space: var<workgroup> name.
    let behind_space = before == ">" && {
        let open = tokens[..k].iter().rposition(|t| t.text == "<");
        text(open.and_then(|n| n.checked_sub(1))) == "var"
    };
    let declared = ["let", "var", "const"].contains(&before) || behind_space;
    // Members, parameters and variables with a type; but not what a case is about.
    let typed = after == ":" && before != "case";
    if declared || typed { Role::Declares } else { Role::Use }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn needs(text: &str) -> Vec<String> {
        let (_, all) = scan(text).unwrap();
        assert_eq!(all.len(), 1, "{all:?}");
        all[0].needs.iter().cloned().collect()
    }

    #[test]
    fn every_kind_of_declaration_is_found_with_its_name() {
        let text = "// Of the file.\n\n// Of a.\nstruct a { x: u32 };\nalias b = a;\nconst c: u32 = 0x1fu;\n\noverride d: f32;\n\
                    var<workgroup> e: array<f32, 64>;\nvar<storage, read_write> f: array<f32>;\nvar<uniform> g: a;\n\
                    @compute @workgroup_size(64)\nfn h() {\n    if c > 1u { f[0] = 1.5e-3; }\n}\n";
        let (head, all) = scan(text).unwrap();
        let names: Vec<&str> = all.iter().map(|d| d.name.as_str()).collect();
        assert_eq!(names, ["a", "b", "c", "d", "e", "f", "g", "h"]);
        assert_eq!(head, "// Of the file.");
        assert!(all[0].text.starts_with("// Of a.\n") && all[0].text.ends_with("};"), "{:?}", all[0].text);
        let buffers: Vec<&str> = all.iter().filter(|d| d.buffer).map(|d| d.name.as_str()).collect();
        assert_eq!(buffers, ["f", "g"]);
    }

    #[test]
    fn a_use_is_told_from_members_parameters_and_local_variables() {
        let text = "fn f(a: Node, @builtin(local_invocation_index) lane: u32) -> Moved {
            // not_a_use(1)
            let b = g(a.mass) + limit;
            var held: array<real, 4>;
            for (var k = 0u; k < 4u; k++) { held[k] = b.xyz; }
            switch lane { case FIRST: { return h(held); } default: { return Moved(); } }
        }";
        let found = needs(text);
        for name in ["Node", "Moved", "g", "limit", "h", "FIRST", "real"] {
            assert!(found.contains(&name.to_string()), "{name} is missing in {found:?}");
        }
        for name in ["a", "b", "held", "k", "mass", "xyz", "lane", "not_a_use", "local_invocation_index", "f"]
        {
            assert!(!found.contains(&name.to_string()), "{name} is no need, in {found:?}");
        }
    }

    #[test]
    fn the_size_of_a_work_group_is_a_need() {
        assert!(needs("@compute @workgroup_size(threads)\nfn main() {}").contains(&"threads".to_string()));
    }

    #[test]
    fn what_cannot_be_read_is_an_error() {
        assert!(scan("fn f() {").unwrap_err().contains("fn f() {"));
        assert!(scan("x;").unwrap_err().contains("declares nothing"));
    }
}

//! One line of a golden file: a kind, a name, then word–value pairs, two blanks apart.

use super::quotes::{end_of_quote, label, quoted, unquoted};
use super::values::Value;
use super::words::{self, Field, is_code, kind_of};

/// A line of a body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Line {
    /// Its first word: a kind of [`words::KINDS`] or the code of a diagnostic.
    pub kind: String,
    /// What it speaks of; of a diagnostic the message; empty where there is nothing to name.
    pub name: String,
    /// It has no name: what stands there is how the script says it, and it is known by its values.
    pub unnamed: bool,
    /// Words and values in the order of the table.
    pub pairs: Vec<(&'static str, Value)>,
}

/// Significant digits with which rounding stays below the tolerance.
fn digits(tolerance: f64) -> usize {
    const MOST: usize = 17;
    (1..MOST).find(|n| format!("1e-{}", n - 1).parse::<f64>().is_ok_and(|step| step <= tolerance)).unwrap_or(MOST)
}

impl Line {
    /// Whether it is a diagnostic.
    pub fn is_diagnostic(&self) -> bool {
        is_code(&self.kind)
    }

    /// The value behind a word.
    pub fn get(&self, word: &str) -> Option<&Value> {
        self.pairs.iter().find(|pair| pair.0 == word).map(|pair| &pair.1)
    }

    /// The line as written where this relative tolerance holds.
    pub fn text(&self, tolerance: f64) -> String {
        let digits = digits(tolerance);
        let mut out = self.kind.clone();
        if self.is_diagnostic() {
            out.push(' ');
            out.push_str(&self.name);
        } else if kind_of(&self.kind).is_some_and(|kind| kind.named) {
            let name = match self.kind.as_str() {
                _ if self.unnamed => format!("`{}`", self.name.replace('`', "'")),
                "check" => quoted(&self.name),
                _ => label(&self.name),
            };
            out.push(' ');
            out.push_str(&name);
        }
        for Field { word, kind } in words::fields_of(&self.kind) {
            let Some(value) = self.get(word) else { continue };
            let blank = if word.is_empty() { "" } else { " " };
            out.push_str(&format!("  {word}{blank}{}", value.text(*kind, digits)));
        }
        out
    }
}

/// Reads a line without its comment; the error is a sentence.
pub fn parse_line(content: &str) -> Result<Line, String> {
    let fields = if is_code(content.split_whitespace().next().unwrap_or("")) { parts_of_message(content) } else { parts(content) };
    let mut fields = fields.into_iter();
    let head = fields.next().unwrap_or("");
    let (kind, name) = head.split_once(char::is_whitespace).map_or((head, ""), |(kind, name)| (kind, name.trim()));
    let mut line = Line { kind: kind.to_owned(), ..Line::default() };
    line.name = name_of(kind, name)?;
    line.unnamed = !line.is_diagnostic() && name.starts_with('`');
    for part in fields {
        let (field, value) = pair(kind, part)?;
        if line.get(field.word).is_some() {
            return Err(format!("`{}` is given twice", if field.word.is_empty() { part } else { field.word }));
        }
        line.pairs.push((field.word, value));
    }
    Ok(line)
}

fn name_of(kind: &str, name: &str) -> Result<String, String> {
    if is_code(kind) {
        return if name.is_empty() { Err(format!("expected the message of {kind}")) } else { Ok(name.to_owned()) };
    }
    let named = kind_of(kind).is_some_and(|k| k.named);
    match (named, name.is_empty()) {
        (false, false) => Err(format!("`{kind}` has no name: put two blanks before each of its words")),
        (true, true) => Err(format!("expected the name of the {kind}")),
        (_, true) => Ok(String::new()),
        _ if name.starts_with('`') => match name[1..].strip_suffix('`') {
            Some(inside) if !inside.is_empty() => Ok(inside.to_owned()),
            _ => Err(format!("expected the {kind} between backquotes, then two blanks")),
        },
        _ if name.starts_with('"') => {
            unquoted(name).map_err(|_| format!("expected the name of the {kind} between quotes, then two blanks"))
        }
        _ if name.contains(char::is_whitespace) => {
            Err(format!("`{name}` is not a name: put two blanks before each word, or the name between quotes"))
        }
        _ => Ok(name.to_owned()),
    }
}

fn pair(kind: &str, part: &str) -> Result<(Field, Value), String> {
    let fields = words::fields_of(kind);
    let (word, text) = part.split_once(char::is_whitespace).map_or((part, ""), |(word, text)| (word, text.trim()));
    let alone = fields.clone().find(|f| f.word.is_empty());
    if let (Some(field), "pass" | "fail") = (alone, part) {
        return Ok((*field, Value::parse(field.kind, part)?));
    }
    let Some(field) = fields.clone().find(|f| f.word == word && !word.is_empty()) else {
        if alone.is_some() {
            return Err(format!("a {kind} says `pass` or `fail`, got `{part}`"));
        }
        let known: Vec<&str> = fields.map(|f| f.word).collect();
        return Err(format!("`{word}` is not a word of a {kind} line; its words are {}", known.join(", ")));
    };
    match Value::parse(field.kind, text) {
        Ok(value) => Ok((*field, value)),
        Err(wanted) => Err(format!("`{word}` needs {wanted}, got `{text}`; words are two blanks apart")),
    }
}

/// Parts two blanks apart; quotes hold what is inside together.
fn parts(content: &str) -> Vec<&str> {
    let (mut found, mut start, mut at) = (Vec::new(), 0, 0);
    while at < content.len() {
        let rest = &content[at..];
        if rest.starts_with('"') && (at == 0 || content[..at].ends_with(' ')) {
            at += end_of_quote(rest).unwrap_or(rest.len());
        } else if rest.starts_with('`') && content[..at].ends_with(' ') {
            at += rest[1..].find('`').map_or(rest.len(), |end| end + 2);
        } else if rest.starts_with("  ") || rest.starts_with('\t') {
            found.push(content[start..at].trim());
            at = content.len() - rest.trim_start().len();
            start = at;
        } else {
            at += rest.chars().next().map_or(1, char::len_utf8);
        }
    }
    found.push(content[start..].trim());
    found.retain(|part| !part.is_empty());
    found
}

/// Parts of a diagnostic, whose message and source hold no two blanks.
fn parts_of_message(content: &str) -> Vec<&str> {
    content.split("  ").map(str::trim).filter(|part| !part.is_empty()).collect()
}

/// A text on one line with single blanks, as messages and stretches of source stand in a golden file.
pub fn on_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str) {
        let line = parse_line(text).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!(line.text(1e-12), text);
    }

    #[test]
    fn lines_of_the_grammar_read_back() {
        check("network  curves 4  links 4  nodes 4  modeling 4");
        check("surface roof  kind coons  flow quadrilateral  patches 1  edges 4  vertices 4  area 9.424777961 m2");
        check("mesh fine  nodes 63  triangles 96  quads 0  min_angle 38.2 deg  groups supports:12  hash 9c1f");
        check("check \"no slivers\"  pass");
        check("check \"a  \\\"b\\\"\"  fail");
        check("check `a.length  > 3m`  pass  left 4 m  right 3 m  within 1e-6 m");
        check("curve `line(A, \"a  b\")`  kind line  from (0, 0, 1) m  spread (1, 2, 3, 4, 5, 6) m2");
        check("W701 this rule has no effect  at `near A { size: 20mm }`");
        check("modeling \"a + b\"  length 4 m  links 2  kinks 0");
        check("E802 it lies outside  at `\"../x\"`  in parts/ribs.loft  more 3");
    }

    #[test]
    fn flaws_are_told() {
        let said = |text| parse_line(text).unwrap_err();
        assert!(said("network curves 4").contains("has no name"), "{}", said("network curves 4"));
        assert!(said("mesh fine  nodes 63 triangles 96").contains("two blanks"));
        assert!(said("mesh fine  node 63").starts_with("`node` is not a word of a mesh line"));
        assert!(said("check \"a\"  passed").contains("`pass` or `fail`"));
        assert!(said("surface roof top  area 1 m2").contains("between quotes"));
        assert_eq!(said("mesh m  nodes 1  nodes 2"), "`nodes` is given twice");
    }

    #[test]
    fn digits_follow_the_tolerance() {
        for (tolerance, n) in [(1e-9, 10), (1e-3, 4), (1e-12, 13), (0.0, 17), (1.0, 1)] {
            assert_eq!(digits(tolerance), n, "{tolerance}");
        }
    }
}

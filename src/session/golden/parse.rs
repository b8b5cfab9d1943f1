//! Reads a golden file, with a place for everything that is wrong.

use super::file::{CaseLine, Compare, Entry, Flaw, Golden, Head, Producer, Section, VERSION};
use super::line::parse_line;
use super::quotes::{end_of_quote, unquoted};
use super::words::{is_code, kind_of};

impl Golden {
    /// Reads a golden file. Lines of the body that make no sense are left out and reported beside it; a head that makes no
    /// sense is the error.
    pub fn parse(bytes: &[u8]) -> Result<(Self, Vec<Flaw>), Vec<Flaw>> {
        let text = std::str::from_utf8(bytes).map_err(|error| {
            let line = bytes[..error.valid_up_to()].iter().filter(|b| **b == b'\n').count() + 1;
            vec![Flaw::new(line, "this is not UTF-8 text")]
        })?;
        let lines: Vec<&str> = text.strip_prefix('\u{feff}').unwrap_or(text).lines().map(str::trim_end).collect();
        let mut reader = Reader::default();
        let body = reader.head(&lines);
        if !reader.flaws.is_empty() {
            return Err(reader.flaws);
        }
        reader.body(&lines, body);
        Ok((Self { head: reader.head, sections: reader.sections }, reader.flaws))
    }
}

/// Where the comment of a line begins: `//` outside quotes and backquotes, at its start or behind a blank.
pub(super) fn comment_at(line: &str) -> Option<usize> {
    let (mut quote, mut escaped, mut before) = (None, false, ' ');
    for (at, c) in line.char_indices() {
        match quote {
            Some('"') if escaped => escaped = false,
            Some('"') if c == '\\' => escaped = true,
            Some(open) if c == open => quote = None,
            Some(_) => {}
            None if matches!(c, '"' | '`') => quote = Some(c),
            None if c == '/' && before.is_whitespace() && line[at..].starts_with("//") => return Some(at),
            None => {}
        }
        before = c;
    }
    None
}

/// Where the comment behind a diagnostic begins: its message and source may hold anything but two blanks.
fn comment_behind_message(line: &str) -> Option<usize> {
    line.find("  //").map(|at| at + 2)
}

/// A line without its comment, and the comment.
fn split_comment(line: &str) -> (&str, Option<&str>) {
    let first = line.split_whitespace().next().unwrap_or("");
    let at = if is_code(first) { comment_behind_message(line) } else { comment_at(line) };
    at.map_or((line, None), |at| (line[..at].trim_end(), Some(&line[at..])))
}

#[derive(Default)]
struct Reader {
    head: Head,
    sections: Vec<Section>,
    flaws: Vec<Flaw>,
    /// Comments whose line has not come yet.
    above: Vec<String>,
}

const HEAD_WORDS: &[&str] = &["loft", "made", "tolerance", "compare", "case"];

impl Reader {
    fn flaw(&mut self, line: usize, what: impl Into<String>) {
        self.flaws.push(Flaw::new(line, what));
    }

    /// Reads the head; gives the index of the first line of the body.
    fn head(&mut self, lines: &[&str]) -> usize {
        let mut body = lines.len();
        let mut has_version = false;
        for (k, line) in lines.iter().enumerate() {
            let (content, _) = split_comment(line.trim_start());
            let word = content.split_whitespace().next().unwrap_or("");
            if word.is_empty() {
                continue;
            }
            if !has_version {
                self.version_line(content, k + 1);
                has_version = true;
                if !self.flaws.is_empty() {
                    return lines.len();
                }
            } else if !HEAD_WORDS.contains(&word) {
                body = k;
                break;
            } else if let Err(what) = self.head_line(word, content[word.len()..].trim(), k) {
                self.flaw(k + 1, what);
            }
        }
        if !has_version {
            self.flaw(1, format!("a golden file begins with `loft golden {VERSION}`"));
        }
        // Comments right above the body, without a blank line between, belong to it.
        let mut end = body;
        while end > 0 && end <= lines.len() && lines[end - 1].trim_start().starts_with("//") && body < lines.len() {
            end -= 1;
        }
        if end > 0 && !lines[end - 1].is_empty() {
            end = body;
        }
        self.head.raw = lines[..end].iter().map(|line| (*line).to_owned()).collect();
        while self.head.raw.last().is_some_and(String::is_empty) {
            self.head.raw.pop();
        }
        end
    }

    fn version_line(&mut self, content: &str, line: usize) {
        let words: Vec<&str> = content.split_whitespace().collect();
        match words.as_slice() {
            ["loft", "golden", version] if version.parse() == Ok(VERSION) => {}
            ["loft", "golden", version] if version.parse::<u32>().is_ok() => {
                self.flaw(line, format!("this is a golden file of version {version}, and this loft reads version {VERSION}"));
            }
            _ => self.flaw(line, format!("a golden file begins with `loft golden {VERSION}`")),
        }
    }

    fn head_line(&mut self, word: &str, rest: &str, k: usize) -> Result<(), String> {
        match word {
            "loft" => return Err("`loft golden` is given twice".to_owned()),
            "made" => {
                if self.head.made_at.replace(k).is_some() {
                    return Err("`made by` is given twice".to_owned());
                }
                self.head.made_by = Some(producer(rest).ok_or("expected `made by loft 0.1.0 mesher 1`")?);
            }
            "tolerance" => {
                let found = crate::base::text::parse_real(rest).filter(|x| x.is_finite() && *x >= 0.0);
                let found = found.ok_or("expected a number of at least 0: `tolerance 1e-9`")?;
                if self.head.tolerance.replace(found).is_some() {
                    return Err("`tolerance` is given twice".to_owned());
                }
            }
            "compare" => {
                let found = compare(rest)?;
                if self.head.compares.iter().any(|c| c.file == found.file) {
                    return Err(format!("{:?} is compared twice", found.file));
                }
                self.head.compares.push(found);
            }
            _ => {
                let found = case(rest)?;
                if self.head.cases.iter().any(|c| c.name.to_lowercase() == found.name.to_lowercase()) {
                    return Err(format!("there is a case {:?} already", found.name));
                }
                self.head.cases.push(found);
            }
        }
        Ok(())
    }

    fn body(&mut self, lines: &[&str], start: usize) {
        for (k, line) in lines.iter().enumerate().skip(start) {
            let content = line.trim_start();
            if content.is_empty() {
                continue;
            }
            if content.starts_with("//") {
                self.above.push(content.to_owned());
                continue;
            }
            let (content, comment) = split_comment(content);
            if content.starts_with('[') {
                self.section(content, comment, k + 1);
            } else if let Err(what) = self.entry(content, comment) {
                self.flaw(k + 1, what);
            }
        }
        let above = std::mem::take(&mut self.above);
        match self.sections.last_mut() {
            Some(section) => section.below = above,
            None => self.head.raw.extend(above),
        }
    }

    fn section(&mut self, content: &str, comment: Option<&str>, line: usize) {
        let Some(name) = content.strip_prefix('[').and_then(|t| t.strip_suffix(']')).map(str::trim).filter(|n| !n.is_empty()) else {
            return self.flaw(line, "expected the name of a case: `[long]`");
        };
        if self.sections.iter().any(|s| s.case.as_deref() == Some(name)) {
            self.flaw(line, format!("there is a section [{name}] already"));
        }
        let mut above = std::mem::take(&mut self.above);
        above.extend(comment.map(str::to_owned));
        self.sections.push(Section { case: Some(name.to_owned()), above, ..Section::default() });
    }

    fn entry(&mut self, content: &str, comment: Option<&str>) -> Result<(), String> {
        let word = content.split_whitespace().next().unwrap_or("");
        if HEAD_WORDS.contains(&word) {
            return Err(format!("`{word}` belongs into the head, above the first line of results"));
        }
        if !is_code(word) && kind_of(word).is_none() {
            return Err(format!("no line of a golden file begins with `{word}`"));
        }
        let line = parse_line(content)?;
        if self.sections.is_empty() {
            self.sections.push(Section::default());
        }
        let above = std::mem::take(&mut self.above);
        if let Some(section) = self.sections.last_mut() {
            section.entries.push(Entry { above, behind: comment.map(str::to_owned), line });
        }
        Ok(())
    }
}

fn producer(rest: &str) -> Option<Producer> {
    let words: Vec<&str> = rest.split_whitespace().collect();
    match words.as_slice() {
        ["by", "loft", version, "mesher", mesher] => Some(Producer { loft: (*version).to_owned(), mesher: mesher.parse().ok()? }),
        _ => None,
    }
}

fn compare(rest: &str) -> Result<Compare, String> {
    let wanted = || "expected `compare \"hall.obj\" within 1e-6mm`".to_owned();
    let end = end_of_quote(rest).filter(|_| rest.starts_with('"')).ok_or_else(wanted)?;
    let file = unquoted(&rest[..end]).map_err(|_| wanted())?;
    let amount = rest[end..].trim_start().strip_prefix("within").ok_or_else(wanted)?.trim();
    let (number, unit) = match crate::lang::values::units::LENGTHS.iter().filter(|u| amount.ends_with(u.name)).max_by_key(|u| u.name.len())
    {
        Some(unit) => (amount[..amount.len() - unit.name.len()].trim(), Some(*unit)),
        None => (amount, None),
    };
    let within = crate::base::text::parse_real(number).filter(|x| x.is_finite() && *x >= 0.0).ok_or_else(wanted)?;
    let path = std::path::Path::new(&file);
    if file.is_empty() || !path.components().all(|part| matches!(part, std::path::Component::Normal(_))) {
        return Err(format!("{file:?} does not lie in the folder of outputs"));
    }
    Ok(Compare { file, within, unit })
}

fn case(rest: &str) -> Result<CaseLine, String> {
    let wanted = || "expected `case \"long\": span = 50m, n = 4`".to_owned();
    let end = end_of_quote(rest).filter(|_| rest.starts_with('"')).ok_or_else(wanted)?;
    let name = unquoted(&rest[..end]).map_err(|_| wanted())?;
    if name != name.trim() || name.contains("//") || name.contains(['[', ']']) || !crate::session::variants::is_folder_name(&name) {
        return Err(format!("{name:?} cannot name a case: its stored files stand in a folder of that name"));
    }
    let rest = rest[end..].trim_start();
    let values = match rest.strip_prefix(':') {
        Some(values) => values.trim(),
        None if rest.is_empty() => "",
        None => return Err(wanted()),
    };
    let mut sets: Vec<(String, String)> = Vec::new();
    for part in split_values(values) {
        let (param, value) = part.split_once('=').ok_or_else(wanted)?;
        let (param, value) = (param.trim().to_owned(), value.trim().to_owned());
        if param.is_empty() || value.is_empty() {
            return Err(wanted());
        }
        if sets.iter().any(|s| s.0 == param) {
            return Err(format!("`{param}` is set twice"));
        }
        sets.push((param, value));
    }
    Ok(CaseLine { name, sets })
}

/// Parts between commas, those inside brackets and quotes aside.
fn split_values(text: &str) -> Vec<&str> {
    let (mut parts, mut start, mut depth, mut quote, mut escaped) = (Vec::new(), 0, 0_usize, false, false);
    for (at, c) in text.char_indices() {
        match c {
            _ if quote && escaped => escaped = false,
            '\\' if quote => escaped = true,
            '"' => quote = !quote,
            _ if quote => {}
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth = depth.saturating_sub(1),
            ',' if depth == 0 => {
                parts.push(&text[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    if !text[start..].trim().is_empty() || !parts.is_empty() {
        parts.push(&text[start..]);
    }
    parts
}

//! Names and phrases of a golden file, in quotes where they could be misread.

/// A name as a line's head or a group holds it: quoted where it is more than one plain word.
pub fn label(name: &str) -> String {
    let plain = !name.is_empty()
        && !name.starts_with("//")
        && !name.contains(|c: char| c.is_whitespace() || c.is_control() || "\"`:\\".contains(c));
    if plain { name.to_owned() } else { quoted(name) }
}

/// A phrase: quoted only where it could be misread.
pub fn phrase(text: &str) -> String {
    let odd =
        text.is_empty() || text != text.trim() || text.contains("  ") || text.contains("//") || text.starts_with('"') || text.contains('`');
    if odd || text.contains(char::is_control) { quoted(text) } else { text.to_owned() }
}

/// Between quotes, with `\"`, `\\` and `\u{…}` for what cannot stand there.
pub fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            '\n' => out.push_str("\\n"),
            c if c.is_control() => out.push_str(&format!("\\u{{{:x}}}", c as u32)),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// Length in bytes, closing quote included, of the quoted text at the beginning.
pub fn end_of_quote(text: &str) -> Option<usize> {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        match c {
            '"' if !escaped => return Some(at + 1),
            '\\' if !escaped => escaped = true,
            _ => escaped = false,
        }
    }
    None
}

/// The text between quotes; the error is what was expected.
pub fn unquoted(text: &str) -> Result<String, String> {
    let inside = match end_of_quote(text) {
        Some(end) if end == text.len() && end >= 2 => &text[1..end - 1],
        _ => return Err("a text between quotes".to_owned()),
    };
    let mut out = String::new();
    let mut letters = inside.chars();
    while let Some(c) = letters.next() {
        if c != '\\' {
            out.push(c);
            continue;
        }
        match letters.next() {
            Some('n') => out.push('\n'),
            Some('u') => {
                let code: String = letters.by_ref().skip_while(|c| *c == '{').take_while(|c| *c != '}').collect();
                let found = u32::from_str_radix(&code, 16).ok().and_then(char::from_u32);
                out.push(found.ok_or("`\\u{…}` with a character's number")?);
            }
            Some(c) => out.push(c),
            None => return Err("something behind `\\`".to_owned()),
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_text_survives_its_quotes() {
        for text in ["", "a", "\"", "\\", "a\nb\t\u{1b}", "지붕 // x", "`x`", "a\\u{"] {
            assert_eq!(unquoted(&quoted(text)).as_deref(), Ok(text));
        }
    }
}

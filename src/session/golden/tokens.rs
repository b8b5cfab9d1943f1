//! Texts compared token by token: numbers within a tolerance, everything else letter by letter.

use super::describe::two_numbers;

/// A piece of a line.
#[derive(Clone, Debug, PartialEq)]
enum Token<'t> {
    /// A real: with a point or an exponent.
    Real(f64),
    /// Everything else, whole numbers included; blanks and commas only separate.
    Text(&'t str),
}

impl Token<'_> {
    fn is_real(&self) -> bool {
        matches!(self, Self::Real(_))
    }

    fn number(&self) -> Option<f64> {
        match self {
            Self::Real(x) => Some(*x),
            Self::Text(text) => crate::base::text::parse_real(text).filter(|x| x.is_finite()),
        }
    }
}

/// The text of a file, when it is one.
pub fn text_of(bytes: &[u8]) -> Option<&str> {
    std::str::from_utf8(bytes).ok().filter(|text| !text.contains('\0'))
}

/// What differs, in words; `None` when nothing does. `fields` says that lines are cut into fields of 8 and 16 characters
/// where a number may touch its neighbour (Nastran).
pub fn differs(old: &str, new: &str, within: f64, fields: bool) -> Option<String> {
    let (a, b): (Vec<&str>, Vec<&str>) = (old.lines().collect(), new.lines().collect());
    let mut first = None;
    let mut count = 0;
    for (k, (x, y)) in a.iter().zip(&b).enumerate() {
        if x == y {
            continue;
        }
        if let Some(what) = line_differs(&tokens(x, fields), &tokens(y, fields), within) {
            count += 1;
            first.get_or_insert((k + 1, what));
        }
    }
    let lines = (a.len() != b.len()).then(|| format!("{} → {} lines", a.len(), b.len()));
    let differing = first.map(|(line, what)| {
        let more = if count == 1 { String::new() } else { format!(" (and {} more lines)", count - 1) };
        format!("line {line}: {what}{more}")
    });
    match (lines, differing) {
        (None, None) => None,
        (Some(text), None) | (None, Some(text)) => Some(text),
        (Some(lines), Some(text)) => Some(format!("{lines}; {text}")),
    }
}

fn line_differs(old: &[Token], new: &[Token], within: f64) -> Option<String> {
    let show = |token: Option<&Token>| match token {
        Some(Token::Real(x)) => crate::lang::values::units::number_text(*x),
        Some(Token::Text(text)) => format!("`{}`", text.chars().take(40).collect::<String>()),
        None => "nothing".to_owned(),
    };
    for k in 0..old.len().max(new.len()) {
        match (old.get(k), new.get(k)) {
            (a, b) if a == b => {}
            (a, b) => match (a.and_then(Token::number), b.and_then(Token::number)) {
                // Two whole numbers are counts or names; beside a real a whole number is one as well.
                (Some(x), Some(y)) if a.is_some_and(Token::is_real) || b.is_some_and(Token::is_real) => {
                    if (x - y).abs() > within {
                        let (x, y) = two_numbers(x, y);
                        return Some(format!("{x} → {y}"));
                    }
                }
                _ => return Some(format!("{} → {}", show(a), show(b))),
            },
        }
    }
    None
}

fn tokens(line: &str, fields: bool) -> Vec<Token<'_>> {
    if fields && !line.starts_with('$') && line.is_ascii() {
        return cut(line).into_iter().flat_map(|field| split(field).map(|word| token(word, true))).collect();
    }
    split(line).map(|word| token(word, false)).collect()
}

/// Pieces between blanks, commas and the signs of markup.
fn split(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| c.is_whitespace() || ",;=<>\"'()[]{}".contains(c)).filter(|word| !word.is_empty())
}

/// Fields of a Nastran line: 8 characters, then 8 each, or 16 each behind a name with `*`.
fn cut(line: &str) -> Vec<&str> {
    const FIELD: usize = 8;
    let (head, mut rest) = line.split_at(FIELD.min(line.len()));
    let width = if head.contains('*') { 2 * FIELD } else { FIELD };
    let mut found = vec![head];
    while !rest.is_empty() {
        let (field, after) = rest.split_at(width.min(rest.len()));
        found.push(field);
        rest = after;
    }
    found
}

/// A word as a real, when it has a point or an exponent; Nastran writes `1.5-7`.
fn token(word: &str, nastran: bool) -> Token<'_> {
    let real = |text: &str| crate::base::text::parse_real(text).filter(|x| x.is_finite());
    if word.contains(['.', 'e', 'E']) {
        if let Some(x) = real(word) {
            return Token::Real(x);
        }
        let sign = word.char_indices().skip(1).find(|(_, c)| matches!(c, '+' | '-')).map(|(at, _)| at).filter(|_| nastran);
        if let Some(x) = sign.and_then(|at| real(&format!("{}e{}", &word[..at], &word[at..]))) {
            return Token::Real(x);
        }
    }
    Token::Text(word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_a_tolerance_and_words_none() {
        let check = |old, new, fields, expected: Option<&str>| assert_eq!(differs(old, new, 1e-6, fields).as_deref(), expected);
        check("*NODE\n1, 0.5, 2.0", "*NODE\n1,  0.5000001, 2.0", false, None);
        check("*NODE\n1, 0.5, 2.0", "*NODE\n1, 0.50001, 2.0", false, Some("line 2: 0.50000 → 0.50001"));
        check("0.5, 0, 2", "0.5, -1e-16, 2", false, None);
        check("1, 2, 3", "1, 2, 4", false, Some("line 1: `3` → `4`"));
        check("a\nb", "a\nb\nc", false, Some("2 → 3 lines"));
        check("a 1.0\nb 1.0", "a 2.0\nb 2.0", false, Some("line 1: 1 → 2 (and 1 more lines)"));
        check("<DataArray>0.5 1.5</DataArray>", "<DataArray>0.5000001 1.5</DataArray>", false, None);
    }

    #[test]
    fn fields_that_touch_are_two() {
        let old = "GRID*                  1                .1234567890123451.23456789012345";
        let new = "GRID*                  1                .1234567890123461.23456789012346";
        assert_eq!(differs(old, new, 1e-6, true), None);
        assert_eq!(differs("GRID           1          1.5-7", "GRID           1          1.6-7", 1e-6, true), None);
        assert!(differs("GRID           1          1.5-3", "GRID           1          1.6-3", 1e-6, true).is_some());
    }
}

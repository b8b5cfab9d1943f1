//! Stretches of a script as a golden quotes them: its tokens, with a blank where the script has blanks or a comment.

use std::borrow::Cow;

use crate::lang::syntax::token_spans;

/// Tokens at each end of a quoted stretch; of a longer one the middle is left out.
const TOKENS: usize = 16;
/// What stands for the middle.
const CUT: char = '…';

/// The tokens of a stretch, numbers in their shortest spelling; what is no text of the language falls apart in some way that is always the
/// same.
pub fn tokens(text: &str) -> Vec<Cow<'_, str>> {
    let inside = |part| token_spans(part).into_iter().filter_map(move |span| slice(part, span.start, span.end));
    // Where the middle was left out the quotation is two stretches.
    let mut found = Vec::new();
    for (k, part) in text.split(CUT).enumerate() {
        found.extend((k > 0).then_some(Cow::Borrowed("…")));
        found.extend(inside(part).map(shortest));
    }
    found
}

/// A number with its unit as it is written with the fewest digits; any other token as it is.
fn shortest(token: &str) -> Cow<'_, str> {
    if !token.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
        return Cow::Borrowed(token);
    }
    let ends = token.char_indices().map(|(at, c)| at + c.len_utf8()).rev();
    let number = ends.into_iter().find_map(|end| Some((token[..end].parse::<f64>().ok()?, end)));
    number.map_or(Cow::Borrowed(token), |(value, end)| Cow::Owned(format!("{value:?}{}", &token[end..])))
}

/// Whether a token is a name of the script.
pub fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

fn slice(text: &str, start: u32, end: u32) -> Option<&str> {
    text.get(start as usize..end as usize).map(str::trim).filter(|token| !token.is_empty())
}

/// A stretch of source on one line, without comments.
pub fn on_one_line(text: &str) -> String {
    let (mut out, mut end, mut cut) = (String::new(), 0, false);
    let spans = token_spans(text);
    for (k, span) in spans.iter().enumerate() {
        if k >= TOKENS && k + TOKENS < spans.len() {
            cut = true;
            continue;
        }
        if cut {
            out.push(CUT);
            cut = false;
        } else if k > 0 && span.start > end {
            out.push(' ');
        }
        out.push_str(&slice(text, span.start, span.end).unwrap_or("").split_whitespace().collect::<Vec<_>>().join(" "));
        end = span.end;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layout_and_comments_are_no_part_of_it() {
        let one = on_one_line("line((0,0,0), // from\n  (1, 0, 0))");
        assert_eq!(one, "line((0,0,0), (1, 0, 0))");
        assert_eq!(tokens(&one), tokens("line((0, 0, 0), (1,0,0))"));
        assert_ne!(tokens(&one), tokens("line((0, 0, 0), (2,0,0))"));
        assert_eq!(tokens("\"a  b\""), tokens("\"a  b\" // c"));
        assert_eq!(tokens("x == 0.001 + 20mm"), tokens("x == 0.00100 + 2e1mm"));
        assert_ne!(tokens("20mm"), tokens("20m"));
    }

    #[test]
    fn long_stretches_are_cut_between_tokens() {
        let long = |gap: &str| (0..60).map(|k| format!("a{k}")).collect::<Vec<_>>().join(&format!(",{gap}"));
        let (one, other) = (on_one_line(&long("")), on_one_line(&long("  ")));
        assert!(one.contains('…') && one.starts_with("a0,a1") && one.ends_with("a58,a59"), "{one}");
        assert_eq!(tokens(&one), tokens(&other));
    }
}

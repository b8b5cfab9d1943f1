//! Text on its way to people: nothing in it steers the terminal but the colours that this program writes.

use std::borrow::Cow;

/// Whether a character steers a terminal or turns the order of what stands around it. Line ends and tabs do as well.
#[must_use]
pub fn steers(c: char) -> bool {
    c.is_control() || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// A text as it is shown to people: what steers a terminal stands there as `\u{1b}`; line ends and tabs stay.
pub fn visible(text: &str) -> Cow<'_, str> {
    let stays = |c: char, next: Option<char>| !steers(c) || matches!(c, '\n' | '\t') || c == '\r' && next == Some('\n');
    let next_of = |at: usize, c: char| text[at + c.len_utf8()..].chars().next();
    if text.char_indices().all(|(at, c)| stays(c, next_of(at, c))) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    for (at, c) in text.char_indices() {
        if stays(c, next_of(at, c)) { out.push(c) } else { out.extend(c.escape_unicode()) }
    }
    Cow::Owned(out)
}

/// A text in a colour of `COLORS`, or as it is; what steers a terminal is made visible in it.
pub fn colored(text: &str, code: &str, color: bool) -> String {
    let text = visible(text);
    if color { format!("\u{1b}[{code}m{text}\u{1b}[0m") } else { text.into_owned() }
}

/// Codes of the colours that this program writes, and the code that ends one.
const COLORS: [&str; 9] = ["0", "1;31", "1;33", "1;36", "2", "31", "32", "33", "36"];

/// A text as it is shown to people, its colours kept: [`visible`] but for the sequences of [`colored`].
pub fn visible_beside_colors(text: &str) -> Cow<'_, str> {
    if !text.contains('\u{1b}') {
        return visible(text);
    }
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find("\u{1b}[") {
        let (before, sequence) = rest.split_at(at);
        out.push_str(&visible(before));
        let code = COLORS.iter().map(|code| format!("\u{1b}[{code}m")).find(|code| sequence.starts_with(code.as_str()));
        let length = code.as_ref().map_or(1, String::len);
        out.push_str(&code.unwrap_or_else(|| '\u{1b}'.escape_unicode().to_string()));
        rest = &sequence[length..];
    }
    out.push_str(&visible(rest));
    Cow::Owned(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_a_terminal_is_shown() {
        for (text, shown) in [
            ("a\tb\r\n지붕 é 😀", "a\tb\r\n지붕 é 😀"),
            ("\u{1b}]0;x\u{7}\r", "\\u{1b}]0;x\\u{7}\\u{d}"),
            ("\u{9b}2J\u{7f}\u{202e}\u{2066}", "\\u{9b}2J\\u{7f}\\u{202e}\\u{2066}"),
        ] {
            assert_eq!(visible(text), shown);
            assert_eq!(visible_beside_colors(text), shown);
            assert_eq!(visible(&visible(text)), shown);
        }
    }

    #[test]
    fn colours_of_this_program_stay() {
        let red = colored("a\u{1b}[31mb", "1;31", true);
        assert_eq!(red, "\u{1b}[1;31ma\\u{1b}[31mb\u{1b}[0m");
        assert_eq!(visible_beside_colors(&red), red);
        assert_eq!(visible_beside_colors("\u{1b}[8mx\u{1b}[2J\u{1b}"), "\\u{1b}[8mx\\u{1b}[2J\\u{1b}");
        assert_eq!(colored("a", "31", false), "a");
    }
}

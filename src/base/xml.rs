//! Text in XML: the one place that knows what must be written otherwise there.

use std::borrow::Cow;

/// Text that XML holds in elements and attributes; what XML cannot hold at all, and other control characters, become `U+FFFD`.
///
/// Line ends and tabs are written as references, so that they also survive in attributes.
pub fn escaped(text: &str) -> Cow<'_, str> {
    if !text.chars().any(|c| matches!(c, '&' | '<' | '>' | '"' | '\u{fffe}' | '\u{ffff}') || c.is_control()) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' => out.push_str("&#10;"),
            '\r' => out.push_str("&#13;"),
            '\t' => out.push_str("&#9;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    Cow::Owned(out)
}

#[cfg(test)]
mod tests {
    use super::escaped;

    #[test]
    fn text_is_made_fit_for_xml() {
        let pairs = [
            ("지붕 a-b", "지붕 a-b"),
            ("a<b & \"c\">", "a&lt;b &amp; &quot;c&quot;&gt;"),
            ("\u{1b}[1m\n\t\r", "\u{fffd}[1m&#10;&#9;&#13;"),
        ];
        for (plain, fit) in pairs {
            assert_eq!(escaped(plain), fit);
        }
    }
}

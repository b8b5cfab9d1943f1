//! Pictures inside a terminal that can show them.

use crate::draw::svg::base64;

/// Bytes of coded text in one piece; kitty takes no more.
const PIECE: usize = 4096;

/// How a terminal takes pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The graphics protocol of kitty; Ghostty, WezTerm and Konsole take it as well.
    Kitty,
    /// The inline files of iTerm2.
    Inline,
}

impl Way {
    /// What this terminal says of itself, or `LOFT_PICTURES` (`kitty`, `iterm`, `none`); `None` where it can show none.
    pub fn of_terminal() -> Option<Self> {
        Self::of(&|name| std::env::var(name).ok().filter(|value| !value.is_empty()))
    }

    fn of(set: &dyn Fn(&str) -> Option<String>) -> Option<Self> {
        match set("LOFT_PICTURES").as_deref() {
            Some("kitty") => return Some(Self::Kitty),
            Some("iterm") => return Some(Self::Inline),
            Some(_) => return None,
            None => {}
        }
        let (term, program) = (set("TERM").unwrap_or_default(), set("TERM_PROGRAM").unwrap_or_default());
        if set("KITTY_WINDOW_ID").is_some() || term.contains("kitty") || matches!(program.as_str(), "ghostty" | "WezTerm") {
            return Some(Self::Kitty);
        }
        matches!(program.as_str(), "iTerm.app" | "vscode" | "mintty").then_some(Self::Inline)
    }

    /// What shows a PNG file.
    pub fn text(self, png: &[u8]) -> String {
        let coded = base64(png);
        match self {
            Self::Inline => format!("\u{1b}]1337;File=inline=1;size={};width=80%:{coded}\u{7}\n", png.len()),
            Self::Kitty => {
                let pieces: Vec<&[u8]> = coded.as_bytes().chunks(PIECE).collect();
                let piece = |(k, piece): (usize, &&[u8])| {
                    let head = if k == 0 { "a=T,f=100," } else { "" };
                    let more = u8::from(k + 1 < pieces.len());
                    format!("\u{1b}_G{head}m={more};{}\u{1b}\\", String::from_utf8_lossy(piece))
                };
                pieces.iter().enumerate().map(piece).collect::<String>() + "\n"
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terminals_are_known_by_what_they_set() {
        let of = |set: &'static [(&'static str, &'static str)]| Way::of(&|name| set.iter().find(|s| s.0 == name).map(|s| s.1.to_owned()));
        assert_eq!(of(&[("TERM", "xterm-256color")]), None);
        assert_eq!(of(&[("TERM", "xterm-kitty")]), Some(Way::Kitty));
        assert_eq!(of(&[("KITTY_WINDOW_ID", "1")]), Some(Way::Kitty));
        assert_eq!(of(&[("TERM_PROGRAM", "iTerm.app")]), Some(Way::Inline));
        assert_eq!(of(&[("TERM_PROGRAM", "iTerm.app"), ("LOFT_PICTURES", "none")]), None);
    }

    #[test]
    fn long_pictures_come_in_pieces() {
        let text = Way::Kitty.text(&[7; 7000]);
        assert_eq!(text.matches("\u{1b}_G").count(), 3);
        assert!(text.starts_with("\u{1b}_Ga=T,f=100,m=1;") && text.contains("\u{1b}_Gm=0;"));
        assert!(Way::Inline.text(b"abc").contains("size=3;") && Way::Inline.text(b"abc").contains(":YWJj"));
    }
}

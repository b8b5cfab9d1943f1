//! Pictures inside a terminal that can show them.

use super::sixel::Pixels;
use super::typed::Typed;
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
    /// Sixels, as xterm, foot, Windows Terminal, mlterm and Contour take them.
    Sixel {
        /// Pixels of a row that fit.
        width: usize,
    },
}

/// Pixels of a row on a terminal that does not report its width.
const USUAL_WIDTH: usize = 800;

impl Way {
    /// What this terminal says of itself, or `LOFT_PICTURES` (`kitty`, `iterm`, `sixel`, `none`): how it shows pictures, or that
    /// it shows none; `None` where only the terminal knows.
    pub fn of_terminal() -> Option<Option<Self>> {
        Self::of(&|name| std::env::var(name).ok().filter(|value| !value.is_empty()))
    }

    fn of(set: &dyn Fn(&str) -> Option<String>) -> Option<Option<Self>> {
        match set("LOFT_PICTURES").as_deref() {
            Some("kitty") => return Some(Some(Self::Kitty)),
            Some("iterm") => return Some(Some(Self::Inline)),
            Some("sixel") => return Some(Some(Self::sixel())),
            Some(_) => return Some(None),
            None => {}
        }
        let (term, program) = (set("TERM").unwrap_or_default(), set("TERM_PROGRAM").unwrap_or_default());
        if set("KITTY_WINDOW_ID").is_some() || term.contains("kitty") || matches!(program.as_str(), "ghostty" | "WezTerm") {
            return Some(Some(Self::Kitty));
        }
        if matches!(program.as_str(), "iTerm.app" | "vscode" | "mintty") {
            return Some(Some(Self::Inline));
        }
        (term == "dumb").then_some(None)
    }

    fn sixel() -> Self {
        Self::Sixel { width: super::typed::pixels_of_row().unwrap_or(USUAL_WIDTH) }
    }

    /// What the terminal answers; keys that are typed meanwhile are kept.
    pub fn asked(typed: &mut Typed) -> Option<Self> {
        /// What terminals with sixels count among their attributes.
        const SIXELS: u16 = 4;
        typed.attributes().contains(&SIXELS).then(Self::sixel)
    }

    /// What shows a PNG file.
    pub fn text(self, png: &[u8]) -> String {
        match self {
            Self::Inline => format!("\u{1b}]1337;File=inline=1;size={};width=80%:{}\u{7}\n", png.len(), base64(png)),
            Self::Sixel { width } => Pixels::of_png(png).map_or_else(String::new, |pixels| pixels.within(width).sixels() + "\n"),
            Self::Kitty => {
                let coded = base64(png);
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
        assert_eq!(of(&[("TERM", "dumb")]), Some(None));
        assert_eq!(of(&[("TERM", "xterm-kitty")]), Some(Some(Way::Kitty)));
        assert_eq!(of(&[("KITTY_WINDOW_ID", "1")]), Some(Some(Way::Kitty)));
        assert_eq!(of(&[("TERM_PROGRAM", "iTerm.app")]), Some(Some(Way::Inline)));
        assert_eq!(of(&[("TERM_PROGRAM", "iTerm.app"), ("LOFT_PICTURES", "none")]), Some(None));
        assert!(matches!(of(&[("LOFT_PICTURES", "sixel")]), Some(Some(Way::Sixel { .. }))));
    }

    #[test]
    fn long_pictures_come_in_pieces() {
        let text = Way::Kitty.text(&[7; 7000]);
        assert_eq!(text.matches("\u{1b}_G").count(), 3);
        assert!(text.starts_with("\u{1b}_Ga=T,f=100,m=1;") && text.contains("\u{1b}_Gm=0;"));
        assert!(Way::Inline.text(b"abc").contains("size=3;") && Way::Inline.text(b"abc").contains(":YWJj"));
    }
}

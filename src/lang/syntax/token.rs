//! Kinds of tokens and the table of reserved words.

use super::ast::Keyword;

/// What a token is. A declaration's tree follows from the kinds of its tokens alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
#[allow(missing_docs)]
pub(crate) enum Kind {
    /// A word that is not reserved.
    Name,
    Number,
    Quantity,
    /// A string without interpolation.
    Text,
    /// `"…{`
    TextHead,
    /// `}…{`
    TextMid,
    /// `}…"`
    TextTail,
    /// `(` with what it may belong to before it on its line.
    OpenRound,
    /// `(` first on its line.
    LineRound,
    CloseRound,
    OpenSquare,
    /// `[` first on its line.
    LineSquare,
    CloseSquare,
    OpenCurly,
    CloseCurly,
    Comma,
    Colon,
    Equals,
    Dot,
    DotDot,
    Plus,
    Minus,
    Star,
    Slash,
    Caret,
    And,
    EqualEqual,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    /// Anything that no script may hold.
    Strange,
    Units,
    Tolerance,
    Snap,
    Use,
    Import,
    Param,
    Let,
    Fn,
    Point,
    Curve,
    Modeling,
    Surface,
    Shell,
    Group,
    Mesh,
    Check,
    Report,
    Export,
    Picture,
    Of,
    For,
    In,
    If,
    Then,
    Else,
    AndWord,
    OrWord,
    Not,
    True,
    False,
    None,
    Within,
    To,
    As,
    On,
    Near,
}

/// Reserved words, sorted.
const RESERVED: [(&str, Kind); 36] = [
    ("and", Kind::AndWord),
    ("as", Kind::As),
    ("check", Kind::Check),
    ("curve", Kind::Curve),
    ("else", Kind::Else),
    ("export", Kind::Export),
    ("false", Kind::False),
    ("fn", Kind::Fn),
    ("for", Kind::For),
    ("group", Kind::Group),
    ("if", Kind::If),
    ("import", Kind::Import),
    ("in", Kind::In),
    ("let", Kind::Let),
    ("mesh", Kind::Mesh),
    ("modeling", Kind::Modeling),
    ("near", Kind::Near),
    ("none", Kind::None),
    ("not", Kind::Not),
    ("of", Kind::Of),
    ("on", Kind::On),
    ("or", Kind::OrWord),
    ("param", Kind::Param),
    ("picture", Kind::Picture),
    ("point", Kind::Point),
    ("report", Kind::Report),
    ("shell", Kind::Shell),
    ("snap", Kind::Snap),
    ("surface", Kind::Surface),
    ("then", Kind::Then),
    ("to", Kind::To),
    ("tolerance", Kind::Tolerance),
    ("true", Kind::True),
    ("units", Kind::Units),
    ("use", Kind::Use),
    ("within", Kind::Within),
];

/// The kind of a word.
pub(crate) fn kind_of_word(word: &str) -> Kind {
    if !(2..=9).contains(&word.len()) || !word.as_bytes()[0].is_ascii_lowercase() {
        return Kind::Name;
    }
    RESERVED.binary_search_by(|(w, _)| (*w).cmp(word)).map_or(Kind::Name, |i| RESERVED[i].1)
}

/// All reserved words, for suggestions, completion and syntax colours.
pub fn reserved_words() -> impl Iterator<Item = &'static str> {
    RESERVED.iter().map(|(word, _)| *word)
}

/// Keywords that start a declaration, as the user writes them.
pub const KEYWORDS: [(&str, Keyword); 19] = [
    ("units", Keyword::Units),
    ("tolerance", Keyword::Tolerance),
    ("snap", Keyword::Snap),
    ("use", Keyword::Use),
    ("import", Keyword::Import),
    ("param", Keyword::Param),
    ("let", Keyword::Let),
    ("fn", Keyword::Fn),
    ("point", Keyword::Point),
    ("curve", Keyword::Curve),
    ("modeling curve", Keyword::ModelingCurve),
    ("surface", Keyword::Surface),
    ("shell", Keyword::Shell),
    ("group", Keyword::Group),
    ("mesh", Keyword::Mesh),
    ("check", Keyword::Check),
    ("report", Keyword::Report),
    ("export", Keyword::Export),
    ("picture", Keyword::Picture),
];

impl Kind {
    /// The keyword of a declaration that starts with this token.
    pub(crate) fn keyword(self) -> Option<Keyword> {
        Some(match self {
            Self::Units => Keyword::Units,
            Self::Tolerance => Keyword::Tolerance,
            Self::Snap => Keyword::Snap,
            Self::Use => Keyword::Use,
            Self::Import => Keyword::Import,
            Self::Param => Keyword::Param,
            Self::Let => Keyword::Let,
            Self::Fn => Keyword::Fn,
            Self::Point => Keyword::Point,
            Self::Curve => Keyword::Curve,
            Self::Modeling => Keyword::ModelingCurve,
            Self::Surface => Keyword::Surface,
            Self::Shell => Keyword::Shell,
            Self::Group => Keyword::Group,
            Self::Mesh => Keyword::Mesh,
            Self::Check => Keyword::Check,
            Self::Report => Keyword::Report,
            Self::Export => Keyword::Export,
            Self::Picture => Keyword::Picture,
            _ => return None,
        })
    }

    /// Whether it is a word that cannot be a name.
    pub(crate) fn is_reserved(self) -> bool {
        self >= Self::Units
    }

    /// Whether an operand can end with it.
    pub(crate) fn ends_operand(self) -> bool {
        matches!(
            self,
            Self::Name
                | Self::Number
                | Self::Quantity
                | Self::Text
                | Self::TextTail
                | Self::CloseRound
                | Self::CloseSquare
                | Self::CloseCurly
                | Self::True
                | Self::False
                | Self::None
        )
    }

    /// Whether a value must follow it, so that `let` after it is the local form.
    pub(crate) fn wants_value(self) -> bool {
        matches!(
            self,
            Self::Equals
                | Self::Comma
                | Self::Colon
                | Self::OpenRound
                | Self::LineRound
                | Self::OpenSquare
                | Self::LineSquare
                | Self::OpenCurly
                | Self::TextHead
                | Self::TextMid
                | Self::Then
                | Self::Else
                | Self::In
                | Self::If
                | Self::Not
                | Self::Within
        ) || self.is_infix()
    }

    /// Whether it stands between two operands.
    pub(crate) fn is_infix(self) -> bool {
        matches!(
            self,
            Self::DotDot
                | Self::Plus
                | Self::Minus
                | Self::Star
                | Self::Slash
                | Self::Caret
                | Self::And
                | Self::EqualEqual
                | Self::NotEqual
                | Self::Less
                | Self::LessEqual
                | Self::Greater
                | Self::GreaterEqual
                | Self::AndWord
                | Self::OrWord
                | Self::Within
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reserved_words_are_sorted_and_found() {
        assert!(RESERVED.windows(2).all(|w| w[0].0 < w[1].0));
        assert!(RESERVED.iter().all(|&(word, kind)| kind_of_word(word) == kind && kind.is_reserved()));
        assert_eq!(kind_of_word("letter"), Kind::Name);
        assert_eq!(kind_of_word("m"), Kind::Name);
    }
}

//! Kinds of tokens.

use crate::lang::syntax::ast::Keyword;
use crate::lang::syntax::keywords::WORDS;

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

/// The keyword of the declaration that each kind opens.
static OPENED: [Option<Keyword>; Kind::Near as usize + 1] = opened();

const fn opened() -> [Option<Keyword>; Kind::Near as usize + 1] {
    let mut opened = [None; Kind::Near as usize + 1];
    let mut word = 0;
    while word < WORDS.len() {
        opened[WORDS[word].kind as usize] = WORDS[word].keyword;
        word += 1;
    }
    opened
}

/// The kind of a word.
pub(crate) fn kind_of_word(word: &str) -> Kind {
    let bytes = word.as_bytes();
    // Reserved words are made of lower-case letters.
    if !(2..=9).contains(&bytes.len()) || !bytes[0].is_ascii_lowercase() || !bytes[bytes.len() - 1].is_ascii_lowercase() {
        return Kind::Name;
    }
    crate::lang::syntax::keywords::find(word).map_or(Kind::Name, |w| w.kind)
}

impl Kind {
    /// The keyword of a declaration that starts with this token.
    pub(crate) fn keyword(self) -> Option<Keyword> {
        OPENED[self as usize]
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

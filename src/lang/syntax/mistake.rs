//! What is wrong with tokens, brackets and lines, in words.

use crate::base::limits::SOURCE_BYTES;
use crate::base::text::is_unseen;
use crate::lang::diag::diagnostic::{Diagnostic, FileId};
use crate::lang::diag::span::Span;
use crate::lang::syntax::keywords::{KeywordDoc, openers};
use crate::lang::syntax::number;
use crate::lang::syntax::number::Fault;
use crate::lang::words::names::nearest;

/// One mistake of the text, found before parsing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Mistake {
    /// E103: a string without end; `inside` tells that a `{` of it is open.
    OpenString { span: Span, inside: bool },
    /// E104: a comment without end.
    OpenComment { span: Span },
    /// E109: comments nested too deep.
    DeepComment { span: Span },
    /// E102: a sign that no script may hold.
    StrangeSign { span: Span },
    /// E102: no such escape.
    BadEscape { span: Span },
    /// E107: a malformed number or unit; `unit` is where the unit begins.
    BadNumber { span: Span, unit: u32, fault: Fault },
    /// E101: a bracket never closed; `ended` is what stands where it ought to have been closed and whether that is a
    /// new declaration; `closers` close it and what is open inside it; `last` is the item they go behind.
    OpenBracket { span: Span, ended: Option<(Span, bool)>, closers: String, last: Span, piece: Span },
    /// E102: a closing bracket without an opening one; `inside` is what is open there.
    StrayBracket { span: Span, inside: Option<Span>, piece: Span },
    /// E109: nested too deep.
    TooDeep { span: Span, what: &'static str, limit: usize },
    /// E105: two declarations on a line.
    TwoOnLine { first: Span, second: Span },
    /// E106: a declaration without keyword; `next` is the word or sign behind the first one.
    NoKeyword { span: Span, next: Option<Span>, binds: bool },
    /// W220: `2m^2`, which is the square of 2m; `power` is the exponent.
    UnitPower { span: Span, power: Span },
    /// E110: the source is too large.
    TooLarge { bytes: usize },
}

/// Why a declaration that the grammar accepts is refused; spans hold token numbers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Refused {
    /// `within` behind something other than `==` or `!=`.
    Within { span: Span, left: Span },
    /// `0 < x < 5`
    Chain { span: Span, left: Span, middle: Span, right: Span },
    /// Cannot happen while grammar and tree agree.
    Whole { what: &'static str, span: Span },
}

impl Refused {
    /// A pair that lacks a part which the grammar demands.
    pub fn whole(what: &'static str, start: u32, end: u32) -> Self {
        Self::Whole { what, span: Span { start, end } }
    }

    /// The report; `place` turns token numbers into bytes.
    pub fn diagnose(&self, source: &str, file: FileId, place: impl Fn(Span) -> Span) -> Diagnostic {
        let text = |span: Span| {
            let span = place(span);
            &source[span.start as usize..span.end as usize]
        };
        match self {
            Self::Within { span, left } => Diagnostic::new(
                "E102",
                "`within` follows `==` or `!=`",
                file,
                place(*span),
                "no comparison before it that takes a tolerance",
            )
            .help(format!("{} == … within …", text(*left))),
            Self::Chain { span, left, middle, right } => {
                let help = format!("{} and {} {} {}", text(*left), text(*middle), text(*span), text(*right));
                let gap = Span { start: place(*span).start, end: place(*span).start };
                Diagnostic::new("E102", "comparisons cannot be chained", file, place(*span), "a second comparison")
                    .help(help)
                    .put(gap, format!("and {} ", text(*middle)))
            }
            Self::Whole { what, span } => Diagnostic::new("E102", *what, file, place(*span), "here"),
        }
    }
}

impl Mistake {
    /// Tells a mistake of brackets which declaration it stands in.
    pub fn stands_in(&mut self, whole: Span) {
        if let Self::OpenBracket { piece, .. } | Self::StrayBracket { piece, .. } = self {
            *piece = whole;
        }
    }

    /// Where a string without end begins.
    pub fn open_string(&self) -> Option<u32> {
        if let Self::OpenString { span, .. } = self { Some(span.start) } else { None }
    }

    /// Whether a string without end, by the places of all of them in order, is the likely cause of this one: it hides brackets.
    pub fn follows_from(&self, open_strings: &[u32]) -> bool {
        let (Self::OpenBracket { piece, .. } | Self::StrayBracket { piece, .. }) = self else { return false };
        let next = open_strings.partition_point(|start| *start < piece.start);
        open_strings.get(next).is_some_and(|start| *start <= piece.end)
    }

    /// Whether `2m^2` may be meant as `2m2`: a length, alone or below a `/`, with the exponent 2 or 3.
    pub fn is_meant_otherwise(&self, source: &str) -> bool {
        let Self::UnitPower { span, power } = self else { return false };
        let text = |span: Span| &source[span.start as usize..span.end as usize];
        let unit = number::split_unit(text(*span)).1;
        number::LENGTHS.contains(&unit.rsplit('/').next().unwrap_or(unit)) && matches!(text(*power), "2" | "3")
    }

    /// The foremost place.
    pub fn place(&self) -> Span {
        match *self {
            Self::OpenString { span, .. }
            | Self::OpenComment { span }
            | Self::DeepComment { span }
            | Self::StrangeSign { span }
            | Self::BadEscape { span }
            | Self::BadNumber { span, .. }
            | Self::OpenBracket { span, .. }
            | Self::StrayBracket { span, .. }
            | Self::TooDeep { span, .. }
            | Self::UnitPower { span, .. }
            | Self::NoKeyword { span, .. } => span,
            Self::TwoOnLine { second, .. } => second,
            Self::TooLarge { .. } => Span::default(),
        }
    }

    /// The report; `source` is the whole file.
    pub fn diagnose(&self, source: &str, file: FileId) -> Diagnostic {
        let text = |span: Span| &source[span.start as usize..span.end as usize];
        let at = self.place();
        match self {
            Self::OpenString { inside, .. } => {
                let label = Span { start: at.start, end: at.start + 1 };
                let end = Span { start: at.end, end: at.end };
                let report = Diagnostic::new("E103", "this string has no end", file, label, "opened here");
                let report = report.label(file, end, "the line ends here, and a string ends on its line");
                if *inside {
                    report.help("add `}\"` where the value and the string end").put(end, "}\"")
                } else {
                    report.help(format!("add `\"`: {}\"", tail(text(at)))).put(end, "\"")
                }
            }
            Self::OpenComment { .. } => {
                let line = source[at.start as usize..].lines().next().unwrap_or("");
                let end = at.start + line.len() as u32;
                let report = Diagnostic::new("E104", "this comment has no end", file, at, "opened here");
                report.help("add `*/` where it ends").put(Span { start: end, end }, " */")
            }
            Self::DeepComment { .. } => Self::too_deep(file, at, "comments", 256),
            Self::StrangeSign { .. } => strange_sign(text(at), file, at),
            Self::BadEscape { .. } => Diagnostic::new("E102", format!("`{}` is not an escape", text(at)), file, at, "not an escape")
                .help("the escapes are \\\" \\\\ \\n \\{ and \\u{1F600}; a backslash itself is written \\\\"),
            Self::BadNumber { unit, fault, .. } => bad_number(text(at), (*unit - at.start) as usize, *fault, file, at),
            Self::OpenBracket { ended, closers, last, piece, .. } => {
                let report = Diagnostic::new("E101", format!("this `{}` is never closed", opener(text(at))), file, at, "opened here");
                let report = match ended {
                    Some((span, true)) => report.label(file, *span, "a new declaration starts here, so the list ended before it"),
                    Some((span, false)) => report.label(file, *span, format!("`{}` closes what was opened before it", text(*span))),
                    None => report.label(file, Span { start: last.end, end: last.end }, "the script ends here"),
                };
                let (before, behind) = (Span { start: piece.start, end: last.end }, Span { start: last.end, end: piece.end });
                let works = crate::lang::syntax::is_declaration(&format!("{}{closers}{}", text(before), text(behind)));
                let report = report.put(Span { start: last.end, end: last.end }, closers.as_str());
                report.help(if works { format!("add `{closers}` after `{}`", text(*last)) } else { format!("close it with `{closers}`") })
            }
            Self::StrayBracket { inside, .. } => {
                let found = &text(at)[..1];
                match inside.map(|span| (span, opener(text(span)))) {
                    Some((span, open)) => {
                        Diagnostic::new("E102", format!("`{found}` cannot close `{open}`"), file, at, "closes something else")
                            .label(file, span, "opened here")
                            .help(format!("write `{}`", closing(open)))
                            .put(first_of(at), closing(open))
                    }
                    None => Diagnostic::new("E102", format!("this `{found}` closes nothing"), file, at, "nothing is open here")
                        .help(format!("delete the `{found}`"))
                        .put(first_of(at), ""),
                }
            }
            Self::TooDeep { what, limit, .. } => Self::too_deep(file, at, what, *limit),
            Self::TwoOnLine { first, second } => {
                Diagnostic::new("E105", "two declarations on one line", file, *second, "a second declaration starts here")
                    .label(file, *first, "the first one starts here")
                    .help(format!("start a new line before `{}`", text(*second)))
                    .put(blank_before(source, second.start), "\n")
            }
            Self::NoKeyword { next, binds, .. } => no_keyword(source, file, at, *next, *binds),
            Self::UnitPower { power, .. } => {
                let (digits, unit) = number::split_unit(text(at));
                let whole_at = Span { start: at.start, end: power.end };
                let (whole, power) = (text(whole_at), text(*power));
                Diagnostic::new(
                    "W220",
                    format!("`{whole}` is the square of {digits}{unit}").replace("square", if power == "2" { "square" } else { "cube" }),
                    file,
                    at,
                    "the power applies to the number too",
                )
                .help(format!("write `{digits}{unit}{power}`, or `({digits}{unit})^{power}` if this is meant"))
                .put(whole_at, format!("{digits}{unit}{power}"))
                .put(whole_at, format!("({digits}{unit})^{power}"))
            }
            Self::TooLarge { bytes } => Diagnostic::new("E110", format!("the script has {bytes} bytes"), file, at, "too large")
                .help(format!("the limit is {} MiB; move data to a csv file and `import` it", SOURCE_BYTES >> 20)),
        }
    }

    fn too_deep(file: FileId, at: Span, what: &str, limit: usize) -> Diagnostic {
        Diagnostic::new("E109", format!("nested too deep: more than {limit} {what}"), file, at, format!("number {} starts here", limit + 1))
            .help("give the inner parts names of their own with `let`")
    }
}

/// The first letter of a stretch.
fn first_of(at: Span) -> Span {
    Span { start: at.start, end: at.start + 1 }
}

/// The blanks before a byte.
fn blank_before(source: &str, byte: u32) -> Span {
    let before = &source[..byte as usize];
    Span { start: before.trim_end_matches([' ', '\t']).len() as u32, end: byte }
}

/// The last forty characters of a text.
fn tail(text: &str) -> &str {
    let text = text.trim_end();
    text.char_indices().rev().nth(39).map_or(text, |(at, _)| &text[at..])
}

fn opener(text: &str) -> &str {
    if text.ends_with('{') { "{" } else { text }
}

fn closing(opener: &str) -> &'static str {
    match opener {
        "(" => ")",
        "[" => "]",
        _ => "}",
    }
}

fn strange_sign(sign: &str, file: FileId, at: Span) -> Diagnostic {
    let help = match sign {
        ";" => "a declaration ends with its line: delete the `;`".to_owned(),
        "'" | "`" | "“" | "”" | "„" | "‘" | "’" => "a string is written \"like this\"".to_owned(),
        "#" => "a comment is written `// like this`".to_owned(),
        "!" => "write `not`".to_owned(),
        "&&" => "write `and`".to_owned(),
        "||" => "write `or`".to_owned(),
        "|" => "write `or`, or `[a, b]` for a list".to_owned(),
        "**" => "write `^`".to_owned(),
        "%" => "in a ratio `%` directly follows the number, `5%`; a remainder is `mod(a, b)`".to_owned(),
        "->" | "=>" => "the type of a result follows a colon: `fn f(x: length): curve = …`".to_owned(),
        "°" => "write `deg` directly after the number: `30deg`".to_owned(),
        "×" | "·" => "write `*`".to_owned(),
        "÷" => "write `/`".to_owned(),
        "−" | "–" | "—" => "write `-`".to_owned(),
        "≤" => "write `<=`".to_owned(),
        "≥" => "write `>=`".to_owned(),
        "≠" => "write `!=`".to_owned(),
        "²" | "³" => "write `mm2`, `m3`, or `^ 2`".to_owned(),
        "…" => "write `..`".to_owned(),
        "?" => "a choice is written `if c then a else b`".to_owned(),
        _ => {
            let c = sign.chars().next().unwrap_or(' ');
            return Diagnostic::new(
                "E102",
                format!("the character {} (U+{:04X}) is not part of the language", shown(c), u32::from(c)),
                file,
                at,
                "not expected here",
            )
            .help("delete it, or put it inside a string");
        }
    };
    let report = Diagnostic::new("E102", format!("`{sign}` is not part of the language"), file, at, "not expected here").help(help);
    match meant_sign(sign) {
        Some(meant) => report.put(at, meant),
        None => report,
    }
}

/// What a sign of other languages is in this one.
fn meant_sign(sign: &str) -> Option<&'static str> {
    Some(match sign {
        ";" => "",
        "#" => "//",
        "!" => "not ",
        "&&" => "and",
        "|" | "||" => "or",
        "**" => "^",
        "->" | "=>" => ":",
        "×" | "·" => "*",
        "÷" => "/",
        "−" | "–" | "—" => "-",
        "≤" => "<=",
        "≥" => ">=",
        "≠" => "!=",
        "…" => "..",
        "°" => "deg",
        _ => return None,
    })
}

/// A character as it can be printed.
fn shown(c: char) -> String {
    if c.is_control() || c.is_whitespace() || is_unseen(c) { c.escape_default().to_string() } else { format!("`{c}`") }
}

fn bad_number(text: &str, unit: usize, fault: Fault, file: FileId, at: Span) -> Diagnostic {
    let (digits, unit) = text.split_at(unit.min(text.len()));
    let report = |message: String, label: &str| Diagnostic::new("E107", message, file, at, label);
    match fault {
        Fault::LeadingDot => report(format!("`{text}` is not a number"), "a digit is missing before the dot")
            .help(format!("0{text}"))
            .put(at, format!("0{text}")),
        Fault::TrailingDot => {
            let meant = text.replacen('.', ".0", 1);
            report(format!("`{text}` is not a number"), "a digit is missing behind the dot").help(meant.clone()).put(at, meant)
        }
        Fault::Underscore => {
            let meant = number::repaired(text);
            report(format!("`{text}` is not a number"), "`_` is allowed between two digits").help(meant.clone()).put(at, meant)
        }
        Fault::SecondDot => report(format!("`{text}` has two decimal points"), "one number, one dot"),
        Fault::TooLarge => {
            report(format!("`{text}` is too large for a number"), "not finite").help("the largest number is about 1.797e308")
        }
        Fault::Unit => {
            let label = Span { start: at.start + digits.len() as u32, end: at.end };
            let report = Diagnostic::new("E107", format!("`{unit}` is not a unit"), file, label, "no such unit");
            match number::meant(unit) {
                Some(meant) => report.help(format!("{digits}{meant}")).put(at, format!("{digits}{meant}")),
                None => report.help("the units are um mm cm m km in ft (also squared and cubed: mm2, m3), deg rad, kg t, kg/m3 and %"),
            }
        }
    }
}

fn no_keyword(source: &str, file: FileId, at: Span, next: Option<Span>, binds: bool) -> Diagnostic {
    let text = |span: Span| &source[span.start as usize..span.end as usize];
    let word = text(at);
    if binds {
        // `x = 3`
        return Diagnostic::new("E106", format!("`{word}` is declared without a keyword"), file, at, "a declaration starts with a keyword")
            .help(format!("let {word} = …, or `point`, `curve`, `surface` for what belongs to the model"))
            .put(Span { start: at.start, end: at.start }, "let ");
    }
    let behind = source[at.end as usize..].trim_start_matches([' ', '\t']);
    if let Some(sign) = ["+=", "-=", "*=", "/="].iter().find(|sign| behind.starts_with(**sign)) {
        let operator = sign.trim_end_matches('=');
        return Diagnostic::new("E106", format!("`{word}` cannot be changed by `{sign}`"), file, at, "no declaration starts with this")
            .help(format!("a name keeps its value; the result needs a name of its own: `let … = {word} {operator} …`"));
    }
    let message =
        if matches!(word, "if" | "for") { format!("no declaration starts with `{word}`") } else { format!("`{word}` is not a keyword") };
    let report = Diagnostic::new("E106", message, file, at, "no declaration starts with this");
    let two = next.map(|n| source[at.start as usize..n.end as usize].split_whitespace().collect::<Vec<_>>().join(" "));
    let words = || openers().into_iter().map(KeywordDoc::written);
    let found = two.as_deref().filter(|t| t.ends_with(" curve")).and_then(|t| nearest(t, words())).or_else(|| nearest(word, words()));
    let word_at = match (next, found) {
        // Both words of `modeling curve`.
        (Some(next), Some(meant)) if meant.contains(' ') && two.as_deref().is_some_and(|t| t.ends_with(" curve")) => {
            Span { start: at.start, end: next.end }
        }
        _ => at,
    };
    match found {
        Some(meant) => report.help(format!("did you mean `{meant}`?")).put(word_at, meant),
        None => report.help(format!("the keywords are {}", words().collect::<Vec<_>>().join(" "))),
    }
}

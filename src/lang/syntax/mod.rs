//! Text to tree. The only place that knows pest.
//!
//! ```text
//! bytes → tokens (scan) → pieces (split) → shapes (matching, tree, climb; each shape once) → declarations (shape)
//! ```
//!
//! Parsing never stops at a mistake: every piece stands for itself, the sound ones are kept, and the names of broken
//! ones are listed so that what uses them can be skipped without a second message.

pub mod ast;
pub mod climb;
pub mod declarations;
pub mod expected;
pub mod expected_words;
pub mod fixes;
pub mod foreign;
pub mod keywords;
pub mod look_alikes;
pub mod matching;
pub mod mistake;
pub mod number;
pub mod outline;
pub mod scan;
pub mod scopes;
pub mod shape;
pub mod split;
pub mod token;
pub mod token_rules;
pub mod tree;
pub mod tree_expressions;

use std::ops::Range;
use std::sync::Arc;

use pest::Parser as _;

use crate::base::limits::SOURCE_BYTES;
use crate::lang::diag::diagnostic::{Diagnostic, FileId};
use crate::lang::diag::span::Span;
use crate::lang::syntax::ast::{Bound, Script};
use crate::lang::syntax::matching::Marks;
use crate::lang::syntax::mistake::Mistake;
pub(crate) use crate::lang::syntax::scan::{Tokens, scan};
use crate::lang::syntax::shape::{Filler, KnownShape, NameSource, Places, Shape, Shapes};
use crate::lang::syntax::split::Piece;
pub(crate) use crate::lang::syntax::split::split;
pub(crate) use crate::lang::syntax::token::Kind;
use crate::lang::words::names::Names;

/// What pest makes of `grammar/loft.pest`.
#[allow(missing_docs)]
mod grammar {
    #[derive(pest_derive::Parser)]
    #[grammar = "../grammar/loft.pest"]
    pub struct Grammar;
}
use grammar::{Grammar, Rule};

/// Parses a script; every independent mistake is reported and the sound declarations are kept.
///
/// The reports are sorted by place. The tree refers to `names`, where new names are entered.
pub fn parse(source: &str, file: FileId, names: &mut Names) -> (Script, Vec<Diagnostic>) {
    let TokenizedScript { mut script, found, mut tokens, .. } = read_as(source, file, names, true);
    script.declarations.complete(|| source.into(), &mut tokens);
    (script, found)
}

/// [`parse`] of a text that the script may share.
pub(crate) fn parse_shared(source: &Arc<str>, file: FileId, names: &mut Names) -> (Script, Vec<Diagnostic>) {
    let TokenizedScript { mut script, found, mut tokens, .. } = read_as(source, file, names, true);
    script.declarations.complete(|| Arc::clone(source), &mut tokens);
    (script, found)
}

/// A script as the formatter needs it: with its tokens and comments.
pub(crate) struct TokenizedScript {
    /// What [`parse`] gives; the formatter leaves it empty.
    script: Script,
    /// What is wrong, sorted by place.
    pub found: Vec<Diagnostic>,
    /// All tokens; none when the source is too large.
    pub tokens: Tokens,
    /// Tokens of the declarations that parsed, in order.
    pub sound: Vec<Range<usize>>,
}

/// Checks a script and keeps its tokens.
pub(crate) fn read(source: &str, file: FileId, names: &mut Names) -> TokenizedScript {
    read_as(source, file, names, false)
}

fn read_as(source: &str, file: FileId, names: &mut Names, fills: bool) -> TokenizedScript {
    if source.len() as u64 > SOURCE_BYTES {
        let found = vec![Mistake::TooLarge { bytes: source.len() }.diagnose(source, file)];
        return TokenizedScript { script: Script::default(), found, tokens: Tokens::default(), sound: Vec::new() };
    }
    let tokens = scan::scan(source);
    let (pieces, mistakes) = split::split(&tokens);
    let (script, found, sound) = Parser {
        source,
        file,
        tokens: &tokens,
        shapes: Shapes::default(),
        marks: Marks::default(),
        names,
        fills,
        script: Script::default(),
        found: Vec::new(),
        fresh: foreign::fresh_names::FreshNames::default(),
        sound: Vec::with_capacity(pieces.len()),
        last: None,
    }
    .run(pieces, mistakes);
    TokenizedScript { script, found, tokens, sound }
}
/// Where each token of a script stands; comments and blanks have none.
pub(crate) fn token_spans(source: &str) -> Vec<Span> {
    let tokens = scan::scan(source);
    (0..tokens.len()).map(|token| tokens.span(token)).collect()
}

/// Bytes of the longest declaration that is parsed again to check a repair.
const CHECKED: usize = 4096;

/// Whether a text is one declaration without a mistake; what is offered as a repair must be. Long texts never are.
fn is_declaration(text: &str) -> bool {
    text.len() <= CHECKED && Grammar::parse(Rule::single, text).is_ok()
}

struct Parser<'a> {
    source: &'a str,
    file: FileId,
    tokens: &'a Tokens,
    shapes: Shapes,
    marks: Marks,
    names: &'a mut Names,
    /// Whether declarations are wanted, not only what is wrong with them.
    fills: bool,
    script: Script,
    found: Vec<Diagnostic>,
    fresh: foreign::fresh_names::FreshNames,
    /// Tokens of the declarations.
    sound: Vec<Range<usize>>,
    /// Tokens and shape of the declaration before.
    last: Option<(Range<usize>, KnownShape)>,
}

impl Parser<'_> {
    fn run(mut self, pieces: Vec<Piece>, mistakes: Vec<Mistake>) -> (Script, Vec<Diagnostic>, Vec<Range<usize>>) {
        self.script.declarations.reserve(if self.fills { pieces.len() } else { 0 });
        self.mistakes(mistakes);
        let (mut own, mut docs) = (self.tokens.mistakes.iter().peekable(), 0);
        for mut piece in pieces {
            let end = piece.tokens.end.checked_sub(1).map_or(0, |last| self.tokens.ends[last]);
            let sound = self.without_signs_behind(&piece);
            let last = self.tokens.ends[sound - 1];
            while let Some(mistake) = own.next_if(|m| m.place().start < end) {
                piece.broken |= mistake.place().start < last;
            }
            piece.tokens.end = sound;
            let doc = self.doc(&mut docs, piece.tokens.start);
            self.piece(&piece, doc);
        }
        self.end()
    }

    /// Where a piece ends without the signs of other languages behind it, as `;`: they are reported, and it stands without them.
    fn without_signs_behind(&self, piece: &Piece) -> usize {
        let signs = self.tokens.kinds[piece.tokens.start + 1..piece.tokens.end].iter().rev().take_while(|kind| **kind == Kind::Strange);
        piece.tokens.end - signs.count()
    }

    /// Reports the mistakes of scanner and splitter; one cause, one report.
    fn mistakes(&mut self, split: Vec<Mistake>) {
        let own = &self.tokens.mistakes;
        let mut open_strings: Vec<u32> = own.iter().filter_map(Mistake::open_string).collect();
        open_strings.sort_unstable();
        let causes = split.iter().filter(|m| !m.follows_from(&open_strings));
        self.found.extend(own.iter().chain(causes).map(|m| m.diagnose(self.source, self.file)));
        if !self.source.is_ascii() {
            let names = (0..self.tokens.len()).filter(|token| self.tokens.kinds[*token] == Kind::Name).map(|token| self.tokens.span(token));
            self.found.extend(look_alikes::found(self.source, names, self.file));
        }
    }

    /// The `///` lines before a token.
    fn doc(&self, next: &mut usize, token: usize) -> Option<Box<str>> {
        let docs = &self.tokens.docs;
        while docs.get(*next).is_some_and(|&(before, _)| (before as usize) < token) {
            *next += 1;
        }
        let mut text = String::new();
        while let Some(&(_, span)) = docs.get(*next).filter(|&&(before, _)| before as usize == token) {
            let line = &self.source[span.start as usize..span.end as usize];
            if !text.is_empty() {
                text.push('\n');
            }
            text.push_str(line.strip_prefix(' ').unwrap_or(line).trim_end());
            *next += 1;
        }
        (!text.is_empty()).then(|| text.into())
    }

    fn piece(&mut self, piece: &Piece, doc: Option<Box<str>>) {
        let (base, end) = (piece.tokens.start, piece.tokens.end);
        let kinds = &self.tokens.kinds[base..end];
        if kinds[0].keyword().is_none() {
            return self.without_keyword(piece);
        }
        if piece.broken {
            return self.broken(base, end);
        }
        // Most declarations have the shape of the one before.
        let same = |(tokens, _): &(Range<usize>, KnownShape)| self.tokens.kinds[tokens.clone()] == *kinds;
        let last = self.last.take().filter(same).map(|(_, known)| known);
        if let Some(known) = last.or_else(|| self.shapes.get(kinds)) {
            self.declaration(base, &known, doc);
            self.last = Some((base..end, known));
            return;
        }
        match self.shape(base, end) {
            Ok(shape) => {
                let shape = Arc::new(shape);
                let shares = self.fills && shape.is_shared() && self.shapes.has_room(kinds);
                let known = KnownShape { shared: shares.then(|| self.script.declarations.add_shape(&shape)), shape };
                self.shapes.insert(kinds, &known);
                self.declaration(base, &known, doc);
            }
            Err(diagnostic) => match self.second_let(base, end) {
                Some(at) => {
                    self.piece(&Piece { tokens: base..at, broken: false }, doc);
                    self.piece(&Piece { tokens: at..end, broken: false }, None);
                }
                None => {
                    self.found.push(*diagnostic);
                    self.broken(base, end);
                }
            },
        }
    }

    /// Adds a declaration of a shape with the tokens from `base` on.
    fn declaration(&mut self, base: usize, KnownShape { shape, shared }: &KnownShape, doc: Option<Box<str>>) {
        for &at in &shape.powers {
            let span = self.tokens.span(base + at as usize);
            let power = self.tokens.span(base + at as usize + 2);
            let mistake = Mistake::UnitPower { span, power };
            self.found.extend(mistake.is_meant_otherwise(self.source).then(|| mistake.diagnose(self.source, self.file)));
        }
        match shared {
            Some(shared) => self.script.declarations.add_shared(*shared, base, (self.source, self.tokens), self.names, doc),
            None if self.fills => {
                let places = Places::Read(self.tokens);
                let declaration = Filler { source: self.source, places, base, names: NameSource::Text(&mut *self.names) }.fill(shape, doc);
                self.script.declarations.add_whole(declaration);
            }
            None => {}
        }
        self.sound.push(base..base + shape.declaration.span.end as usize + 1);
    }

    /// A `let` at the start of a line is the local form when a value is missing before it. In a broken declaration it
    /// is rather the next one.
    fn second_let(&self, base: usize, end: usize) -> Option<usize> {
        let mut depth = 0usize;
        (base + 1..end).find(|&at| {
            match self.tokens.kinds[at] {
                Kind::OpenRound | Kind::LineRound | Kind::OpenSquare | Kind::LineSquare | Kind::OpenCurly | Kind::TextHead => depth += 1,
                Kind::CloseRound | Kind::CloseSquare | Kind::CloseCurly | Kind::TextTail => depth = depth.saturating_sub(1),
                Kind::Let => return depth == 0 && self.tokens.first[at],
                _ => {}
            }
            false
        })
    }

    /// Matches the grammar; where it does not match, pest says why.
    fn shape(&mut self, base: usize, end: usize) -> Result<Shape, Box<Diagnostic>> {
        let place = |s: Span| self.tokens.stretch(base + s.start as usize, base + s.end as usize);
        let refused = match self.marks.declaration(self.tokens, base, end) {
            Some(pair) => match tree::build(pair, self.tokens, base, end) {
                Ok(shape) => return Ok(shape),
                Err(refused) => refused,
            },
            None => {
                let span = self.tokens.stretch(base, end - 1);
                let text = &self.source[span.start as usize..span.end as usize];
                match Grammar::parse(Rule::single, text) {
                    Err(error) => {
                        let failure =
                            expected::Failure { source: self.source, file: self.file, tokens: self.tokens, fresh: &self.fresh, base, end };
                        return Err(Box::new(failure.diagnose(&error)));
                    }
                    Ok(_) => mistake::Refused::whole("a declaration", 0, (end - base - 1) as u32),
                }
            }
        };
        Err(Box::new(refused.diagnose(self.source, self.file, place)))
    }

    /// A piece that starts with no keyword.
    fn without_keyword(&mut self, piece: &Piece) {
        let (base, end) = (piece.tokens.start, piece.tokens.end);
        let kinds = &self.tokens.kinds[base..end];
        if !piece.broken || kinds[0] == Kind::Name {
            let next = (end > base + 1).then(|| self.tokens.span(base + 1));
            let mistake = Mistake::NoKeyword { span: self.tokens.span(base), next, binds: kinds.get(1) == Some(&Kind::Equals) };
            let report = mistake.diagnose(self.source, self.file);
            let refusal = || foreign::Refusal::new(self.source, self.tokens, base..end, base, &self.fresh);
            self.found.push(foreign::say(report, refusal().meant()));
        }
        let bound = match kinds {
            [Kind::Name, Kind::Equals, ..] => Some(base),
            [Kind::Name, Kind::Name, ..] => Some(base + 1),
            [Kind::Name, Kind::Curve, Kind::Name, ..] => Some(base + 2),
            _ => None,
        };
        self.bind_broken(bound);
    }

    /// Remembers the name that a broken declaration would have bound.
    fn broken(&mut self, base: usize, end: usize) {
        let kinds = &self.tokens.kinds[base..end];
        let bound = match kinds {
            [Kind::Use | Kind::Import, ..] => kinds.windows(2).rposition(|w| w == [Kind::As, Kind::Name]).map(|at| base + at + 1),
            [Kind::Modeling, Kind::Curve, Kind::Name, ..] => Some(base + 2),
            [Kind::Units | Kind::Tolerance | Kind::Snap | Kind::Check | Kind::Report | Kind::Export | Kind::Picture, ..] => None,
            [_, Kind::Name, ..] => Some(base + 1),
            _ => None,
        };
        self.bind_broken(bound);
    }

    fn bind_broken(&mut self, token: Option<usize>) {
        if let Some(token) = token {
            let span = self.tokens.span(token);
            let name = self.names.intern(&self.source[span.start as usize..span.end as usize]);
            self.script.broken.push(Bound { name, span });
        }
    }

    /// Reports in order of place; behind a comment without end they say nothing.
    fn end(self) -> (Script, Vec<Diagnostic>, Vec<Range<usize>>) {
        let mut found = self.found;
        if let Some(quiet) = self.tokens.quiet_from {
            found.retain(|d| d.code.0 == "E104" || d.labels.first().is_none_or(|l| l.span.start < quiet));
        }
        found.sort_by_key(|d| d.labels.first().map(|l| l.span.start));
        (self.script, found, self.sound)
    }
}

#[cfg(test)]
mod fuzz;
#[cfg(test)]
mod tests;

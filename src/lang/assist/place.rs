//! Where a place in a text stands: what may follow there, found in the tokens before it, so that half-typed text will do.

use crate::lang::assist::around::{locals, operand};
use crate::lang::assist::frames::{OpenBracket, Role, frames};
use crate::lang::assist::function::Function;
use crate::lang::assist::scripts::{Locals, Scripts};
use crate::lang::assist::shape::KnownType;
use crate::lang::syntax::ast::Keyword;
use crate::lang::syntax::{Kind, Tokens, scan, split};
use crate::lang::values::settings::Setting;
use crate::lang::values::types::Ty;
use crate::lang::values::units::LENGTHS;
use crate::lang::values::value::Dim;

/// What may stand at a place.
#[derive(Debug)]
pub(crate) enum CompletionPlace {
    /// Nothing that is known: a comment, a number, a name that is being made.
    Nothing,
    /// A declaration, or what is asked of a session.
    Start,
    /// What the value before a dot has.
    Member(KnownType),
    /// A key of a block; with clauses of a mesh where these may stand. Keys that are given already follow.
    Key(&'static [Setting], bool, Vec<String>),
    /// A value.
    Value(Wanted),
    /// What goes on behind a value: reserved words, in the order in which they are offered.
    Behind(Vec<&'static str>),
    /// The name of a type.
    Type,
    /// One of these words alone.
    Words(Vec<&'static str>),
}

/// What is wanted of a value.
#[derive(Debug, Default)]
pub(crate) struct Wanted {
    pub ty: Option<Ty>,
    /// The call, where an argument begins: its parameters that are not given yet may be named.
    pub call: Option<(Function, Vec<String>)>,
    /// The words that it may be, where a param of a module lists them.
    pub words: Vec<String>,
    /// Nothing but named arguments may stand there.
    pub named: bool,
}

/// A place in a script.
pub(crate) struct Stand {
    pub place: CompletionPlace,
    pub locals: Locals,
    /// First byte of the word at hand.
    pub start: usize,
    /// The call around it and the parameter at hand, the innermost one.
    pub call: Option<(Function, Option<usize>)>,
    /// The setting at hand.
    pub setting: Option<&'static Setting>,
}

/// Where `at` stands in the main script.
pub(crate) fn stand(scripts: &Scripts<'_>, at: usize) -> Stand {
    let home = scripts.unit(0);
    let before = &home.text[..at];
    let tokens = scan(before);
    let mut n = tokens.len();
    let mut found = Stand { place: CompletionPlace::Nothing, locals: Locals::new(), start: at, call: None, setting: None };
    let ends_here = tokens.ends.last().is_some_and(|end| *end as usize == at);
    let in_comment =
        tokens.quiet_from.is_some() || tokens.comments.iter().chain(tokens.docs.iter().map(|d| &d.1)).any(|span| span.end as usize == at);
    if in_comment && !ends_here {
        return found;
    }
    if let Some(last) = tokens.kinds.last().filter(|_| ends_here) {
        match last {
            Kind::Name | Kind::True | Kind::False | Kind::None => n -= 1,
            kind if kind.is_reserved() => n -= 1,
            Kind::Number | Kind::Quantity | Kind::Strange => return found,
            _ => {}
        }
        if n < tokens.len() {
            found.start = tokens.starts[n] as usize;
        }
    }
    let (pieces, _) = split(&tokens);
    let Some(piece) = pieces.last().filter(|piece| piece.tokens.start < n) else {
        found.place = CompletionPlace::Start;
        return found;
    };
    let start = piece.tokens.start;
    let open = frames(&tokens, start, n);
    let last = tokens.kinds[n - 1];
    let fresh = before[tokens.ends[n - 1] as usize..found.start].contains('\n');
    if fresh && open.len() == 1 && last.ends_operand() {
        found.place = CompletionPlace::Start;
        return found;
    }
    found.locals = locals(scripts, at);
    let mut reader = Reader { scripts, source: before, tokens: &tokens, start, n, open: &open, locals: &mut found.locals };
    found.place = reader.place();
    found.call = reader.call();
    found.setting = open.last().and_then(|frame| reader.setting_of(frame));
    found
}

struct Reader<'r> {
    scripts: &'r Scripts<'r>,
    source: &'r str,
    tokens: &'r Tokens,
    /// First token of the declaration.
    start: usize,
    /// The token behind the last one before the place.
    n: usize,
    open: &'r [OpenBracket],
    locals: &'r mut Locals,
}

impl Reader<'_> {
    fn kind(&self, at: usize) -> Kind {
        self.tokens.kinds[at]
    }

    fn text(&self, at: usize) -> &str {
        &self.source[self.tokens.starts[at] as usize..self.tokens.ends[at] as usize]
    }

    fn keyword(&self) -> Option<Keyword> {
        self.kind(self.start).keyword()
    }

    fn place(&mut self) -> CompletionPlace {
        let last = self.n - 1;
        if self.kind(last) == Kind::Dot {
            return CompletionPlace::Member(self.shape_before(last));
        }
        let Some(frame) = self.open.last() else { return CompletionPlace::Nothing };
        match frame.role {
            Role::Top => self.at_top(frame),
            Role::Params => self.in_params(frame),
            Role::Settings(table, clauses) => self.in_settings(frame, table, clauses),
            _ if self.kind(last).ends_operand() => CompletionPlace::Behind(vec!["and", "or", "within", "for", "if", "then", "else", "in"]),
            Role::Other if frame.name.is_none() && self.kind(frame.at) == Kind::OpenCurly && last == frame.at => CompletionPlace::Nothing,
            _ => self.value(self.open.len() - 1),
        }
    }

    /// A value behind the last token; the type that is wanted is that of the item, unless an operator stands between.
    fn value(&mut self, frame: usize) -> CompletionPlace {
        let last = self.kind(self.n - 1);
        let ty = match last {
            Kind::For => return CompletionPlace::Nothing,
            Kind::Plus | Kind::Minus | Kind::Then | Kind::Else => self.wanted(frame),
            Kind::And => Some(Ty::OneOf(&[Ty::Curve, Ty::Surface, Ty::Shell, Ty::Mesh, Ty::Plane])),
            Kind::In => Some(Ty::List(&Ty::Any)),
            Kind::Within => Some(Ty::Measure),
            kind if kind.is_infix() || matches!(kind, Kind::If | Kind::Not) => None,
            _ => self.wanted(frame),
        };
        let opens = matches!(last, Kind::Comma | Kind::OpenRound | Kind::LineRound);
        let call = if opens { self.function(&self.open[frame]) } else { None };
        let given = self.open[frame].named.iter().map(|at| self.text(*at).to_owned()).collect();
        let here = &self.open[frame];
        let load = matches!(here.role, Role::Load);
        let words = match here.name.filter(|_| load).and_then(|_| self.function(here)) {
            Some(function) => self.parameter(here, &function).map_or(Vec::new(), |place| function.params[place].words.clone()),
            None => Vec::new(),
        };
        CompletionPlace::Value(Wanted { ty, words, named: load && here.name.is_none(), call: call.map(|call| (call, given)) })
    }

    /// What an item of a bracket must be.
    fn wanted(&mut self, frame: usize) -> Option<Ty> {
        let here = &self.open[frame];
        if frame > MAX_DEPTH {
            return None;
        }
        let outer = |reader: &mut Self| frame.checked_sub(1).and_then(|outer| reader.wanted(outer));
        match here.role {
            Role::Top => self.wanted_at_top(),
            Role::Call(_) | Role::Load => {
                let function = self.function(here)?;
                let place = self.parameter(here, &function)?;
                Some(function.params[place].ty)
            }
            Role::Params | Role::Index | Role::Other => None,
            Role::Round => match outer(self)? {
                Ty::Point | Ty::Node | Ty::Optional(Ty::Point) | Ty::Rest(Ty::Point) => Some(Ty::Quantity(Dim::LENGTH)),
                Ty::Vector | Ty::Direction | Ty::Axis | Ty::Optional(Ty::Direction | Ty::Axis) => Some(Ty::Measure),
                ty => Some(ty),
            },
            Role::List => {
                let ty = outer(self)?;
                Some(if ty.member() == Ty::Any { ty } else { ty.member() })
            }
            Role::Settings(..) => match here.clause {
                Some(_) => None,
                None => self.setting_of(here).map(|setting| setting.ty),
            },
        }
    }

    /// The setting whose value is at hand.
    fn setting_of(&self, frame: &OpenBracket) -> Option<&'static Setting> {
        let Role::Settings(table, _) = frame.role else { return None };
        let name = self.text(frame.name?);
        table.iter().find(|setting| setting.key == name)
    }

    fn wanted_at_top(&self) -> Option<Ty> {
        match self.keyword()? {
            Keyword::Tolerance | Keyword::Snap => Some(Ty::Quantity(Dim::LENGTH)),
            Keyword::Point => Some(Ty::Point),
            Keyword::Curve | Keyword::ModelingCurve => Some(Ty::Curve),
            Keyword::Surface => Some(Ty::Surface),
            Keyword::Shell => Some(Ty::List(&Ty::OneOf(&[Ty::Surface, Ty::Shell]))),
            Keyword::Mesh => Some(Ty::List(&Ty::OneOf(&[Ty::Surface, Ty::Shell, Ty::Curve, Ty::Point]))),
            Keyword::Group | Keyword::Picture => Some(Ty::List(&Ty::OneOf(GEOMETRY))),
            _ => None,
        }
    }

    fn at_top(&mut self, frame: &OpenBracket) -> CompletionPlace {
        let last = self.n - 1;
        let tokens: Vec<Kind> = (frame.item..self.n).map(|at| self.kind(at)).collect();
        let has = |kind: Kind| tokens.contains(&kind);
        let Some(keyword) = self.keyword() else {
            return if tokens.last().is_some_and(|k| k.ends_operand()) {
                CompletionPlace::Behind(vec!["and", "or", "within"])
            } else {
                self.value(0)
            };
        };
        let names = !matches!(
            keyword,
            Keyword::Units
                | Keyword::Tolerance
                | Keyword::Snap
                | Keyword::Use
                | Keyword::Import
                | Keyword::Check
                | Keyword::Report
                | Keyword::Export
                | Keyword::Picture
        );
        if last == self.start {
            return match keyword {
                Keyword::Units => CompletionPlace::Words(LENGTHS.iter().map(|unit| unit.name).collect()),
                Keyword::ModelingCurve => CompletionPlace::Words(vec!["curve"]),
                Keyword::Use | Keyword::Import => CompletionPlace::Nothing,
                _ if names => CompletionPlace::Nothing,
                _ => self.value(0),
            };
        }
        match self.kind(last) {
            Kind::Curve if keyword == Keyword::ModelingCurve => CompletionPlace::Nothing,
            Kind::As | Kind::For => CompletionPlace::Nothing,
            Kind::Colon if matches!(keyword, Keyword::Param | Keyword::Fn) && !has(Kind::Equals) => CompletionPlace::Type,
            kind if kind.ends_operand() => CompletionPlace::Behind(behind(keyword, &has)),
            Kind::Of | Kind::Equals => self.value(0),
            kind if kind.wants_value() || kind == Kind::To || kind == Kind::Comma => self.value(0),
            _ => CompletionPlace::Nothing,
        }
    }

    fn in_params(&mut self, frame: &OpenBracket) -> CompletionPlace {
        match self.kind(self.n - 1) {
            Kind::Colon => CompletionPlace::Type,
            Kind::OpenSquare | Kind::LineSquare => CompletionPlace::Type,
            Kind::Equals => CompletionPlace::Value(Wanted::default()),
            kind if kind.is_infix() && frame.name.is_some() => CompletionPlace::Value(Wanted::default()),
            _ => CompletionPlace::Nothing,
        }
    }

    fn in_settings(&mut self, frame: &OpenBracket, table: &'static [Setting], clauses: bool) -> CompletionPlace {
        let last = self.kind(self.n - 1);
        let given = || frame.named.iter().map(|at| self.text(*at).to_owned()).collect();
        match frame.clause {
            Some(clause) if last.ends_operand() && self.n - 1 > clause => CompletionPlace::Nothing,
            Some(clause) => {
                let ty = match self.kind(clause) {
                    Kind::On => Ty::List(&Ty::OneOf(&[Ty::Link, Ty::Curve, Ty::Edge, Ty::Surface, Ty::Patch, Ty::Shell])),
                    Kind::Near => Ty::List(&Ty::OneOf(&[Ty::Point, Ty::Node, Ty::Vertex, Ty::Curve, Ty::Link, Ty::Edge])),
                    _ => Ty::Record,
                };
                CompletionPlace::Value(Wanted { ty: Some(ty), ..Wanted::default() })
            }
            None if last == Kind::OpenCurly || last == Kind::Comma || last.ends_operand() => CompletionPlace::Key(table, clauses, given()),
            None => self.value(self.open.len() - 1),
        }
    }

    /// What is called, or given params, in a bracket.
    fn function(&mut self, frame: &OpenBracket) -> Option<Function> {
        match frame.role {
            Role::Call(at) => {
                let name = self.text(at).to_owned();
                if at > self.start && self.kind(at - 1) == Kind::Dot {
                    if let KnownType::Module(module) = self.shape_before(at - 1) {
                        return Function::of_script(self.scripts, module, &name);
                    }
                    // What stands before the dot is the first argument.
                    let mut function = Function::of_script(self.scripts, 0, &name).or_else(|| Function::of_language(&name))?;
                    if !matches!(function.params.first()?.ty, Ty::Rest(_)) {
                        function.params.remove(0);
                    }
                    return Some(function);
                }
                Function::of_script(self.scripts, 0, &name).or_else(|| Function::of_language(&name))
            }
            Role::Load if self.keyword() == Some(Keyword::Import) => Some(Function::of_import()),
            Role::Load => {
                let path = self.text(frame.at - 1).trim_matches('"').to_owned();
                self.scripts.module(0, &path).map(|module| Function::of_module(self.scripts, module))
            }
            _ => None,
        }
    }

    /// The parameter that the item of a call is for.
    fn parameter(&self, frame: &OpenBracket, function: &Function) -> Option<usize> {
        if let Some(name) = frame.name {
            let name = self.text(name);
            return function.params.iter().position(|p| p.name == name);
        }
        let rest = function.params.iter().position(|p| matches!(p.ty, Ty::Rest(_)));
        match rest {
            Some(rest) if frame.before >= rest => Some(rest),
            _ => (frame.before < function.params.len()).then_some(frame.before),
        }
    }

    /// The call around the place, tuples and lists aside.
    fn call(&mut self) -> Option<(Function, Option<usize>)> {
        for frame in self.open.iter().rev() {
            if let Some(function) = self.function(frame) {
                let place = self.parameter(frame, &function);
                return Some((function, place));
            }
            if !matches!(frame.role, Role::Round | Role::List | Role::Index | Role::Other) {
                return None;
            }
        }
        None
    }

    /// The type of the operand that ends before a dot.
    fn shape_before(&mut self, dot: usize) -> KnownType {
        let Some(first) = operand(self.tokens, self.start, dot) else { return KnownType::Unknown };
        let text = &self.source[self.tokens.starts[first] as usize..self.tokens.starts[dot] as usize];
        self.scripts.shape_of_text(0, text, self.locals)
    }
}

/// Brackets inside brackets up to which it is known what is wanted there.
const MAX_DEPTH: usize = 64;

/// What groups and pictures are made of.
const GEOMETRY: &[Ty] = &[Ty::Surface, Ty::Shell, Ty::Curve, Ty::Point, Ty::Mesh, Ty::Edge, Ty::Link, Ty::Patch, Ty::Vertex, Ty::Network];

/// Words that go on behind a value of a declaration.
fn behind(keyword: Keyword, has: &impl Fn(Kind) -> bool) -> Vec<&'static str> {
    let mut words = match keyword {
        Keyword::Shell | Keyword::Group | Keyword::Mesh if !has(Kind::Of) => return vec!["of", "for", "in"],
        Keyword::Use | Keyword::Import => return vec!["as"],
        Keyword::Export | Keyword::Picture if !has(Kind::To) => vec!["to", "for"],
        Keyword::Check => vec!["within", "for"],
        Keyword::Param => vec!["in", "to"],
        _ if has(Kind::Equals) => Vec::new(),
        _ => vec!["for"],
    };
    words.extend(["and", "or", "within", "in", "then", "else"]);
    words
}

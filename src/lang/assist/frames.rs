//! The brackets around a place in a half-typed declaration, and what each of them is.

use crate::lang::syntax::ast::Keyword;
use crate::lang::syntax::{Kind, Tokens};
use crate::lang::values::settings;
use crate::lang::values::settings::Setting;

/// What an open bracket is.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Role {
    /// None: the declaration itself.
    Top,
    /// Arguments of the function whose name is this token.
    Call(usize),
    /// Parameters of an `fn`.
    Params,
    /// What stands behind the path of `use` or `import`.
    Load,
    /// A tuple, or brackets around an expression.
    Round,
    /// A list.
    List,
    /// An index.
    Index,
    /// Settings of a block; those of a mesh have clauses beside them.
    Settings(&'static [Setting], bool),
    /// A record, or a value in a text.
    Other,
}

/// An open bracket.
#[derive(Clone, Debug)]
pub(crate) struct OpenBracket {
    pub role: Role,
    /// The bracket's token; the keyword's at the top.
    pub at: usize,
    /// First token of the item at hand.
    pub item: usize,
    /// Items before it without a name.
    pub before: usize,
    /// Names given before it, and its own: tokens.
    pub named: Vec<usize>,
    /// The item's own name.
    pub name: Option<usize>,
    /// The clause of a mesh that was begun.
    pub clause: Option<usize>,
}

impl OpenBracket {
    fn new(role: Role, at: usize) -> Self {
        Self { role, at, item: at + 1, before: 0, named: Vec::new(), name: None, clause: None }
    }

    fn next(&mut self, at: usize) {
        self.before += usize::from(self.name.is_none() && at > self.item);
        (self.item, self.name, self.clause) = (at, None, None);
    }
}

/// What is open before the token `end` of a declaration that starts at token `start`; the first is the declaration.
pub(crate) fn frames(tokens: &Tokens, start: usize, end: usize) -> Vec<OpenBracket> {
    let keyword = tokens.kinds[start].keyword();
    let mut open = vec![OpenBracket::new(Role::Top, start)];
    // What is asked of a session has no keyword.
    open[0].item = start + usize::from(keyword.is_some());
    for at in start..end {
        step(tokens, keyword, &mut open, at);
    }
    open
}

fn step(tokens: &Tokens, keyword: Option<Keyword>, open: &mut Vec<OpenBracket>, at: usize) {
    let before = at.checked_sub(1).map(|b| tokens.kinds[b]);
    let depth = open.len();
    let Some(frame) = open.last_mut() else { return };
    match tokens.kinds[at] {
        Kind::OpenRound | Kind::LineRound => {
            let top = matches!(frame.role, Role::Top);
            let role = match (keyword, before) {
                (Some(Keyword::Fn), Some(Kind::Name)) if top && at == frame.at + 2 => Role::Params,
                (Some(Keyword::Use | Keyword::Import), Some(Kind::Text | Kind::TextTail)) if top => Role::Load,
                (_, Some(Kind::Name)) if tokens.kinds[at] == Kind::OpenRound => Role::Call(at - 1),
                _ => Role::Round,
            };
            open.push(OpenBracket::new(role, at));
        }
        Kind::OpenSquare | Kind::LineSquare => {
            let index = before.is_some_and(Kind::ends_operand) && tokens.kinds[at] == Kind::OpenSquare;
            open.push(OpenBracket::new(if index { Role::Index } else { Role::List }, at));
        }
        Kind::OpenCurly => {
            let role = block(tokens, keyword, frame, before).unwrap_or(Role::Other);
            open.push(OpenBracket::new(role, at));
        }
        Kind::TextHead => open.push(OpenBracket::new(Role::Other, at)),
        Kind::CloseRound | Kind::CloseSquare | Kind::CloseCurly | Kind::TextTail if depth > 1 => {
            open.pop();
            // Behind the block of a clause begins something else.
            if let Some(outer) = open.last_mut().filter(|outer| outer.clause.is_some() && tokens.kinds[at] == Kind::CloseCurly) {
                outer.next(at + 1);
            }
        }
        Kind::TextMid => frame.next(at + 1),
        Kind::Comma if frame.clause.is_none() => frame.next(at + 1),
        Kind::Colon => name(tokens, frame, at),
        Kind::On | Kind::Near | Kind::In if matches!(frame.role, Role::Settings(_, true)) && !wants(before) => {
            frame.next(at);
            frame.clause = Some(at);
        }
        _ => {}
    }
}

fn wants(before: Option<Kind>) -> bool {
    before.is_some_and(|kind| kind.wants_value() && kind != Kind::OpenCurly && kind != Kind::Comma)
}

/// `name:` begins an item of a call, a record or a block.
fn name(tokens: &Tokens, frame: &mut OpenBracket, colon: usize) {
    let Some(at) = colon.checked_sub(1).filter(|at| *at >= frame.item) else { return };
    match frame.role {
        Role::Call(_) | Role::Load | Role::Params | Role::Other if at == frame.item => {}
        Role::Settings(..) if frame.clause.is_none() => frame.next(at),
        _ => return,
    }
    if tokens.kinds[at] == Kind::Name || tokens.kinds[at].is_reserved() {
        frame.name = Some(at);
        frame.named.push(at);
    }
}

/// The settings that a `{` opens.
fn block(tokens: &Tokens, keyword: Option<Keyword>, frame: &OpenBracket, before: Option<Kind>) -> Option<Role> {
    if !before.is_some_and(Kind::ends_operand) {
        return None;
    }
    match (frame.role, keyword?) {
        (Role::Top, Keyword::Mesh) => Some(Role::Settings(settings::MESH, true)),
        (Role::Top, Keyword::Shell) => Some(Role::Settings(settings::SHELL, false)),
        (Role::Top, Keyword::Export) => Some(Role::Settings(settings::EXPORT, false)),
        (Role::Top, Keyword::Picture) => Some(Role::Settings(settings::PICTURE, false)),
        (Role::Settings(_, true), _) => match tokens.kinds[frame.clause?] {
            Kind::On => Some(Role::Settings(settings::ON, false)),
            Kind::Near => Some(Role::Settings(settings::NEAR, false)),
            _ => Some(Role::Settings(settings::IN, false)),
        },
        _ => None,
    }
}

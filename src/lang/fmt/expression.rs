//! Expressions to commands.

use crate::lang::fmt::atoms::Atom;
use crate::lang::fmt::command::Cmd;
use crate::lang::syntax::Kind;

/// What an expression looks like from outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// One operand that ends with its own closing bracket: it may be broken inside it.
    Bracketed,
    /// Anything else.
    Open,
}

/// Writes the commands of one sound declaration; that it is sound is what all indexing here rests on.
pub(crate) struct CommandBuilder<'a> {
    pub atoms: &'a [Atom],
    /// Where the bracket of an atom is closed.
    mates: &'a [u32],
    pub at: usize,
    pub cmds: &'a mut Vec<Cmd>,
    /// Operators of the expressions at hand: atom and strength.
    operators: Vec<(usize, u8)>,
}

/// Operators that stand between blanks and may begin a line are those below this strength, runs aside.
const TIGHT: u8 = 9;
/// Strength of `..`.
const RUN: u8 = 5;

/// How tightly an operator binds.
fn strength(kind: Kind) -> u8 {
    match kind {
        Kind::OrWord => 1,
        Kind::AndWord => 2,
        Kind::DotDot => RUN,
        Kind::Plus | Kind::Minus => 6,
        Kind::Star | Kind::Slash => 7,
        Kind::And => 8,
        Kind::Caret => 10,
        _ => 4,
    }
}

/// For each atom the one that closes its bracket.
pub(crate) fn mates(atoms: &[Atom], mates: &mut Vec<u32>) {
    mates.clear();
    mates.resize(atoms.len(), 0);
    let mut open = Vec::new();
    for (at, atom) in atoms.iter().enumerate() {
        match atom.kind {
            Kind::OpenRound | Kind::LineRound | Kind::OpenSquare | Kind::LineSquare | Kind::OpenCurly => open.push(at),
            Kind::CloseRound | Kind::CloseSquare | Kind::CloseCurly => {
                if let Some(opener) = open.pop() {
                    mates[opener] = at as u32;
                }
            }
            _ => {}
        }
    }
}

impl<'a> CommandBuilder<'a> {
    pub fn new(atoms: &'a [Atom], mates: &'a [u32], cmds: &'a mut Vec<Cmd>) -> Self {
        cmds.clear();
        Self { atoms, mates, at: 0, cmds, operators: Vec::new() }
    }

    pub fn kind(&self, at: usize) -> Kind {
        self.atoms.get(at).map_or(Kind::Strange, |a| a.kind)
    }

    pub fn next(&self) -> Kind {
        self.kind(self.at)
    }

    pub fn mate(&self, at: usize) -> usize {
        self.mates.get(at).map_or(at, |&m| m as usize)
    }

    pub fn push(&mut self, cmd: Cmd) {
        self.cmds.push(cmd);
    }

    pub fn push_all(&mut self, cmds: &[Cmd]) {
        self.cmds.extend_from_slice(cmds);
    }

    /// A place where the line may end; a blank line that stands here is kept.
    pub fn break_or(&mut self, flat: u8) {
        let keep = self.atoms.get(self.at).is_some_and(|a| a.blank);
        self.push(Cmd::Break { flat, keep });
    }

    /// The next atom with the comments above it.
    pub fn text(&mut self) {
        if self.atoms.get(self.at).is_some_and(|a| !a.own.is_empty()) {
            self.push(Cmd::Own(self.at as u32));
        }
        self.push(Cmd::Text(self.at as u32));
        self.at += 1;
    }

    /// The next atom and a blank.
    pub fn word(&mut self) {
        self.text();
        self.push(Cmd::Blank);
    }

    /// An expression; `deeper` indents the lines that begin with its operators.
    pub fn expression(&mut self, deeper: bool) -> Form {
        let first = self.operators.len();
        self.survey();
        let form = self.level(first, self.operators.len(), deeper);
        self.operators.truncate(first);
        form
    }

    /// Notes the operators of the expression that begins here; gives the atom behind it.
    fn survey(&mut self) -> usize {
        let mut at = self.at;
        loop {
            while matches!(self.kind(at), Kind::Minus | Kind::Not) {
                at += 1;
            }
            match self.kind(at) {
                // They reach to the end.
                Kind::If | Kind::Let => return self.atoms.len(),
                Kind::OpenRound | Kind::LineRound | Kind::OpenSquare | Kind::LineSquare | Kind::OpenCurly => at = self.mate(at) + 1,
                _ => at += 1,
            }
            loop {
                match self.kind(at) {
                    Kind::Dot => at += 2,
                    Kind::OpenRound | Kind::OpenSquare => at = self.mate(at) + 1,
                    _ => break,
                }
            }
            let (operator, behind) = (self.kind(at), self.kind(at + 1));
            let is_key = behind == Kind::Colon;
            let open_end = operator == Kind::DotDot && behind == Kind::CloseSquare;
            if !operator.is_infix() || is_key || open_end {
                return at;
            }
            self.operators.push((at, strength(operator)));
            at += 1;
        }
    }

    /// Operands with the operators `from..to` between them, the loosest ones first.
    fn level(&mut self, from: usize, to: usize, deeper: bool) -> Form {
        let Some(weakest) = self.operators[from..to].iter().map(|o| o.1).min() else { return self.operand() };
        let tight = weakest > TIGHT || weakest == RUN;
        if !tight {
            self.push(Cmd::Open { force: false });
        }
        let mut start = from;
        for at in from..to {
            if self.operators[at].1 != weakest {
                continue;
            }
            self.level(start, at, true);
            if start == from && deeper && !tight {
                self.push(Cmd::In);
            }
            if tight {
                self.text();
            } else {
                self.push(Cmd::Break { flat: 1, keep: false });
                self.word();
            }
            start = at + 1;
        }
        self.level(start, to, true);
        if deeper && !tight {
            self.push(Cmd::Out);
        }
        if !tight {
            self.push(Cmd::Close);
        }
        Form::Open
    }

    fn operand(&mut self) -> Form {
        loop {
            match self.next() {
                Kind::Minus => self.text(),
                Kind::Not => self.word(),
                _ => break,
            }
        }
        let mut form = Form::Open;
        match self.next() {
            Kind::If => {
                self.choice();
                return Form::Open;
            }
            Kind::Let => {
                self.local();
                return Form::Open;
            }
            Kind::OpenRound | Kind::LineRound | Kind::OpenSquare | Kind::LineSquare | Kind::OpenCurly => {
                form = Form::Bracketed;
                self.bracket(Self::item);
            }
            _ => self.text(),
        }
        loop {
            // `5m/t` is one unit and `5m/t.x` divides, so the blank behind a number decides.
            let number = matches!(self.kind(self.at.wrapping_sub(1)), Kind::Number | Kind::Quantity);
            let next = &self.atoms.get(self.at);
            let apart = number && next.is_some_and(|a| a.gap > 0 || a.fresh || !a.before.is_empty());
            let postfix = matches!(self.next(), Kind::Dot | Kind::OpenRound | Kind::OpenSquare);
            if postfix && apart {
                self.push(Cmd::Blank);
            }
            match self.next() {
                Kind::Dot => {
                    self.text();
                    self.text();
                    form = Form::Open;
                }
                Kind::OpenRound => {
                    self.bracket(Self::item);
                    form = Form::Bracketed;
                }
                Kind::OpenSquare => {
                    self.bracket(Self::slice);
                    form = Form::Bracketed;
                }
                _ => return form,
            }
        }
    }

    /// `value` or `name: value` between two commas.
    pub fn item(&mut self) {
        if self.kind(self.at + 1) == Kind::Colon {
            self.text();
            self.word();
        }
        self.expression(true);
    }

    /// What stands in an index.
    fn slice(&mut self) {
        if self.next() == Kind::DotDot {
            self.text();
        }
        if self.next() != Kind::CloseSquare {
            self.expression(true);
        }
        if self.next() == Kind::DotDot {
            self.text();
        }
    }

    /// A bracket with what is between its commas.
    pub fn bracket(&mut self, item: fn(&mut Self)) {
        let (open, close) = (self.at, self.mate(self.at));
        if self.kind(open + 1) == Kind::For && matches!(self.next(), Kind::OpenSquare | Kind::LineSquare) {
            return self.comprehension(close);
        }
        self.text();
        if self.at == close && self.atoms[close].own.is_empty() {
            return self.text();
        }
        if self.is_lone(open, close) {
            item(self);
            return self.text();
        }
        let fill = self.is_plain(open, close);
        self.push_all(&[Cmd::Open { force: self.kind(close - 1) == Kind::Comma }, Cmd::In, Cmd::Break { flat: 0, keep: false }]);
        while self.at < close {
            item(self);
            if self.next() == Kind::Comma {
                self.text();
            }
            if self.at < close && fill {
                let fresh = self.atoms[self.at].fresh;
                self.push(Cmd::Fill { fresh });
            } else if self.at < close {
                self.break_or(1);
            }
        }
        self.closing(0);
    }

    /// The closing atom with the comments above it, and the end of its group.
    pub fn closing(&mut self, flat: u8) {
        if self.atoms.get(self.at).is_some_and(|a| !a.own.is_empty()) {
            self.break_or(flat);
            self.push(Cmd::Own(self.at as u32));
        }
        self.push_all(&[Cmd::Out, Cmd::Break { flat, keep: false }, Cmd::Text(self.at as u32), Cmd::Close]);
        self.at += 1;
    }

    /// Whether a bracket holds one thing that ends with a bracket, so that both can be opened and closed at once.
    fn is_lone(&mut self, open: usize, close: usize) -> bool {
        let here = self.at;
        let named = self.kind(open + 2) == Kind::Colon;
        let first = if named { open + 3 } else { open + 1 };
        let starts = !matches!(self.kind(first), Kind::If | Kind::Let | Kind::For | Kind::DotDot);
        let ends = matches!(self.kind(close - 1), Kind::CloseRound | Kind::CloseSquare | Kind::CloseCurly);
        let edges = [open, open + 1, close - 1, close];
        let bare = edges.iter().all(|&at| self.atoms[at].own.is_empty() && self.atoms[at].after.is_empty() || at == close);
        if !starts || !ends || !bare || !self.atoms[close].own.is_empty() {
            return false;
        }
        let operators = self.operators.len();
        self.at = first;
        let end = self.survey();
        let one = self.operators.len() == operators;
        self.operators.truncate(operators);
        self.at = here;
        one && end == close
    }

    /// Whether a list holds nothing but numbers, names, strings, and points made of them.
    fn is_plain(&self, open: usize, close: usize) -> bool {
        let begins = |at: usize| matches!(self.kind(at - 1), Kind::Comma | Kind::OpenRound | Kind::LineRound) || at == open + 1;
        let atom = |at: usize| match self.kind(at) {
            Kind::Number | Kind::Quantity | Kind::Name | Kind::Text | Kind::Comma | Kind::CloseRound => true,
            Kind::Minus | Kind::OpenRound | Kind::LineRound => begins(at),
            _ => false,
        };
        matches!(self.kind(open), Kind::OpenSquare | Kind::LineSquare)
            && (open + 1..close).all(|at| atom(at) && self.atoms[at].is_bare())
            && self.atoms[open].after.is_empty()
    }

    /// `[for i in list if c: body]`
    fn comprehension(&mut self, close: usize) {
        self.text();
        self.push_all(&[Cmd::Open { force: false }, Cmd::In, Cmd::Break { flat: 0, keep: false }]);
        while self.next() != Kind::Colon && self.at < close {
            if self.next() == Kind::For {
                self.for_clause();
            } else {
                self.word();
                self.expression(true);
            }
            if self.next() != Kind::Colon {
                self.push(Cmd::Break { flat: 1, keep: false });
            }
        }
        self.text();
        self.push_all(&[Cmd::In, Cmd::Break { flat: 1, keep: false }]);
        self.expression(true);
        self.push(Cmd::Out);
        self.closing(0);
    }

    /// `for i in list`
    pub fn for_clause(&mut self) {
        self.word();
        self.word();
        self.word();
        self.expression(true);
    }

    /// `if c then a else if d then b else e`, each `if` and the last `else` on a line of its own.
    fn choice(&mut self) {
        self.push(Cmd::Open { force: false });
        loop {
            self.word();
            self.expression(true);
            self.push_all(&[Cmd::Open { force: false }, Cmd::In, Cmd::Break { flat: 1, keep: false }]);
            self.word();
            self.expression(true);
            self.push_all(&[Cmd::Out, Cmd::Close, Cmd::Break { flat: 1, keep: false }]);
            self.word();
            if self.next() != Kind::If {
                break;
            }
        }
        self.expression(true);
        self.push(Cmd::Close);
    }

    /// `let x = a in let y = b in body`, each on a line of its own.
    fn local(&mut self) {
        self.push(Cmd::Open { force: false });
        while self.next() == Kind::Let {
            self.word();
            self.word();
            self.word();
            self.expression(true);
            self.push(Cmd::Blank);
            self.text();
            self.push(Cmd::Break { flat: 1, keep: false });
        }
        self.expression(false);
        self.push(Cmd::Close);
    }
}

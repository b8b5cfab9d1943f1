//! Declarations to commands.

use crate::lang::fmt::command::Cmd;
use crate::lang::fmt::expression::{CommandBuilder, Form};
use crate::lang::syntax::Kind;

/// Marks `{` of a clause; those of declarations are one more than their keyword's number.
const CLAUSE: u8 = 1;

impl CommandBuilder<'_> {
    /// The whole declaration.
    pub fn declaration(&mut self) {
        match self.next() {
            Kind::Use | Kind::Import => self.load(),
            Kind::Param | Kind::Fn | Kind::Let | Kind::Point | Kind::Curve | Kind::Modeling | Kind::Surface => self.binding(),
            Kind::Shell | Kind::Group | Kind::Mesh => self.collection(),
            Kind::Check | Kind::Report => self.statement(),
            Kind::Export | Kind::Picture => self.output(),
            _ => {
                self.word();
                self.push(Cmd::Open { force: false });
                self.things(true);
                self.push(Cmd::Close);
            }
        }
        self.push(Cmd::MarkEnd);
    }

    /// `use "ribs.loft" (height: 3m) as ribs`
    fn load(&mut self) {
        self.word();
        self.word();
        if self.next() == Kind::OpenRound || self.next() == Kind::LineRound {
            self.bracket(Self::item);
            self.push(Cmd::Blank);
        }
        self.word();
        self.text();
    }

    /// Keyword, name and what is bound to it.
    fn binding(&mut self) {
        let keyword = self.next();
        let kind = 2 + keyword as u8;
        self.word();
        if keyword == Kind::Modeling {
            self.word();
        }
        self.text();
        let simple = keyword != Kind::Fn && self.next() != Kind::For;
        if keyword == Kind::Fn {
            self.bracket(Self::parameter);
        }
        if self.next() == Kind::Colon {
            self.type_name();
        }
        while self.next() == Kind::For {
            self.push(Cmd::Blank);
            self.for_clause();
        }
        self.push(Cmd::Blank);
        if simple {
            let equals = &self.atoms[self.at];
            let wide = equals.gap > 1;
            self.push(Cmd::Mark { kind, wide });
        }
        self.text();
        self.value(keyword == Kind::Param);
    }

    /// `x: length = 3m` of an `fn`.
    fn parameter(&mut self) {
        self.text();
        if self.next() == Kind::Colon {
            self.type_name();
        }
        if self.next() == Kind::Equals {
            self.push(Cmd::Blank);
            self.word();
            self.expression(true);
        }
    }

    /// `: [length]`
    fn type_name(&mut self) {
        self.word();
        while matches!(self.next(), Kind::OpenSquare | Kind::LineSquare) {
            self.text();
        }
        self.text();
        while self.next() == Kind::CloseSquare {
            self.text();
        }
    }

    /// What stands behind `=` or `:`, on that line, in brackets that begin on it, or below it.
    fn value(&mut self, bounded: bool) {
        let start = self.cmds.len();
        self.push_all(&[Cmd::Open { force: false }, Cmd::In, Cmd::Break { flat: 1, keep: false }]);
        let commented = self.atoms.get(self.at).is_some_and(|a| !a.own.is_empty());
        let form = self.expression(false);
        if bounded && self.next() == Kind::In {
            self.push_all(&[Cmd::Open { force: false }, Cmd::In, Cmd::Break { flat: 1, keep: false }]);
            self.word();
            self.expression(true);
            if self.next() == Kind::To {
                self.push(Cmd::Blank);
                self.word();
                self.expression(true);
            }
            self.push_all(&[Cmd::Out, Cmd::Close]);
        }
        self.families();
        if form == Form::Bracketed && !commented {
            self.cmds[start] = Cmd::Nothing;
            self.cmds[start + 1] = Cmd::Nothing;
            self.cmds[start + 2] = Cmd::Blank;
        } else {
            self.push_all(&[Cmd::Out, Cmd::Close]);
        }
    }

    /// `for i in list` behind things.
    fn families(&mut self) {
        if self.next() != Kind::For {
            return;
        }
        self.push_all(&[Cmd::Open { force: false }, Cmd::In]);
        while self.next() == Kind::For {
            self.push(Cmd::Break { flat: 1, keep: false });
            self.for_clause();
        }
        self.push_all(&[Cmd::Out, Cmd::Close]);
    }

    /// Things with commas between them, each on a line of its own where they do not fit; `deeper` indents those
    /// lines.
    fn things(&mut self, deeper: bool) {
        self.expression(deeper);
        if deeper {
            self.push(Cmd::In);
        }
        while self.next() == Kind::Comma {
            self.text();
            self.break_or(1);
            self.expression(true);
        }
        if deeper {
            self.push(Cmd::Out);
        }
    }

    /// `shell`, `group`, `mesh`.
    fn collection(&mut self) {
        self.word();
        self.word();
        while self.next() == Kind::For {
            self.for_clause();
            self.push(Cmd::Blank);
        }
        self.text();
        let start = self.cmds.len();
        self.push_all(&[Cmd::Open { force: false }, Cmd::In, Cmd::Break { flat: 1, keep: false }]);
        let first = self.at;
        let form = self.expression(false);
        if form == Form::Bracketed && self.next() != Kind::Comma && self.atoms[first].own.is_empty() {
            self.cmds[start] = Cmd::Nothing;
            self.cmds[start + 1] = Cmd::Nothing;
            self.cmds[start + 2] = Cmd::Blank;
            if self.next() == Kind::OpenCurly {
                self.push(Cmd::Blank);
            }
        } else {
            while self.next() == Kind::Comma {
                self.text();
                self.break_or(1);
                self.expression(true);
            }
            self.push(Cmd::Out);
            if self.next() == Kind::OpenCurly {
                self.push(Cmd::Break { flat: 1, keep: false });
            }
            self.push(Cmd::Close);
        }
        if self.next() == Kind::OpenCurly {
            self.settings();
        }
    }

    /// `check`, `report`.
    fn statement(&mut self) {
        self.text();
        if self.next() == Kind::Text && self.kind(self.at + 1) == Kind::Colon {
            self.push(Cmd::Blank);
            self.text();
            self.text();
        } else {
            self.push(Cmd::Blank);
            self.push(Cmd::Open { force: false });
            self.things(true);
            self.push(Cmd::Close);
            return self.families();
        }
        if self.has_comma() {
            self.push_all(&[Cmd::Open { force: false }, Cmd::In, Cmd::Break { flat: 1, keep: false }]);
            self.things(false);
            self.families();
            self.push_all(&[Cmd::Out, Cmd::Close]);
        } else {
            self.value(false);
        }
    }

    /// Whether a comma stands in the rest outside of brackets.
    fn has_comma(&self) -> bool {
        let mut at = self.at;
        while at < self.atoms.len() {
            match self.kind(at) {
                Kind::Comma => return true,
                Kind::OpenRound | Kind::LineRound | Kind::OpenSquare | Kind::LineSquare | Kind::OpenCurly => at = self.mate(at),
                _ => {}
            }
            at += 1;
        }
        false
    }

    /// `export`, `picture`.
    fn output(&mut self) {
        self.word();
        self.push(Cmd::Open { force: false });
        self.things(true);
        self.push(Cmd::Close);
        self.families();
        self.push_all(&[Cmd::Open { force: false }, Cmd::In, Cmd::Break { flat: 1, keep: false }]);
        self.word();
        self.text();
        self.push_all(&[Cmd::Out, Cmd::Close]);
        if self.next() == Kind::OpenCurly {
            self.push(Cmd::Blank);
            self.settings();
        }
    }

    /// `{ key: value  key: value }`, on one line when it was, else each on a line of its own.
    fn settings(&mut self) {
        let (open, close) = (self.at, self.mate(self.at));
        self.text();
        if self.at == close && self.atoms[close].own.is_empty() {
            return self.text();
        }
        let force = self.has_lines(open, close);
        self.push_all(&[Cmd::Open { force }, Cmd::In, Cmd::Break { flat: 1, keep: false }]);
        while self.at < close {
            self.entry();
            let mut flat = 2;
            if self.next() == Kind::Comma {
                self.text();
                flat = 1;
            }
            if self.at < close {
                self.break_or(flat);
            }
        }
        self.closing(1);
    }

    /// Whether a line ends directly in a settings block.
    fn has_lines(&self, open: usize, close: usize) -> bool {
        let mut at = open + 1;
        while at < close {
            if self.atoms[at].fresh {
                return true;
            }
            at = if self.mate(at) > at { self.mate(at) } else { at } + 1;
        }
        self.atoms[close].fresh
    }

    /// A setting or a clause.
    fn entry(&mut self) {
        let clause = matches!(self.next(), Kind::On | Kind::Near | Kind::In) && self.kind(self.at + 1) != Kind::Colon;
        if !clause {
            self.text();
            self.word();
            self.expression(true);
            return;
        }
        self.word();
        self.push(Cmd::Open { force: false });
        self.things(true);
        self.push_all(&[Cmd::Close, Cmd::Blank]);
        let curly = &self.atoms[self.at];
        let wide = curly.gap > 1;
        self.push(Cmd::Mark { kind: CLAUSE, wide });
        self.settings();
        self.push(Cmd::MarkEnd);
    }
}

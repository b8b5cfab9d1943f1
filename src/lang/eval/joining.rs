//! Help for borders and chains with a gap: the declared curve that fills it, and the whole call with it.

use glam::DVec3;

use crate::base::fault::{Edit, Fault, Say};
use crate::base::tolerance::Tolerance;
use crate::lang::diag::diagnostic::Diagnostic;
use crate::lang::diag::diagnostic::Fix;
use crate::lang::diag::span::Span;
use crate::lang::eval::bind::Blame;
use crate::lang::eval::context::Cx;
use crate::lang::eval::faults::member_name;
use crate::lang::eval::machine::Code;
use crate::lang::eval::module::State;
use crate::lang::syntax::ast::{Expr, ExprId};
use crate::lang::values::origins::NO_MEMBER;
use crate::lang::values::value::{ModuleId, Value};
use crate::network::Chain;
use crate::network::fault::{ChainFault, CurveEnd, EndFault};

/// Most characters of a call that is typed out in a help.
const SHOWN: usize = 120;

/// A declared curve, or a run of one, from one end of a gap to the other.
struct GapFiller {
    /// As it is typed, in the direction from the first end to the second.
    typed: String,
    /// The same whatever its direction.
    name: String,
    /// Where it starts and ends, for a run of a longer curve.
    run: Option<(String, String)>,
}

impl Cx<'_> {
    /// Puts the curve that fills a gap into the help of E502 and E503, where the script declares one.
    pub(crate) fn advise(&self, fault: &Fault, code: Code<'_>, id: ExprId, blame: &Blame, diagnostic: &mut Diagnostic) {
        let Some(tolerance) = self.tolerance else { return };
        let (a, b, ordered) = match (fault.of(), fault.of()) {
            (Some(EndFault::BoundaryOpen { a, b, .. }), _) => (a, b, false),
            (_, Some(ChainFault::Broken { a, b, reversed_fits: false, snaps: false, .. })) => (a, b, true),
            _ => return,
        };
        let Some(filler) = self.filler(code.module, (a, b), &tolerance) else { return };
        let what = match &filler.run {
            Some((from, to)) => format!("`{}` runs from {from} to {to}", filler.typed),
            None => format!("`{}` joins them", filler.name),
        };
        let file = self.machine.at(code.module).file;
        let put = if ordered || filler.run.is_some() { &filler.typed } else { &filler.name };
        let Some((span, text)) = self.inserted(code, id, blame, (a, b), put, ordered) else {
            diagnostic.help = Some(what);
            return;
        };
        let whole = code.span(id);
        let source = self.program.sources.text(file, whole);
        let (before, behind) = ((span.start - whole.start) as usize, (span.end - whole.start) as usize);
        let call = format!("{}{text}{}", &source[..before], &source[behind..]);
        let short = call.chars().count() <= SHOWN && !call.contains(['\n', '`']);
        diagnostic.help = Some(if short { format!("{what}: `{call}`") } else { what });
        diagnostic.fixes.push(Fix { file, span, edit: Edit::Put(text) });
    }

    /// The part of a call that is replaced, and what by, so that a curve follows the first end or comes before the second.
    fn inserted(
        &self,
        code: Code<'_>,
        id: ExprId,
        blame: &Blame,
        (a, b): (&CurveEnd, &CurveEnd),
        put: &str,
        ordered: bool,
    ) -> Option<(Span, String)> {
        let (file, whole) = (self.machine.at(code.module).file, code.span(id));
        if let (true, Expr::Binary { a: left, .. }) = (ordered, code.expr(id)) {
            let span = code.span(*left);
            return Some((span, format!("{} + {put}", self.program.sources.text(file, span))));
        }
        let stands = |name: &str| {
            let at = blame.items.iter().map(|item| item.1);
            at.filter(|s| !name.is_empty() && s.start >= whole.start && s.end <= whole.end)
                .find(|s| self.program.sources.text(file, *s) == name)
        };
        let (first, second) = (self.name(a.of), self.name(b.of));
        match stands(&first) {
            Some(span) => Some((span, format!("{first}, {put}"))),
            None => stands(&second).map(|span| (span, format!("{put}, {second}"))),
        }
    }

    /// The first declared curve that runs from one end of a gap to the other, else the first that passes both.
    fn filler(&self, module: ModuleId, (a, b): (&CurveEnd, &CurveEnd), tolerance: &Tolerance) -> Option<GapFiller> {
        let given = [self.name(a.of), self.name(b.of)];
        let mut curves: Vec<(String, Chain)> = Vec::new();
        self.each_declared(module, &mut |name, value| {
            if let Value::Curve(chain) = value
                && !given.contains(&name)
            {
                curves.push((name, chain.clone()));
            }
        });
        let same = |p: DVec3, q: DVec3| tolerance.same_point(p, q);
        let whole = curves.iter().find_map(|(name, c)| {
            let forwards = same(c.start(), a.at) && same(c.end(), b.at);
            let backwards = same(c.start(), b.at) && same(c.end(), a.at);
            let typed = if forwards { name.clone() } else { format!("-{name}") };
            (forwards || backwards).then(|| GapFiller { typed, name: name.clone(), run: None })
        });
        whole.or_else(|| {
            let passes = |c: &Chain, p: DVec3| c.closest(p).2 <= tolerance.point;
            let (name, _) = curves.iter().find(|(_, c)| passes(c, a.at) && passes(c, b.at))?;
            let (from, to) = (self.place_name(module, a, tolerance)?, self.place_name(module, b, tolerance)?);
            Some(GapFiller { typed: format!("{name}[{from}..{to}]"), name: name.clone(), run: Some((from, to)) })
        })
    }

    /// How an end of a curve is typed: a declared point, or the end of the curve by its name.
    fn place_name(&self, module: ModuleId, end: &CurveEnd, tolerance: &Tolerance) -> Option<String> {
        let mut found = None;
        self.each_declared(module, &mut |name, value| {
            if let Value::Vector(p, _) | Value::Node(p) = value
                && found.is_none()
                && tolerance.same_point(*p, end.at)
            {
                found = Some(name);
            }
        });
        let curve = self.name(end.of);
        let plain = !curve.is_empty() && curve.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '[' | ']'));
        found.or_else(|| plain.then(|| format!("{curve}.{}", if end.last { "end" } else { "start" })))
    }

    /// Goes over what a script declares and has evaluated, in order, members of families one by one.
    fn each_declared(&self, module: ModuleId, each: &mut dyn FnMut(String, &Value)) {
        let module = self.machine.at(module);
        for (at, state) in module.states.iter().enumerate() {
            let (Some(b), State::Done(value)) = (module.script.declarations.bound(at), state) else { continue };
            let name = self.program.names.text(b.name);
            match value {
                Value::List(items) => {
                    for (k, item) in items.iter().enumerate() {
                        each(member_name(name, [k as u32, NO_MEMBER]), item);
                    }
                }
                one => each(name.to_owned(), one),
            }
        }
    }
}

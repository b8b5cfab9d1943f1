//! What was probably meant by names that nothing binds: looked for when a run is over, in order of place and for the first of
//! them alone, so that neither their number times the number of names is the work, nor the order of the evaluation tells.

use ::std::collections::{BTreeMap, BTreeSet};

use crate::base::fault::Edit;
use crate::base::limits::REPORTS_SHOWN;
use crate::lang::diag::diagnostic::Fix;
use crate::lang::diag::diagnostic::{Diagnostic, FileId};
use crate::lang::diag::span::Span;
use crate::lang::eval::context::Cx;
use crate::lang::eval::std;
use crate::lang::eval::unbound::keyword_word;
use crate::lang::syntax::ast::Keyword;
use crate::lang::values::value::ModuleId;
use crate::lang::words::elsewhere::meant;
use crate::lang::words::lookalikes;
use crate::lang::words::names::{Name, nearest};

/// Names that unknown ones are compared with in a run, beyond those of the reports that a screen shows in full.
pub(crate) const NAMES_COMPARED: usize = 50_000;

/// Among which names the one that was meant is.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Among {
    /// What has a value in a script, and these names of the place.
    Values(Vec<Name>),
    /// Functions of the language and of a script.
    Functions,
    /// What a module declares.
    Members,
}

/// A name that nothing binds, and the script where one of that kind was looked for.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Unknown {
    pub name: Name,
    pub of: ModuleId,
    pub among: Among,
}

/// The unknown names of a run by place.
pub(crate) type Unknowns = BTreeMap<(FileId, Span), Unknown>;

/// A name in sight, with keyword and line where it is a declared value.
type Near = Option<(String, Option<(&'static str, usize)>)>;

impl Cx<'_> {
    /// Notes that the report about a stretch of a file is to say what was meant.
    pub(crate) fn note_unknown(&mut self, module: ModuleId, span: Span, unknown: Unknown) {
        let file = self.machine.at(module).file;
        self.machine.unknown.insert((file, span), unknown);
    }

    /// Says in reports about unknown names what was meant.
    pub(crate) fn tell_meant<T>(&mut self, filed: &mut [(T, Diagnostic)]) {
        let unknown = ::std::mem::take(&mut self.machine.unknown);
        let asked = |d: &Diagnostic| {
            let label = d.labels.first().filter(|_| matches!(d.code.0, "E201" | "E214"))?;
            unknown.get(&(label.file, label.span))
        };
        let mut found: Vec<(&mut Diagnostic, &Unknown)> = filed.iter_mut().filter_map(|f| asked(&f.1).map(|u| (&mut f.1, u))).collect();
        found.sort_by_key(|f| f.0.place());
        let (mut known, mut told, mut compared) = (BTreeMap::<&Unknown, Near>::new(), BTreeSet::new(), 0);
        for (diagnostic, unknown) in found {
            let is_shown = told.len() < REPORTS_SHOWN && told.insert(diagnostic.message.clone());
            if !known.contains_key(unknown) && (is_shown || compared < NAMES_COMPARED) {
                let (near, count) = self.near_name(unknown);
                compared += count;
                known.insert(unknown, near);
            }
            match known.get(unknown) {
                Some(Some(near)) => self.offer_near(diagnostic, unknown, near),
                Some(None) => self.offer_script(diagnostic, unknown),
                None => {}
            }
        }
    }

    fn offer_near(&self, diagnostic: &mut Diagnostic, unknown: &Unknown, (near, declared): &(String, Option<(&'static str, usize)>)) {
        let Some(label) = diagnostic.labels.first_mut() else { return };
        diagnostic.fixes.push(Fix { file: label.file, span: label.span, edit: Edit::Put(near.clone()) });
        if unknown.among == Among::Members {
            diagnostic.help = Some(format!("`{}.{near}`", self.machine.at(unknown.of).label));
            return;
        }
        label.text = match declared {
            Some((keyword, line)) => format!("did you mean `{near}` ({keyword}, line {line})?"),
            None => format!("did you mean `{near}`?"),
        };
        diagnostic.notes.extend(lookalikes::difference(self.program.names.text(unknown.name), near));
    }

    /// Help that takes a script of that name for a module, where there is one.
    fn offer_script(&self, diagnostic: &mut Diagnostic, unknown: &Unknown) {
        let name = self.program.names.text(unknown.name);
        let is_file = || self.files.resolve(&self.machine.at(unknown.of).path, &format!("{name}.loft")).is_ok();
        let Some(label) = diagnostic.labels.first() else { return };
        if matches!(unknown.among, Among::Values(_)) && is_file() {
            let what = format!("\"{name}.loft\" as {name}");
            diagnostic.help = Some(format!("use {what}"));
            diagnostic.fixes.push(Fix { file: label.file, span: label.span, edit: Edit::Declare("use", what) });
        }
    }

    /// The nearest name, and the number of those compared.
    fn near_name(&self, unknown: &Unknown) -> (Near, usize) {
        let (m, text) = (self.machine.at(unknown.of), self.program.names.text(unknown.name));
        let script = &m.script.declarations;
        let bound = |functions: bool| {
            (0..script.len())
                .filter(move |at| (script.keyword(*at) == Keyword::Fn) == functions)
                .filter_map(|at| Some((at, script.bound(at)?)))
        };
        let named = |names: &[&str]| (meant(text, names.iter().copied()).map(|near| (near.to_owned(), None)), names.len());
        match &unknown.among {
            Among::Members => named(&m.names().map(|n| self.program.names.text(n)).collect::<Vec<_>>()),
            Among::Functions => {
                let own = bound(true).map(|(_, b)| self.program.names.text(b.name));
                named(&std::builtins().chain(std::fields()).map(|b| b.name).chain(own).collect::<Vec<_>>())
            }
            Among::Values(locals) => {
                let values = bound(false);
                let words = ["true", "false", "none", "pi"].into_iter().filter(|w| w.eq_ignore_ascii_case(text));
                let names = words.chain(locals.iter().map(|n| self.program.names.text(*n)));
                let mut names: Vec<&str> = names.collect();
                names.extend(values.clone().map(|v| self.program.names.text(v.1.name)));
                let near = nearest(text, names.iter().copied()).map(|near| {
                    let mut places = values.filter(|v| self.program.names.text(v.1.name) == near);
                    let line = |at: u32| self.program.sources.place(m.file, at).map_or(1, |p| p.line);
                    (near.to_owned(), places.next().map(|(at, b)| (keyword_word(script.keyword(at)), line(b.span.start))))
                });
                (near, names.len())
            }
        }
    }
}

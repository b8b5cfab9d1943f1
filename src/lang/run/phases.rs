//! A run from the first declaration to the last report: phases around the tolerance, and what is said in the end.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::base::fault::{Say, Severity};
use crate::base::tolerance::{EPSILON, Tolerance};
use crate::lang::declare::params::TableRow;
use crate::lang::diag::diagnostic;
use crate::lang::diag::diagnostic::Diagnostic;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::Code;
use crate::lang::eval::module::{Stage, State};
use crate::lang::eval::sink::SAID_JUST_NOW;
use crate::lang::eval::stages;
use crate::lang::syntax::ast::{DeclarationKind, ExprId, Keyword};
use crate::lang::values::plans::{CheckResult, ExportSpec, PictureSpec, ReportTable};
use crate::lang::values::types::Ty;
use crate::lang::values::units;
use crate::lang::values::value::{Dim, ModuleId, Value};

/// Names listed in a note about what was not built.
const NAMES_LISTED: usize = 12;
/// The tolerance of a model without points, in millimetres.
const FALLBACK_MM: f64 = 0.001;

/// The main script of a run.
pub struct Entry<'e> {
    /// As the user knows it: `hall.loft`, `<stdin>`.
    pub name: &'e str,
    /// Resolved path that its imports are beside.
    pub path: &'e str,
    /// Its text.
    pub text: Arc<str>,
    /// Params set from outside: name and the text of a literal.
    pub sets: &'e [(String, String)],
    /// The row of a table of variants that sets some of them.
    pub row: Option<&'e TableRow>,
}

/// A tolerance as it is written.
struct WrittenTolerance {
    /// Model units.
    point: f64,
    /// Radians.
    angle: Option<f64>,
    /// Declaration and expression of the length.
    at: (u32, ExprId),
}

impl Cx<'_> {
    /// Parses the main script. What is wrong with it is found in [`Cx::finish`].
    pub fn load(&mut self, entry: Entry) {
        let main = self.add_module(entry.name, entry.path, entry.text, String::new(), None);
        self.program.unit = self.machine.at(main).unit;
        self.give_all(main, entry.sets, entry.row);
    }

    /// Evaluates every declaration: first what needs no tolerance, then the tolerance, then the rest.
    pub fn evaluate_all(&mut self) {
        self.evaluate_shaped(None);
    }

    /// The same; `shaped` is shown the model when the geometry and the shells of the script are evaluated, before the rest is.
    pub fn evaluate_shaped(&mut self, shaped: Option<&mut dyn FnMut(&mut Self)>) {
        let said = self.said_tolerance();
        self.pass();
        self.fix_tolerance(said);
        self.snap();
        for module in &mut self.machine.modules {
            for state in &mut module.states {
                if matches!(state, State::Suspended) {
                    *state = State::Waiting;
                }
            }
        }
        if let Some(shaped) = shaped {
            self.evaluate_shapes();
            shaped(self);
        }
        self.pass();
    }

    /// Evaluates what waits, in all modules; more modules may turn up on the way.
    fn pass(&mut self) {
        let mut m = 0;
        while m < self.machine.modules.len() {
            let module = ModuleId::at(m);
            // Scripts get their numbers in order of writing, whatever asks for them first.
            for i in self.heads(module, Keyword::Use) {
                if matches!(self.machine.at(module).states[i as usize], State::Waiting) {
                    self.ensure_all(module, i);
                }
            }
            for i in 0..self.machine.at(module).states.len() {
                if self.job.go_on().is_err() {
                    return;
                }
                if matches!(self.machine.at(module).states[i], State::Waiting) {
                    self.ensure_all(module, i as u32);
                }
            }
            m += 1;
        }
    }

    /// The only declaration of a head keyword; further ones are reported.
    pub(crate) fn single(&mut self, module: ModuleId, keyword: Keyword) -> Option<u32> {
        let found = self.heads(module, keyword);
        let script = self.machine.at(module).script.clone();
        let file = self.machine.at(module).file;
        for again in found.iter().skip(1) {
            let (first, second) = (script.declarations.keyword_span(found[0] as usize), script.declarations.keyword_span(*again as usize));
            let word = crate::lang::eval::unbound::keyword_word(keyword);
            let diagnostic = Diagnostic::new("E202", format!("`{word}` may be declared only once"), file, second, "again here").label(
                file,
                first,
                "first here",
            );
            self.machine.filed.push((Some((module, *again)), diagnostic));
        }
        found.first().copied()
    }

    /// Evaluates expressions of a head line outside any other declaration.
    pub(crate) fn head(&mut self, module: ModuleId, index: u32, values: &[(ExprId, Ty, &str)]) -> Option<Vec<Value>> {
        let script = self.machine.at(module).script.clone();
        let declaration = script.declarations.whole(index as usize);
        let code = Code { nodes: &declaration.nodes, module, declaration: index };
        self.machine.site.module = module;
        self.machine.site.declaration = index;
        let mut out = Vec::with_capacity(values.len());
        for (expr, ty, subject) in values {
            match self.eval_as(code, *expr, *ty, subject) {
                Ok(Value::Number(q)) if q.value <= 0.0 => {
                    let found = self.quantity(q);
                    self.error(code, "E306", format!("{subject} must be more than 0, got {found}"), code.span(*expr), found).say();
                }
                Ok(value) => out.push(value),
                Err(Halt::NotYet) => {
                    let text = format!("{subject} cannot depend on what depends on the tolerance");
                    self.error(code, "E203", text, code.span(*expr), "needs the tolerance").say();
                }
                Err(stop) => {
                    self.settle(code, stop, code.span(*expr));
                }
            }
        }
        let said = std::mem::take(&mut self.sink.reports);
        self.machine.filed.extend(said.into_iter().map(|d| (Some((module, index)), d)));
        (out.len() == values.len()).then_some(out)
    }

    /// `tolerance 0.001mm, 0.5deg`: lengths in model units, angles in radians.
    fn said_tolerance(&mut self) -> Option<WrittenTolerance> {
        let index = self.single(ModuleId::MAIN, Keyword::Tolerance)?;
        let script = self.machine.at(ModuleId::MAIN).script.clone();
        let declaration = script.declarations.whole(index as usize);
        let DeclarationKind::Tolerance(exprs) = &declaration.kind else { return None };
        let wanted = [(Ty::Quantity(Dim::LENGTH), "the tolerance"), (Ty::Quantity(Dim::ANGLE), "the angle of kinks")];
        let values: Vec<(ExprId, Ty, &str)> = exprs.iter().zip(wanted).map(|(e, (ty, s))| (*e, ty, s)).collect();
        if let Some(extra) = exprs.get(2) {
            let code = Code { nodes: &declaration.nodes, module: ModuleId::MAIN, declaration: index };
            self.error(code, "E302", "a tolerance is a length and an angle", code.span(*extra), "one too many").say();
        }
        let values = self.head(ModuleId::MAIN, index, &values)?;
        let number = |i: usize| match values.get(i) {
            Some(Value::Number(q)) => Some(q.value),
            _ => None,
        };
        Some(WrittenTolerance { point: number(0)?, angle: number(1).map(units::radians), at: (index, exprs[0]) })
    }

    /// The tolerance that is written, or the one for the size of the model. E306 for one that rounding does not keep; the smallest one that
    /// it does is gone on with.
    fn fix_tolerance(&mut self, said: Option<WrittenTolerance>) {
        let (diagonal, furthest) = (self.seen.diagonal(), self.seen.furthest());
        let Some(WrittenTolerance { point, angle, at: (index, expr) }) = said else {
            let fallback = units::convert(FALLBACK_MM, units::MILLIMETRE, self.program.unit, 1);
            self.tolerance = Some(Tolerance::from_diagonal(diagonal, fallback).at_distance(furthest));
            return;
        };
        let mut tolerance = Tolerance::new(point, diagonal).at_distance(furthest);
        // Far from the origin the coordinates round more than the size does.
        let (least, is_far) = if tolerance.point > point { (tolerance.point, true) } else { (EPSILON * diagonal, false) };
        if least > point && least.is_finite() {
            let (shown, found) = (self.length(least), self.length(point));
            let script = self.machine.at(ModuleId::MAIN).script.clone();
            let declaration = script.declarations.whole(index as usize);
            let code = Code { nodes: &declaration.nodes, module: ModuleId::MAIN, declaration: index };
            let text = format!("the tolerance must be at least {shown}, got {found}");
            let (size, reaches) = if is_far { (furthest, "from the origin") } else { (diagonal, "across") };
            let why = format!("the model is {} {reaches}, and rounding moves its points by up to 1e-14 of that", self.length(size));
            self.error(code, "E306", text, code.span(expr), found).note(why).say();
            let said = std::mem::take(&mut self.sink.reports);
            self.machine.filed.extend(said.into_iter().map(|d| (Some((ModuleId::MAIN, index)), d)));
            tolerance = Tolerance::new(least, diagonal).at_distance(furthest);
        }
        self.tolerance = Some(angle.map_or(tolerance, |angle| tolerance.with_angle(angle)));
    }

    /// Everything said, in order of place: what was skipped is noted at its cause, equal reports are counted.
    pub fn finish(&mut self) -> Vec<Diagnostic> {
        let rest = std::mem::take(&mut self.sink.reports);
        self.machine.filed.extend(rest.into_iter().map(|d| (None, d)));
        self.idle_tolerances();
        let (skipped, unmeshed, without) = (self.skipped(), self.unmeshed(), self.meshed_without());
        let mut filed = std::mem::take(&mut self.machine.filed);
        self.tell_meant(&mut filed);
        let mut out: Vec<Diagnostic> = Vec::with_capacity(filed.len());
        let mut noted = BTreeSet::new();
        for (owner, mut diagnostic) in filed {
            if let Some(owner) = owner
                && diagnostic.severity() == Severity::Error
                && noted.insert(owner)
            {
                diagnostic.notes.extend(skipped.get(&owner).map(|members| self.not_built(owner, members)));
                diagnostic.notes.extend(unmeshed.get(&owner).map(|names| told("not meshed either, since the model is incomplete", names)));
                let name = || self.declaration_name(owner.0, owner.1);
                diagnostic.notes.extend(without.get(&owner).map(|names| told(&format!("meshed without `{}`", name()), names)));
            }
            match out.iter_mut().rev().take(SAID_JUST_NOW).find(|d| d.is_like(&diagnostic)) {
                Some(found) => found.fold(diagnostic, self.sink.whole),
                None => out.push(diagnostic),
            }
        }
        diagnostic::sort(&mut out);
        out
    }

    /// W222 for each module with a tolerance of its own: all of a model has one.
    fn idle_tolerances(&mut self) {
        for m in 1..self.machine.modules.len() {
            let script = self.machine.modules[m].script.clone();
            for index in script.declarations.with_keyword(Keyword::Tolerance) {
                let declaration = script.declarations.whole(index);
                let code = Code { nodes: &declaration.nodes, module: ModuleId::at(m), declaration: index as u32 };
                let point = self.tolerance.map_or(0.0, |t| t.point);
                let text = format!("the tolerance of this module has no effect: the main script's, {}, applies", self.length(point));
                self.error(code, "W222", text, declaration.span, "applies only where this script is run itself").say();
            }
        }
        let said = std::mem::take(&mut self.sink.reports);
        self.machine.filed.extend(said.into_iter().map(|d| (None, d)));
    }

    /// For each failed declaration what was skipped because of it.
    fn skipped(&self) -> BTreeMap<(ModuleId, u32), Vec<(ModuleId, u32)>> {
        let mut out: BTreeMap<(ModuleId, u32), Vec<(ModuleId, u32)>> = BTreeMap::new();
        for (m, module) in self.machine.modules.iter().enumerate() {
            for (i, state) in module.states.iter().enumerate() {
                let State::Skipped(cm, cd) = state else { continue };
                if self.machine.in_cycle.contains(&(ModuleId::at(m), i as u32)) {
                    continue;
                }
                out.entry((*cm, *cd)).or_default().push((ModuleId::at(m), i as u32));
            }
        }
        out
    }

    /// For each failed declaration the meshes of other things that were not made because of it.
    fn unmeshed(&self) -> BTreeMap<(ModuleId, u32), Vec<String>> {
        let mut out: BTreeMap<(ModuleId, u32), Vec<String>> = BTreeMap::new();
        for module in &self.machine.modules {
            for (spec, stage) in module.meshes.iter().zip(&module.mesh_stages) {
                if let Stage::Skipped(m, d) = stage {
                    out.entry((*m, *d)).or_default().push(spec.name.to_string());
                }
            }
        }
        out
    }

    /// For each failed declaration the meshes that were made of what is sound.
    fn meshed_without(&self) -> BTreeMap<(ModuleId, u32), Vec<String>> {
        let made = |module: &crate::lang::eval::module::Module| {
            let pairs = module.meshes.iter().zip(&module.mesh_stages);
            pairs.filter(|(_, stage)| matches!(stage, Stage::Done(_))).map(|(spec, _)| spec.name.to_string()).collect::<Vec<_>>()
        };
        let mut out: BTreeMap<(ModuleId, u32), Vec<String>> = BTreeMap::new();
        for module in &self.machine.modules {
            if let (Some(owner), names) = (module.lacks, made(module))
                && !names.is_empty()
            {
                out.entry(owner).or_default().extend(names);
            }
        }
        out
    }

    /// "nothing that depends on `SE` was built: south, east, roof (2 curves, 1 surface, 1 mesh)".
    fn not_built(&self, owner: (ModuleId, u32), members: &[(ModuleId, u32)]) -> String {
        let named = |(m, d): &&(ModuleId, u32)| self.machine.at(*m).script.declarations.bound(*d as usize).is_some();
        let names: Vec<String> = members.iter().filter(named).take(NAMES_LISTED + 1).map(|(m, d)| self.declaration_name(*m, *d)).collect();
        let list = match names.len() {
            0 => String::new(),
            n if n > NAMES_LISTED => format!(": {}, …", names[..NAMES_LISTED].join(", ")),
            _ => format!(": {}", names.join(", ")),
        };
        format!("nothing that depends on `{}` was built{list} ({})", self.declaration_name(owner.0, owner.1), self.count_words(members))
    }

    /// Which of a script's meshes has a name, from 1, and how many are declared so far.
    pub fn place_of_mesh(&self, module: ModuleId, name: &str) -> (usize, usize) {
        self.machine.place_of_mesh(module, name)
    }

    /// Whether anything said so far is an error.
    pub fn has_errors(&self) -> bool {
        self.machine.filed.iter().map(|f| &f.1).chain(&self.sink.reports).any(|d| d.severity() == Severity::Error)
    }

    /// Whether anything said so far is a warning.
    pub fn has_warnings(&self) -> bool {
        self.machine.filed.iter().map(|f| &f.1).chain(&self.sink.reports).any(|d| d.severity() == Severity::Warning)
    }

    /// The tolerance that was fixed, for showing it.
    pub fn tolerance_used(&self) -> Option<Tolerance> {
        self.tolerance
    }

    /// Results of all checks, modules' included, in order of declaration.
    pub fn checks(&self) -> Vec<CheckResult> {
        let mut out = Vec::new();
        for module in &self.machine.modules {
            let mut checks: Vec<&(u32, CheckResult)> = module.checks.iter().collect();
            checks.sort_by_key(|c| c.0);
            out.extend(checks.into_iter().map(|c| c.1.clone()));
        }
        out
    }

    /// Reports of the main script in order of declaration.
    pub fn reports(&self) -> Vec<ReportTable> {
        in_order(self.machine.modules.first().map_or(&[], |m| &m.reports))
    }

    /// Exports of the main script in order of declaration.
    pub fn exports(&self) -> Vec<ExportSpec> {
        in_order(self.machine.modules.first().map_or(&[], |m| &m.exports))
    }

    /// Pictures of the main script in order of declaration.
    pub fn pictures(&self) -> Vec<PictureSpec> {
        in_order(self.machine.modules.first().map_or(&[], |m| &m.pictures))
    }

    /// The declared meshes of the main script, in order of declaration, as values for [`Cx::mesh`].
    pub fn mesh_values(&self) -> Vec<(Arc<str>, crate::lang::values::value::MeshValue)> {
        let mut out = Vec::new();
        if let Some(module) = self.machine.modules.first() {
            stages::each_member(module, &self.program.names, &[Keyword::Mesh], &mut |_, _, _, name, value| {
                if let Value::Mesh(mesh) = value {
                    out.push((name, (**mesh).clone()));
                }
            });
        }
        out
    }

    /// The value of a name of the main script; `None` when it has none or failed.
    pub fn value_of(&self, name: &str) -> Option<Value> {
        let module = self.machine.modules.first()?;
        match &module.states[module.find(self.program.names.find(name)?)? as usize] {
            State::Done(value) => Some(value.clone()),
            _ => None,
        }
    }
}

fn in_order<T: Clone>(found: &[(u32, T)]) -> Vec<T> {
    let mut found: Vec<&(u32, T)> = found.iter().collect();
    found.sort_by_key(|f| f.0);
    found.into_iter().map(|f| f.1.clone()).collect()
}

/// "meshed without `bad`: roof, wall, …".
fn told(what: &str, names: &[String]) -> String {
    let more = if names.len() > NAMES_LISTED { ", …" } else { "" };
    format!("{what}: {}{more}", names[..names.len().min(NAMES_LISTED)].join(", "))
}

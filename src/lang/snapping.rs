//! `snap 4mm`: moves ends of measured curves once, and what was made from the curves before is made again.
//!
//! A script that snaps has two sets of keys. Before it, a declaration's key is made of what it is written with, as
//! everywhere. Afterwards a curve goes by that key and what became of it, and everything else by its own key and those of
//! what it names, so that nothing of before is taken for something of afterwards.

use std::collections::BTreeSet;

use super::cx::Cx;
use super::eval::Code;
use super::memory::Keys;
use super::module::{State, bound};
use super::stages;
use super::syntax::ast::{DeclarationKind, Expr, ExprId, Keyword, Node};
use super::types::Ty;
use super::value::{Dim, ModuleId, Value};
use crate::base::digest::{Digest, Digester};
use crate::network::Chain;

impl Cx<'_> {
    /// `snap 4mm` of each script: moves curve ends, then forgets what was made from the curves before.
    pub(super) fn snap(&mut self) {
        for m in 0..self.machine.modules.len() {
            let module = ModuleId::at(m);
            let Some(index) = self.single(module, Keyword::Snap) else { continue };
            let script = self.machine.at(module).script.clone();
            let DeclarationKind::Snap(expr) = script.declarations[index as usize].kind else { continue };
            let Some(values) = self.head(module, index, &[(expr, Ty::Quantity(Dim::LENGTH), "the distance")]) else { continue };
            let [Value::Number(distance)] = values.as_slice() else { continue };
            self.snap_module(module, index, expr, distance.value);
        }
    }

    fn snap_module(&mut self, module: ModuleId, index: u32, expr: ExprId, distance: f64) {
        let mut parts = stages::gather(self, module);
        self.machine.site.module = module;
        self.machine.site.declaration = index;
        let origin = self.origin_at(expr);
        let pipeline = self.pipeline;
        let result = pipeline.snap(self, &mut parts, distance, origin);
        if let Err(stop) = result {
            let script = self.machine.at(module).script.clone();
            let declaration = &script.declarations[index as usize];
            let code = Code { nodes: &declaration.nodes, module, declaration: index };
            self.settle(code, stop, declaration.span);
        }
        let said = std::mem::take(&mut self.sink);
        self.machine.filed.extend(said.into_iter().map(|d| (Some((module, index)), d)));
        let mut curves = parts.curves.into_iter();
        let moved = self.replace_curves(module, &mut || curves.next().map(|c| c.value));
        self.snapped_keys(module, &moved);
        self.forget_dependents(module);
    }

    /// Puts snapped curves in the place of those evaluated before, in the order in which they were gathered; gives for
    /// each declaration the digest of its curves where they are others now.
    fn replace_curves(&mut self, module: ModuleId, next: &mut dyn FnMut() -> Option<Chain>) -> Vec<Option<Digest>> {
        fn walk(value: &Value, next: &mut dyn FnMut() -> Option<Chain>, moved: &mut (u64, Option<Digester>)) -> Value {
            match value {
                Value::List(items) => Value::list(items.iter().map(|v| walk(v, next, moved)).collect()),
                Value::Curve(before) => {
                    let now = next().unwrap_or_else(|| before.clone());
                    moved.0 += 1;
                    if !now.is(before) {
                        let all = moved.1.take().unwrap_or_else(|| Digester::new("moved"));
                        moved.1 = Some(all.number(moved.0).with(&now));
                    }
                    Value::Curve(now)
                }
                other => other.clone(),
            }
        }
        let script = self.machine.at(module).script.clone();
        let mut all = vec![None; script.declarations.len()];
        for (i, declaration) in script.declarations.iter().enumerate() {
            if declaration.keyword == Keyword::Curve
                && let State::Done(value) = &self.machine.at(module).states[i]
            {
                let mut moved = (0, None);
                let value = walk(value, next, &mut moved);
                if let Some(moved) = moved.1 {
                    all[i] = Some(moved.finish());
                    self.machine.at_mut(module).states[i] = State::Done(value);
                }
            }
        }
        all
    }

    /// Changes the keys of a script to those that hold after its `snap`, and takes over the curves that the run before
    /// moved to the same places: entities are told apart by what they were made as.
    fn snapped_keys(&mut self, module: ModuleId, moved: &[Option<Digest>]) {
        if self.memory.is_none() {
            return;
        }
        let script = self.machine.at(module).script.clone();
        let before = self.keys(module);
        let is_snapped = |i: usize| {
            let done = matches!(self.machine.at(module).states[i], State::Done(_));
            done && script.declarations[i].keyword == Keyword::Curve
        };
        let fixed: Vec<bool> = (0..moved.len()).map(is_snapped).collect();
        let own = before.of.iter().zip(moved).map(|(key, moved)| {
            let after = Digester::new("snapped").digest((*key)?);
            Some(moved.iter().fold(after, |after, moved| after.digest(*moved)).finish())
        });
        let own: Vec<Option<Digest>> = own.collect();
        let keys = self.joined_keys(module, &own, &fixed);
        self.machine.at_mut(module).keys = Some(keys.clone());
        for i in (0..moved.len()).filter(|i| moved[*i].is_some()) {
            self.take_over_moved(module, i, &keys);
        }
    }

    fn take_over_moved(&mut self, module: ModuleId, i: usize, keys: &Keys) {
        let (Some(key), Some(memory)) = (keys.of[i], &mut self.memory) else { return };
        let State::Done(value) = &mut self.machine.modules[module.index()].states[i] else { return };
        match memory.value_of(key) {
            Some(before) => *value = before,
            None => memory.keep_value(key, value.clone()),
        }
    }

    /// Declarations other than curves that name a snapped curve, at first or second hand, are evaluated again.
    fn forget_dependents(&mut self, module: ModuleId) {
        let script = self.machine.at(module).script.clone();
        let n = script.declarations.len();
        let mut stale: Vec<bool> = script.declarations.iter().map(|d| d.keyword == Keyword::Curve).collect();
        loop {
            let names_stale = |node: &Node| match node.expr {
                Expr::Name(name) | Expr::Call { name, .. } => self.machine.at(module).find(name).is_some_and(|d| stale[d as usize]),
                _ => false,
            };
            let next: Vec<bool> = (0..n).map(|i| stale[i] || script.declarations[i].nodes.iter().any(names_stale)).collect();
            if next == stale {
                break;
            }
            stale = next;
        }
        let mut again = BTreeSet::new();
        for (i, named) in stale.into_iter().enumerate() {
            // A second declaration of one name stays refused.
            let first = bound(&script.declarations[i]).is_none_or(|b| self.machine.at(module).find(b.name) == Some(i as u32));
            let evaluated = !matches!(self.machine.at(module).states[i], State::Waiting | State::Running | State::Suspended);
            if named && first && evaluated && script.declarations[i].keyword != Keyword::Curve {
                self.machine.at_mut(module).states[i] = State::Waiting;
                again.insert(i as u32);
            }
        }
        self.machine.filed.retain(|(owner, _)| owner.is_none_or(|(m, i)| m != module || !again.contains(&i)));
        let m = self.machine.at_mut(module);
        m.checks.retain(|c| !again.contains(&c.0));
        m.reports.retain(|c| !again.contains(&c.0));
        m.exports.retain(|c| !again.contains(&c.0));
        m.pictures.retain(|c| !again.contains(&c.0));
    }
}

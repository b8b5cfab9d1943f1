//! `snap 4mm`: moves ends of measured curves, and what was made from the curves before is made again.
//!
//! A curve may be made from the ends of another one, so curves are snapped in rounds (`Rounds`): first those that name no
//! other curve, then those made from these, which are evaluated anew where something moved, and so on. What other curves
//! are made from stays where its own round left it. A module is snapped in the round of its `use`.
//!
//! Each round that moves something changes the keys of the script. A curve that moved goes by the key it had and what became
//! of it, and what names it by its own key and those of what it names, so that nothing of before is taken for something of
//! afterwards.

use crate::base::bbox::Box3;
use crate::base::digest::{Digest, StableHasher};
use crate::lang::declare::snap_curves::{Turn, move_ends};
use crate::lang::declare::snap_rounds::Rounds;
use crate::lang::eval::context::Cx;
use crate::lang::eval::machine::{Code, Site};
use crate::lang::eval::memory::Keys;
use crate::lang::eval::module::State;
use crate::lang::eval::stages;
use crate::lang::syntax::ast::{DeclarationKind, ExprId, Keyword};
use crate::lang::values::origins::NO_MEMBER;
use crate::lang::values::types::Ty;
use crate::lang::values::value::{Dim, ModuleId, Value};
use crate::network::Chain;

/// What a round looks at.
const LOOKED_AT: &[Keyword] = &[Keyword::Use, Keyword::Point, Keyword::Curve];

/// `snap 4mm`: the distance, model units, with its declaration and expression.
#[derive(Clone, Copy)]
struct SnapStatement {
    distance: f64,
    index: u32,
    expr: ExprId,
}

/// For each declaration of a script the digest of what it became where that is something else now.
type Moved = Vec<Option<Digest>>;

impl Cx<'_> {
    /// `snap 4mm` of each script: moves curve ends, then forgets what was made from the curves before.
    pub(crate) fn snap(&mut self) {
        let is_said = |m: usize| !self.heads(ModuleId::at(m), Keyword::Snap).is_empty();
        if (0..self.machine.modules.len()).any(is_said) {
            self.snap_module(ModuleId::MAIN);
        }
    }

    /// Snaps a script and its modules; the digest of all that moved, `None` where nothing did.
    fn snap_module(&mut self, module: ModuleId) -> Option<Digest> {
        let asked = self.snap_distance(module);
        let rounds = Rounds::of(self, module);
        let mut all: Option<StableHasher> = None;
        for round in 0..rounds.count() {
            if self.job.go_on().is_err() {
                break;
            }
            self.evaluate_round(module, &rounds, round);
            let mut moved = self.snap_used(module, &rounds, round);
            let sound = asked.is_none_or(|asked| self.snap_round(module, &rounds, round, asked, &mut moved));
            if moved.iter().any(Option::is_some) {
                let each = moved.iter().enumerate().filter_map(|(i, moved)| Some((i, (*moved)?)));
                all = Some(each.fold(all.unwrap_or_else(|| StableHasher::new("rounds")), |d, (i, moved)| d.number(i as u64).digest(moved)));
                let stale = rounds.users(|i| moved[i].is_some());
                self.snapped_keys(module, &moved, &stale);
                self.forget(module, &stale);
            }
            if !sound {
                break;
            }
        }
        all.map(|all| all.finish())
    }

    /// The distance that a script's `snap` says, the declaration, and where the distance stands.
    fn snap_distance(&mut self, module: ModuleId) -> Option<SnapStatement> {
        let index = self.single(module, Keyword::Snap)?;
        let script = self.machine.at(module).script.clone();
        let DeclarationKind::Snap(expr) = script.declarations.whole(index as usize).kind else { return None };
        let values = self.head(module, index, &[(expr, Ty::Quantity(Dim::LENGTH), "the distance")])?;
        let [Value::Number(distance)] = values.as_slice() else { return None };
        Some(SnapStatement { distance: distance.value, index, expr })
    }

    /// Evaluates what a round looks at and the rounds before it changed. Curves that ask for the tolerance are not measured
    /// ones: they wait, as they did before the first round.
    fn evaluate_round(&mut self, module: ModuleId, rounds: &Rounds, round: u32) {
        let (tolerance, seen) = (self.tolerance.take(), std::mem::replace(&mut self.seen, Box3::EMPTY));
        let script = self.machine.at(module).script.clone();
        for (i, keyword) in script.declarations.keywords().enumerate() {
            let waits = matches!(self.machine.at(module).states[i], State::Waiting);
            if waits && rounds.of[i] <= round && LOOKED_AT.contains(&keyword) {
                self.ensure_all(module, i as u32);
            }
        }
        (self.tolerance, self.seen) = (tolerance, seen);
    }

    /// Snaps the modules whose `use` is in a round.
    fn snap_used(&mut self, module: ModuleId, rounds: &Rounds, round: u32) -> Moved {
        let mut moved = vec![None; rounds.of.len()];
        for (i, moved) in moved.iter_mut().enumerate().filter(|(i, _)| rounds.of[*i] == round) {
            if let State::Done(Value::Module(used)) = self.machine.at(module).states[i] {
                *moved = self.snap_module(used);
            }
        }
        moved
    }

    /// Snaps the curves of a round; `false` where they cannot be.
    fn snap_round(&mut self, module: ModuleId, rounds: &Rounds, round: u32, asked: SnapStatement, moved: &mut Moved) -> bool {
        let SnapStatement { distance, index, expr } = asked;
        let parts = stages::gather(self, module);
        let mut of: Vec<(u32, Keyword)> = Vec::new();
        let looked_at = &[Keyword::Point, Keyword::Curve];
        stages::each_member(self.machine.at(module), &self.program.names, looked_at, &mut |i, keyword, _, _, _| of.push((i, keyword)));
        let turn = |i: u32| match rounds.of[i as usize] {
            now if now == round => Some(Turn::Now),
            before if before < round => Some(Turn::Before { named: rounds.named[i as usize] }),
            _ => None,
        };
        let turns = |keyword: Keyword| of.iter().filter(move |o| o.1 == keyword).map(|o| turn(o.0)).collect::<Vec<_>>();
        let points = parts.points.iter().zip(turns(Keyword::Point)).filter(|(_, turn)| turn.is_some()).map(|(p, _)| p.value);
        let curves = parts.curves.iter().cloned().zip(turns(Keyword::Curve)).filter_map(|(curve, turn)| Some((curve, turn?)));
        self.machine.site = Site { module, declaration: index, member: [NO_MEMBER; 2], expr };
        let origin = self.origin_at(expr);
        let (mut curves, points): (Vec<_>, Vec<_>) = (curves.collect(), points.collect());
        let result = move_ends(self, &mut curves, &points, distance, origin);
        let sound = result.is_ok();
        if let Err(stop) = result {
            let script = self.machine.at(module).script.clone();
            let declaration = script.declarations.whole(index as usize);
            let code = Code { nodes: &declaration.nodes, module, declaration: index };
            self.settle(code, stop, declaration.span);
        }
        let said = std::mem::take(&mut self.sink.reports);
        self.machine.filed.extend(said.into_iter().map(|d| (Some((module, index)), d)));
        let mut curves = curves.into_iter();
        self.replace_curves(module, &|i| turn(i as u32).is_some(), &mut || curves.next().map(|c| c.0.value), moved);
        sound
    }

    /// Puts snapped curves in the place of those evaluated before, in the order in which they were gathered; `moved` gets the
    /// digest of the curves of each declaration where they are others now.
    fn replace_curves(
        &mut self,
        module: ModuleId,
        has_turn: &dyn Fn(usize) -> bool,
        next: &mut dyn FnMut() -> Option<Chain>,
        all: &mut Moved,
    ) {
        fn walk(value: &Value, next: &mut dyn FnMut() -> Option<Chain>, moved: &mut (u64, Option<StableHasher>)) -> Value {
            match value {
                Value::List(items) => Value::list(items.iter().map(|v| walk(v, next, moved)).collect()),
                Value::Curve(before) => {
                    let now = next().unwrap_or_else(|| before.clone());
                    moved.0 += 1;
                    if !now.is(before) {
                        let all = moved.1.take().unwrap_or_else(|| StableHasher::new("moved"));
                        moved.1 = Some(all.number(moved.0).with(&now));
                    }
                    Value::Curve(now)
                }
                other => other.clone(),
            }
        }
        let script = self.machine.at(module).script.clone();
        for (i, keyword) in script.declarations.keywords().enumerate() {
            if keyword == Keyword::Curve
                && has_turn(i)
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
    }

    /// Changes the keys of a script to those that hold after a round that moved something, and takes over the curves that
    /// the run before moved to the same places: entities are told apart by what they were made as.
    fn snapped_keys(&mut self, module: ModuleId, moved: &Moved, stale: &[bool]) {
        if self.memory.is_none() {
            return;
        }
        let before = self.keys(module);
        let own = |i: usize| {
            let key = before.of[i]?;
            let changed = moved[i].is_some() || stale[i];
            let after = || StableHasher::new("snapped").digest(key);
            Some(if changed { moved[i].iter().fold(after(), |after, moved| after.digest(*moved)).finish() } else { key })
        };
        let own: Vec<Option<Digest>> = (0..moved.len()).map(own).collect();
        let fixed: Vec<bool> = stale.iter().map(|stale| !stale).collect();
        let keys = self.joined_keys(module, &own, &fixed);
        self.machine.at_mut(module).keys = Some(keys.clone());
        for i in (0..moved.len()).filter(|i| moved[*i].is_some()) {
            self.take_over_moved(module, i, &keys);
        }
    }

    fn take_over_moved(&mut self, module: ModuleId, i: usize, keys: &Keys) {
        let (Some(key), Some(memory)) = (keys.of[i], &mut self.memory) else { return };
        let State::Done(value) = &mut self.machine.modules[module.index()].states[i] else { return };
        if matches!(value, Value::Module(_)) {
            return;
        }
        match memory.value_of(key) {
            Some(before) => *value = before,
            None => memory.keep_value(key, value.clone()),
        }
    }

    /// What names something that moved, at first or second hand, is evaluated again.
    fn forget(&mut self, module: ModuleId, stale: &[bool]) {
        let script = self.machine.at(module).script.clone();
        let mut again = vec![false; stale.len()];
        for i in (0..stale.len()).filter(|i| stale[*i]) {
            // A second declaration of one name stays refused.
            let first = script.declarations.bound(i).is_none_or(|b| self.machine.at(module).find(b.name) == Some(i as u32));
            let evaluated = !matches!(self.machine.at(module).states[i], State::Waiting | State::Running | State::Suspended);
            self.machine.at_mut(module).within.remove(&(i as u32));
            if first && evaluated {
                self.machine.at_mut(module).states[i] = State::Waiting;
                again[i] = true;
                if script.declarations.keyword(i) == Keyword::Use {
                    self.unload(module, i as u32);
                }
            }
        }
        let goes = |i: u32| again[i as usize];
        self.machine.filed.retain(|(owner, _)| owner.is_none_or(|(m, i)| m != module || !goes(i)));
        let m = self.machine.at_mut(module);
        m.checks.retain(|c| !goes(c.0));
        m.reports.retain(|c| !goes(c.0));
        m.exports.retain(|c| !goes(c.0));
        m.pictures.retain(|c| !goes(c.0));
    }

    /// Forgets what the script of a `use` said and checked, since it is loaded anew with other params.
    fn unload(&mut self, by: ModuleId, declaration: u32) {
        let Some(module) = self.loaded_by(by, declaration) else { return };
        for index in self.heads(module, Keyword::Use) {
            self.unload(module, index);
        }
        let file = self.machine.at(module).file;
        let of_file = |d: &crate::lang::diag::diagnostic::Diagnostic| d.labels.first().is_some_and(|label| label.file == file);
        self.machine.filed.retain(|(owner, said)| owner.map_or_else(|| !of_file(said), |(m, _)| m != module));
        let m = self.machine.at_mut(module);
        m.states.fill(State::Broken);
        m.within.clear();
        m.checks.clear();
        m.reports.clear();
        m.exports.clear();
        m.pictures.clear();
    }
}

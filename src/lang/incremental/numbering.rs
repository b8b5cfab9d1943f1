//! Values that depend on where they are asked for: patches, edges and vertices are numbered in the model of all surfaces, but
//! where a curve or surface is made from them in a model of their surfaces alone, since it is itself one of all.

use crate::lang::eval::context::Cx;
use crate::lang::eval::memory::Dependencies;
use crate::lang::eval::memory::Sees;
use crate::lang::eval::module::State;
use crate::lang::eval::stages;
use crate::lang::syntax::ast::Keyword;
use crate::lang::values::value::ModuleId;

impl Cx<'_> {
    /// What a declaration sees that is asked for now.
    pub(crate) fn sees(&self, module: ModuleId, index: u32) -> Sees {
        let keyword = self.machine.at(module).script.declarations.keyword(index as usize);
        let can = matches!(keyword, Keyword::Let | Keyword::Group);
        if can && stages::is_within(self, module) { Sees::Own } else { Sees::All }
    }

    /// Its state for who asks now, with what it asked for: waiting where it is only known, or being evaluated, for the whole script.
    pub(crate) fn seen_as(&self, module: ModuleId, index: u32, sees: Sees) -> (&State, Dependencies) {
        let m = self.machine.at(module);
        let all = (&m.states[index as usize], Dependencies::from(m.asked[index as usize]));
        if sees == Sees::All {
            return all;
        }
        match (m.within.get(&index), all) {
            (Some((state, asked)), _) => (state, *asked),
            (None, (State::Running, _)) => (&State::Waiting, Dependencies::default()),
            (None, (State::Done(_), asked)) if asked.numbered => (&State::Waiting, Dependencies::default()),
            (None, all) => all,
        }
    }

    /// Says that a declaration is being evaluated.
    pub(crate) fn begin(&mut self, module: ModuleId, index: u32, sees: Sees) {
        let m = self.machine.at_mut(module);
        match sees {
            Sees::All => m.states[index as usize] = State::Running,
            Sees::Own => {
                m.within.insert(index, (State::Running, Dependencies::default()));
            }
        }
    }

    /// Says what an evaluation ended with: what does not depend on who asked is known to all.
    pub(crate) fn end(&mut self, module: ModuleId, index: u32, state: State, sees: Sees, asked: Dependencies) {
        let m = self.machine.at_mut(module);
        if sees == Sees::Own {
            m.within.remove(&index);
        }
        let is_known = matches!(m.states[index as usize], State::Running | State::Done(_));
        let depends = asked.numbered && matches!(state, State::Done(_));
        if sees == Sees::All || !is_known && !depends {
            (m.states[index as usize], m.asked[index as usize]) = (state, asked.into());
        } else if !matches!(state, State::Suspended) {
            m.within.insert(index, (state, asked));
        }
    }
}

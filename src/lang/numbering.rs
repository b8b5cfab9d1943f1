//! Values that depend on where they are asked for: patches, edges and vertices are numbered in the model of all surfaces, but
//! where a curve or surface is made from them in a model of their surfaces alone, since it is itself one of all.

use super::cx::Cx;
use super::memory::Dependencies;
use super::module::State;
use super::stages;
use super::syntax::ast::Keyword;
use super::value::ModuleId;
use crate::base::digest::{Digest, StableHasher};

/// Which surfaces a declaration sees while it is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sees {
    /// Those of the whole script.
    All,
    /// Those that it names: geometry is being made from it.
    Own,
}

impl Sees {
    /// The key under which a value that depends on this is kept.
    pub fn key(self, key: Digest) -> Digest {
        match self {
            Self::All => key,
            Self::Own => StableHasher::new("within").with(&key).finish(),
        }
    }
}

impl Cx<'_> {
    /// What a declaration sees that is asked for now.
    pub(super) fn sees(&self, module: ModuleId, index: u32) -> Sees {
        let keyword = self.machine.at(module).script.declarations[index as usize].keyword;
        let can = matches!(keyword, Keyword::Let | Keyword::Group);
        if can && stages::is_within(self, module) { Sees::Own } else { Sees::All }
    }

    /// Its state for who asks now, with what it asked for: waiting where it is only known, or being evaluated, for the whole script.
    pub(super) fn seen_as(&self, module: ModuleId, index: u32, sees: Sees) -> (&State, Dependencies) {
        let m = self.machine.at(module);
        let all = (&m.states[index as usize], m.asked[index as usize]);
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
    pub(super) fn begin(&mut self, module: ModuleId, index: u32, sees: Sees) {
        let m = self.machine.at_mut(module);
        match sees {
            Sees::All => m.states[index as usize] = State::Running,
            Sees::Own => {
                m.within.insert(index, (State::Running, Dependencies::default()));
            }
        }
    }

    /// Says what an evaluation ended with: what does not depend on who asked is known to all.
    pub(super) fn end(&mut self, module: ModuleId, index: u32, (state, sees): (State, Sees), asked: Dependencies) {
        let m = self.machine.at_mut(module);
        if sees == Sees::Own {
            m.within.remove(&index);
        }
        let is_known = matches!(m.states[index as usize], State::Running | State::Done(_));
        let depends = asked.numbered && matches!(state, State::Done(_));
        if sees == Sees::All || !is_known && !depends {
            (m.states[index as usize], m.asked[index as usize]) = (state, asked);
        } else if !matches!(state, State::Suspended) {
            m.within.insert(index, (state, asked));
        }
    }
}

//! The rounds in which `snap` moves the curves of a script: what a curve is made from comes before it.

use crate::lang::eval::context::Cx;
use crate::lang::syntax::ast::Keyword;
use crate::lang::values::value::ModuleId;

/// The declarations of a script in the order in which `snap` comes to them.
#[derive(Debug)]
pub(crate) struct Rounds {
    /// Round of each declaration: 0 where no curve and no module is named at any hand, else one after the last one named.
    pub of: Vec<u32>,
    /// Whether a curve or a module is made from it, at any hand.
    pub named: Vec<bool>,
    /// Declarations that each declaration names.
    needs: Vec<Vec<usize>>,
    count: u32,
}

impl Rounds {
    /// The rounds of a script.
    pub fn of(cx: &Cx, module: ModuleId) -> Self {
        let script = &cx.machine.at(module).script;
        let needs: Vec<Vec<usize>> = script.declarations.iter().map(|d| cx.needs(module, &d)).collect();
        let moves: Vec<bool> = script.declarations.keywords().map(|keyword| matches!(keyword, Keyword::Curve | Keyword::Use)).collect();
        let of = rounds(&needs, &moves);
        let count = of.iter().zip(&moves).filter(|(_, moves)| **moves).map(|(round, _)| round + 1).max().unwrap_or(0);
        let named = reached(&needs, (0..needs.len()).filter(|i| moves[*i]).flat_map(|i| needs[i].iter().copied()));
        Self { of, named, needs, count }
    }

    /// How many rounds there are.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// The declarations that name one of these, at first or second hand; not these themselves.
    pub fn users(&self, is_root: impl Fn(usize) -> bool) -> Vec<bool> {
        let mut users: Vec<Vec<usize>> = vec![Vec::new(); self.needs.len()];
        for (i, needs) in self.needs.iter().enumerate() {
            needs.iter().for_each(|need| users[*need].push(i));
        }
        let roots = (0..users.len()).filter(|i| is_root(*i));
        let mut found = reached(&users, roots.flat_map(|i| users[i].iter().copied()));
        found.iter_mut().enumerate().for_each(|(i, found)| *found &= !is_root(i));
        found
    }
}

/// Whether each place is among the starts or is led to from them.
fn reached(leads: &[Vec<usize>], starts: impl Iterator<Item = usize>) -> Vec<bool> {
    let mut found = vec![false; leads.len()];
    let mut stack: Vec<usize> = starts.collect();
    while let Some(at) = stack.pop() {
        if !std::mem::replace(&mut found[at], true) {
            stack.extend(leads[at].iter().copied().filter(|next| !found[*next]));
        }
    }
    found
}

/// The round of each declaration; one that leads back to itself counts as not named.
fn rounds(needs: &[Vec<usize>], moves: &[bool]) -> Vec<u32> {
    let mut of = vec![0; needs.len()];
    // 0: not met yet, 1: below on the stack, 2: done.
    let mut met = vec![0u8; needs.len()];
    for root in 0..needs.len() {
        let mut stack = vec![(root, 0)];
        while let Some((at, from)) = stack.pop() {
            if met[at] == 2 {
                continue;
            }
            met[at] = 1;
            if let Some(k) = (from..needs[at].len()).find(|k| met[needs[at][*k]] == 0) {
                stack.push((at, k + 1));
                stack.push((needs[at][k], 0));
                continue;
            }
            let done = needs[at].iter().filter(|need| met[**need] == 2);
            of[at] = done.map(|need| of[*need] + u32::from(moves[*need])).max().unwrap_or(0);
            met[at] = 2;
        }
    }
    of
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_comes_after_what_it_is_made_from() {
        // 0: curve, 1: `let` of 0, 2: curve of 1, 3: curve, 4: curve of 2 and 3, 5 and 6 name each other.
        let needs = [vec![], vec![0], vec![1], vec![], vec![2, 3], vec![6], vec![5]];
        let moves = [true, false, true, true, true, true, true];
        assert_eq!(rounds(&needs, &moves)[..5], [0, 1, 1, 0, 2]);
        assert_eq!(reached(&needs, [4].into_iter())[..5], [true; 5]);
        assert_eq!(reached(&needs, [2].into_iter())[..5], [true, true, true, false, false]);
    }
}

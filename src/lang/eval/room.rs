//! A memory budget for lists: what a run holds is counted before it is made, so that no script eats the machine.
//!
//! A member takes 32 bytes and a list of its own some more. What a declaration made on the way is given back when it is
//! evaluated, all but the value that it keeps.

use std::sync::Arc;

use crate::base::fault::ValueFault;
use crate::base::limits;
use crate::lang::eval::context::{Cx, Halt};
use crate::lang::eval::machine::Code;
use crate::lang::syntax::ast::ExprId;
use crate::lang::values::value::Value;

/// Members whose place a list takes itself: two counters, length, capacity, and what the allocator adds.
pub(crate) const LIST_COST: usize = 3;
/// Bytes of a member.
const MEMBER_BYTES: usize = size_of::<Value>();

/// Members made and kept, in places of [`MEMBER_BYTES`].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MemoryBudget {
    /// Held by finished declarations and by those being evaluated.
    made: usize,
    /// Of these, held by finished declarations.
    kept: usize,
}

impl MemoryBudget {
    fn has(&self, n: usize) -> bool {
        n <= limits::MEMBERS_MADE.saturating_sub(self.made)
    }

    /// Places that are held.
    pub fn held(&self) -> usize {
        self.made
    }

    /// Counts the value of a declaration that an earlier run evaluated.
    pub fn take_over(&mut self, n: usize) {
        self.made += n;
        self.kept += n;
    }

    /// Closes the account of a declaration that began at `before`: its value stays, the rest is given back.
    pub fn settle(&mut self, before: Self, value: Option<&Value>) {
        self.kept += self.give_back(before, value);
    }

    /// Gives back what was made since `before` other than the value, which takes the places that are the result.
    pub fn give_back(&mut self, before: Self, value: Option<&Value>) -> usize {
        let inside = self.kept - before.kept;
        let own = (self.made - before.made).saturating_sub(inside);
        let keep = value.map_or(0, |v| places(v, own));
        self.made = before.made + inside + keep;
        keep
    }
}

/// Places that a value takes, counted up to `limit`; what is shared counts each time, so it ends on any value.
fn places(value: &Value, limit: usize) -> usize {
    fn walk(value: &Value, left: usize) -> usize {
        match value {
            Value::List(items) => members(items, left),
            Value::Record(record) => members(&record.values, left),
            Value::Text(text) => text.len() / MEMBER_BYTES,
            _ => 0,
        }
    }
    fn members(items: &[Value], left: usize) -> usize {
        let mut sum = LIST_COST + items.len();
        for item in items {
            if sum >= left {
                break;
            }
            sum += walk(item, left - sum);
        }
        sum
    }
    walk(value, limit).min(limit)
}

/// How many things nested lists hold, counted up to just above `limit`. A list that holds another a thousand times over, and
/// that one a third, ends as soon as any: inner lists count as well.
pub(crate) fn flat_len(value: &Value, limit: usize) -> usize {
    match value {
        Value::List(items) => {
            let mut sum = items.len();
            for item in items.iter() {
                if sum > limit {
                    break;
                }
                if item.len().is_some() {
                    sum += flat_len(item, limit - sum);
                }
            }
            sum
        }
        other => other.len().unwrap_or(1),
    }
}

impl Cx<'_> {
    /// Fails before a builtin makes a list of so many members.
    pub fn room(&mut self, n: usize) -> Result<(), Halt> {
        self.room_of_lists(n, None)
    }

    /// Fails before a builtin makes a list of so many members, each a list of `inner` when given.
    pub fn room_of_lists(&mut self, n: usize, inner: Option<usize>) -> Result<(), Halt> {
        let each = 1 + inner.map_or(0, |m| LIST_COST + m);
        let (what, limit) = if n > limits::LIST_MEMBERS {
            (format!("a list of {n} members"), "10^7 members")
        } else if !self.machine.room.has(n.saturating_mul(each)) {
            (format!("a list of {n} more members"), "2 x 10^7 members at a time")
        } else {
            return self.steps(n);
        };
        Err(ValueFault::Limit { what, limit: limit.into() }.into())
    }

    /// Counts the list that a builtin has made; one that something else holds as well is not new.
    #[inline]
    pub(crate) fn made_by_builtin(&mut self, code: Code<'_>, id: ExprId, value: &Value) -> Result<(), Halt> {
        match value {
            Value::List(items) if Arc::strong_count(items) == 1 => {
                let inner = items.iter().filter(|v| matches!(v, Value::List(l) if Arc::strong_count(l) == 1));
                let inner: usize = inner.map(|v| LIST_COST + v.len().unwrap_or(0)).sum();
                self.made(code, id, LIST_COST + items.len() + inner)
            }
            Value::Text(text) => self.made(code, id, text.len() / MEMBER_BYTES),
            _ => Ok(()),
        }
    }

    /// Counts a text that is made.
    pub(crate) fn made_text(&mut self, code: Code<'_>, id: ExprId, text: &str) -> Result<(), Halt> {
        self.made(code, id, 1 + text.len() / MEMBER_BYTES)
    }

    /// Counts members of lists that are made; fails when too many are held.
    #[inline]
    pub(crate) fn made(&mut self, code: Code<'_>, id: ExprId, n: usize) -> Result<(), Halt> {
        self.has_room(code, id, n)?;
        self.machine.room.made += n;
        Ok(())
    }

    /// Fails before `n` more members are made than a run may hold.
    #[inline]
    pub(crate) fn has_room(&mut self, code: Code<'_>, id: ExprId, n: usize) -> Result<(), Halt> {
        if self.machine.room.has(n) { Ok(()) } else { Err(self.no_room(code, id)) }
    }

    /// Fails before lists are compared that hold each other so often that no comparison would end.
    pub fn comparable(&self, values: &[&Value]) -> Result<(), Halt> {
        match values.iter().all(|v| flat_len(v, limits::MEMBERS_MADE) <= limits::MEMBERS_MADE) {
            true => Ok(()),
            false => {
                let what = "comparing lists of more than 2 x 10^7 members".to_owned();
                Err(ValueFault::Limit { what, limit: "2 x 10^7 members, nested lists included".into() }.into())
            }
        }
    }

    /// Nested lists as one, unless it would be too long.
    pub(crate) fn flattened(&mut self, code: Code<'_>, id: ExprId, value: Value) -> Result<Vec<Value>, Halt> {
        let n = flat_len(&value, limits::LIST_MEMBERS);
        if n > limits::LIST_MEMBERS {
            return Err(self.too_long(code, id, "this list"));
        }
        self.steps(n)?;
        self.has_room(code, id, n)?;
        let mut flat = Vec::new();
        crate::lang::eval::coerce::flatten_into(value, &mut flat);
        Ok(flat)
    }

    #[cold]
    fn no_room(&mut self, code: Code<'_>, id: ExprId) -> Halt {
        self.error(code, "E217", "the lists of this run have too many members in total", code.span(id), "beyond the limit")
            .help("the limit is 2 x 10^7 members at a time, nested lists included")
            .stop()
    }

    #[cold]
    pub(crate) fn too_long(&mut self, code: Code<'_>, id: ExprId, what: &str) -> Halt {
        self.error(code, "E217", format!("{what} has too many members"), code.span(id), "made here")
            .help("the limit is 10^7 members")
            .stop()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn doubled(levels: usize) -> Value {
        (0..levels).fold(Value::list(Vec::new()), |inner, _| Value::list(vec![inner.clone(), inner]))
    }

    #[test]
    fn counting_ends_on_lists_that_share() {
        assert_eq!(places(&doubled(60), 1000), 1000);
        assert!(flat_len(&doubled(60), 1000) > 1000);
        let nested = Value::list(vec![Value::number(1.0), Value::Range(0, 5), Value::list(vec![Value::number(2.0)])]);
        assert_eq!(flat_len(&nested, 1000), 3 + 5 + 1);
        assert_eq!(places(&nested, 1000), LIST_COST + 3 + LIST_COST + 1);
    }

    #[test]
    fn a_declaration_gives_back_what_it_does_not_keep() {
        let mut room = MemoryBudget::default();
        let outer = room;
        room.made += 100;
        let inner = room;
        room.made += 50;
        room.settle(inner, Some(&Value::list(vec![Value::None; 10])));
        assert_eq!((room.made, room.kept), (100 + LIST_COST + 10, LIST_COST + 10));
        room.settle(outer, Some(&Value::number(1.0)));
        assert_eq!((room.made, room.kept), (LIST_COST + 10, LIST_COST + 10));
    }
}

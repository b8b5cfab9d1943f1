//! Functions on lists.

use std::cmp::Ordering;
use std::sync::Arc;

use crate::base::fault::ValueFault;
use crate::builtins;
use crate::lang::eval::comparisons::same;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::values::conversions::Rest;
use crate::lang::values::types::dim_words;
use crate::lang::values::value::Value;

/// The order of two values that have one; `None` for kinds or dimensions that differ.
fn order(a: &Value, b: &Value) -> Option<Ordering> {
    match (a, b) {
        (Value::Number(x), Value::Number(y)) if x.dim == y.dim => Some(x.value.total_cmp(&y.value)),
        (Value::Text(x), Value::Text(y)) | (Value::Word(x), Value::Word(y)) => Some(x.cmp(y)),
        (Value::Bool(x), Value::Bool(y)) => Some(x.cmp(y)),
        _ => {
            let (n, m) = (a.len()?, b.len()?);
            for i in 0..n.min(m) {
                match order(&a.item(i)?, &b.item(i)?)? {
                    Ordering::Equal => {}
                    other => return Some(other),
                }
            }
            Some(n.cmp(&m))
        }
    }
}

/// W729 for no conditions inside a check.
fn of_some(cx: &mut Cx, function: &'static str, conditions: &[bool], result: bool) {
    if conditions.is_empty() && cx.in_check() {
        let of = cx.origin();
        cx.say(&ValueFault::OfNothing { of, function, result }.into());
    }
}

/// What the members are sorted by: themselves, a field, or a list of the same length.
fn keys(cx: &mut Cx, list: &[Value], key: &Value) -> Result<Vec<Value>, Halt> {
    match key {
        Value::None => Ok(list.to_vec()),
        Value::Text(name) | Value::Word(name) => {
            let id = cx.program.names.find(name);
            let field = |v: &Value| match v {
                Value::Record(r) => id.and_then(|id| r.get(id)).cloned(),
                Value::Vector(p, dim) => match &**name {
                    "x" => Some(Value::quantity(p.x, *dim)),
                    "y" => Some(Value::quantity(p.y, *dim)),
                    "z" => Some(Value::quantity(p.z, *dim)),
                    _ => None,
                },
                Value::Node(p) => match &**name {
                    "x" => Some(Value::length(p.x)),
                    "y" => Some(Value::length(p.y)),
                    "z" => Some(Value::length(p.z)),
                    _ => None,
                },
                _ => None,
            };
            let found: Option<Vec<Value>> = list.iter().map(field).collect();
            found.ok_or_else(|| {
                let found = format!("\"{name}\"");
                ValueFault::OutsideRange { argument: "key", found, range: "the name of a field that every member has".into() }.into()
            })
        }
        other => match other.len() {
            Some(n) if n == list.len() => Ok((0..n).filter_map(|i| other.item(i)).collect()),
            _ => {
                let found = cx.kind(other);
                Err(ValueFault::WrongKind { argument: "key", wanted: "the name of a field, or a list with a key for each member", found }
                    .into())
            }
        },
    }
}

/// Members of a list, range or row; of a record its values.
fn members(value: &Value) -> Vec<Value> {
    (0..value.len().unwrap_or(0)).filter_map(|i| value.item(i)).collect()
}

fn dims(values: &[Value]) -> (String, String) {
    let words = |v: &Value| match v {
        Value::Number(q) => dim_words(q.dim),
        other => other.ty().words(),
    };
    let first = values.first().map_or_else(String::new, words);
    let other = values.iter().map(words).find(|w| *w != first).unwrap_or_else(|| first.clone());
    (first, other)
}

builtins! {
    /// How many members a list, range or row has, or how many characters a text.
    ///
    /// ```loft
    /// let a = len([1mm, 2mm]) // => 2
    /// ```
    fn len(
        /// A list, a range, a row of a table or a text.
        of: Value,
    ) -> usize = |cx, of| match &of {
        Value::Text(t) => Ok(t.chars().count()),
        Value::Record(r) => Ok(r.values.len()),
        Value::Table(t) => Ok(t.rows.len()),
        other => match other.len() {
            Some(n) => Ok(n),
            None => {
                let found = cx.kind(other);
                Err(ValueFault::WrongKind { argument: "of", wanted: "a list, range, row or text", found }.into())
            }
        },
    };

    /// A list from its end to its start, or a curve run backwards.
    ///
    /// ```loft
    /// let a = reverse(0..3) // => [2, 1, 0]
    /// ```
    fn reverse(
        /// A list or a curve.
        list: Value,
    ) -> Value = |cx, list| match list {
        Value::Curve(c) => Ok(Value::Curve(c.reversed())),
        other if other.len().is_some() => Ok(Value::list(members(&other).into_iter().rev().collect())),
        other => {
            let found = cx.kind(&other);
            Err(ValueFault::WrongKind { argument: "list", wanted: "a list or a curve", found }.into())
        }
    };

    /// A list in ascending order; equal members keep their order.
    ///
    /// ```loft
    /// let a = sort([3mm, 1mm, 2mm]) // => [1mm, 2mm, 3mm]
    /// let b = sort([{x: 2}, {x: 1}], key: "x")[0].x // => 1
    /// ```
    fn sort(
        /// Numbers, quantities, texts or records.
        list: Vec<Value>,
        /// Name of a field to sort by, or a list with a key for each member.
        key: Value = "none",
    ) -> Vec<Value> = |cx, list, key| {
        let keys = keys(cx, &list, &key)?;
        keys.iter().try_for_each(|k| cx.comparable(&[k]))?;
        if keys.windows(2).any(|w| order(&w[0], &w[1]).is_none()) {
            let (found, beside) = dims(&keys);
            return Err(ValueFault::Mixed { argument: "list", found, beside }.into());
        }
        cx.steps(list.len() * 8)?;
        let mut places: Vec<usize> = (0..list.len()).collect();
        places.sort_by(|a, b| order(&keys[*a], &keys[*b]).unwrap_or(Ordering::Equal));
        Ok(places.into_iter().map(|i| list[i].clone()).collect())
    };

    /// A list without inner lists.
    ///
    /// ```loft
    /// let a = flatten([1, [2, [3]]]) // => [1, 2, 3]
    /// ```
    fn flatten(
        /// Lists and values.
        list: Rest<Value>,
    ) -> Vec<Value> = |_, list| Ok(list.0);

    /// Whether a list has a member equal to a value, or a text holds another.
    ///
    /// ```loft
    /// let a = contains([1, 2, 3], 2) // => true
    /// let b = contains("station", "tat") // => true
    /// ```
    fn contains(
        /// A list or a text.
        list: Value,
        /// What is looked for; quantities with a dimension compare exactly here.
        value: Value,
    ) -> bool = |cx, list, value| match (&list, &value) {
        (Value::Text(t), Value::Text(part)) => Ok(t.contains(&**part)),
        (list, value) if list.len().is_some() => {
            let equal = |v: &Value| match (v, value) {
                (Value::Number(x), Value::Number(y)) => x.dim == y.dim && x.value == y.value,
                (v, value) => same(v, value) == Some(true),
            };
            cx.comparable(&[list, value])?;
            Ok(members(list).iter().any(equal))
        }
        _ => {
            let found = cx.kind(&list);
            Err(ValueFault::WrongKind { argument: "list", wanted: "a list or a text", found }.into())
        }
    };

    /// Whether all members are true; true for an empty list, of which a `check` warns.
    ///
    /// ```loft
    /// let a = all([for i in 0..3: i < 3]) // => true
    /// ```
    fn all(
        /// Conditions, or lists of them.
        conditions: Rest<bool>,
    ) -> bool = |cx, conditions| {
        of_some(cx, "all", &conditions.0, true);
        Ok(conditions.0.iter().all(|c| *c))
    };

    /// Whether any member is true; false for an empty list, of which a `check` warns.
    ///
    /// ```loft
    /// let a = any([for i in 0..3: i == 2]) // => true
    /// ```
    fn any(
        /// Conditions, or lists of them.
        conditions: Rest<bool>,
    ) -> bool = |cx, conditions| {
        of_some(cx, "any", &conditions.0, false);
        Ok(conditions.0.iter().any(|c| *c))
    };

    /// Members of several lists side by side, as long as the shortest.
    ///
    /// ```loft
    /// let a = zip([1, 2], [3mm, 4mm]) // => [[1, 3mm], [2, 4mm]]
    /// ```
    fn zip(
        /// A list.
        a: Vec<Value>,
        /// Another.
        b: Vec<Value>,
        /// A third.
        c: Option<Vec<Value>>,
    ) -> Vec<Value> = |cx, a, b, c| {
        let n = a.len().min(b.len()).min(c.as_ref().map_or(usize::MAX, Vec::len));
        cx.room_of_lists(n, Some(2 + usize::from(c.is_some())))?;
        let row = |i: usize| {
            let mut row = vec![a[i].clone(), b[i].clone()];
            row.extend(c.as_ref().map(|c| c[i].clone()));
            Value::List(Arc::new(row))
        };
        Ok((0..n).map(row).collect())
    };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lang::values::value::Dim;

    #[test]
    fn lists_are_ordered_member_by_member() {
        let list = |items: &[f64]| Value::list(items.iter().map(|x| Value::number(*x)).collect());
        assert_eq!(order(&list(&[1.0, 2.0]), &list(&[1.0, 3.0])), Some(Ordering::Less));
        assert_eq!(order(&list(&[1.0]), &list(&[1.0, 3.0])), Some(Ordering::Less));
        assert_eq!(order(&Value::number(1.0), &Value::quantity(1.0, Dim::LENGTH)), None);
    }
}

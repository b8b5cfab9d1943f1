//! Surfaces that parts were cut from: a picture shows the parts and not, over them, the whole again.

use std::collections::{BTreeMap, BTreeSet};

use crate::lang::eval::context::{Cx, Sound};
use crate::lang::eval::scene::side_of;
use crate::lang::run::symbols::Symbol;
use crate::lang::syntax::ast::Keyword;
use crate::lang::values::value::Value;
use crate::surface::{Domain, Surface};

/// Names of the declared surfaces from which another surface of the script was trimmed, split or imprinted, but those that a shell is
/// made of.
pub(super) fn surfaces(cx: &mut Cx, sound: &Sound) -> BTreeSet<String> {
    let symbols = cx.symbols();
    let place: BTreeMap<&str, usize> = symbols.iter().enumerate().rev().filter_map(|(k, s)| Some((s.name.as_deref()?, k))).collect();
    let mut made: Vec<(usize, Vec<Surface>)> = Vec::new();
    let mut shelled: Vec<Surface> = Vec::new();
    for (k, symbol) in symbols.iter().enumerate() {
        let Some(name) = symbol.name.as_ref().filter(|_| matches!(symbol.keyword, Keyword::Surface | Keyword::Let | Keyword::Shell)) else {
            continue;
        };
        let own = cx.value_of(name).map_or(Vec::new(), |value| surfaces_of(&value));
        match symbol.keyword {
            Keyword::Shell => shelled.extend(own),
            _ => made.push((k, own)),
        }
    }
    let mut out = BTreeSet::new();
    for (k, own) in &made {
        let parts: Vec<&Surface> = own.iter().filter(|part| part.domain() == Domain::Loop).collect();
        if parts.is_empty() {
            continue;
        }
        let below = needed(&symbols, *k);
        for declared in &sound.parts.surfaces {
            let (whole, name) = (&declared.value, declared.name.split('[').next().unwrap_or(""));
            let is_base = place.get(name).is_some_and(|base| below.contains(base)) && whole.domain() != Domain::Unbounded;
            if is_base && !shelled.iter().any(|s| s.is(whole)) && parts.iter().any(|part| is_part(part, whole)) {
                out.insert(declared.name.to_string());
            }
        }
    }
    out
}

fn surfaces_of(value: &Value) -> Vec<Surface> {
    let mut out = Vec::new();
    let _ = value.for_each_flat::<()>(&mut |v| {
        match v {
            Value::Surface(surface) => out.push(surface.clone()),
            Value::Shell(shell) => out.extend(shell.surfaces.iter().cloned()),
            _ => {}
        }
        Ok(())
    });
    out
}

/// The declarations that one depends on.
fn needed(symbols: &[Symbol], from: usize) -> BTreeSet<usize> {
    let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(at) = open.pop() {
        let direct = symbols.get(at).into_iter().flat_map(|s| s.needs.iter().copied());
        open.extend(direct.filter(|next| *next != from && seen.insert(*next)));
    }
    seen
}

/// Whether a surface is cut out of another one, on either side of it.
pub(super) fn is_part(part: &Surface, whole: &Surface) -> bool {
    !part.is(whole) && part.part_of().iter().any(|known| side_of(known, whole).is_some())
}

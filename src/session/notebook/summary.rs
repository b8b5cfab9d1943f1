//! What a change of the session was, in words.

use super::State;
use crate::lang::syntax::outline::{Outline, outline};

/// Characters of a declaration without a name that stand for it.
const SHOWN: usize = 40;

/// The declarations of a text: what they are called by, and how they read.
fn declarations(text: &str) -> Vec<(Option<String>, String)> {
    let of = |o: &Outline| {
        let at = |s: crate::lang::diag::span::Span| text[s.start as usize..s.end as usize].to_owned();
        (o.name.map(at), at(o.span))
    };
    outline(text).iter().map(of).collect()
}

/// Names whose declarations differ between two texts and stand in the second.
pub(super) fn changed_names(a: &str, b: &str) -> Vec<String> {
    let before = declarations(a);
    declarations(b).into_iter().filter(|d| !before.contains(d)).filter_map(|d| d.0).collect()
}

/// What happened between two states: "roof added, span set to 6m".
pub(super) fn change(from: &State, to: &State) -> String {
    let (before, after) = (declarations(&from.text), declarations(&to.text));
    let title = |d: &(Option<String>, String)| match &d.0 {
        Some(name) => name.clone(),
        None => {
            let line = d.1.lines().next().unwrap_or_default();
            let more = if line.chars().count() > SHOWN || d.1.lines().nth(1).is_some() { " …" } else { "" };
            format!("`{}{more}`", line.chars().take(SHOWN).collect::<String>())
        }
    };
    let named = |list: &[(Option<String>, String)], d: &(Option<String>, String)| d.0.is_some() && list.iter().any(|o| o.0 == d.0);
    let mut words: Vec<String> = Vec::new();
    for d in after.iter().filter(|d| !before.contains(d)) {
        words.push(format!("{} {}", title(d), if named(&before, d) { "redefined" } else { "added" }));
    }
    for d in before.iter().filter(|d| !after.contains(d) && !named(&after, d)) {
        words.push(format!("{} removed", title(d)));
    }
    for (name, value) in to.sets.iter().filter(|set| !from.sets.contains(set)) {
        words.push(format!("{name} set to {value}"));
    }
    for (name, _) in from.sets.iter().filter(|(name, _)| !to.sets.iter().any(|(other, _)| other == name)) {
        words.push(format!("{name} no longer set"));
    }
    if words.is_empty() { "the layout or the order".to_owned() } else { words.join(", ") }
}

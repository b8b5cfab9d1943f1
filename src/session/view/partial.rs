//! The frame of a model whose shapes are evaluated and the rest is not yet: what can be seen early is shown early.

use std::collections::BTreeSet;

use super::frame::{Frame, Param, Source, Thing, VERSION};
use super::things::Drawn;
use super::viewer::{View, Wanted, corners_of};

/// Least time from the shapes of a model to its end for which a frame of its own is worth drawing, seconds.
const WORTH: f64 = 0.15;

/// What is known of a model before all of it is evaluated.
pub(super) struct Early {
    pub model: String,
    pub units: String,
    pub sources: Vec<Source>,
    pub params: Vec<Param>,
    pub drawn: Drawn,
}

/// Whether shapes are shown before the rest: at first, and where the rest took its time in the run before.
pub(super) fn is_worth_it(last: &View, rest: f64) -> bool {
    last.frame.loft == 0 || rest > WORTH
}

/// The frame before the one that is wanted. What the last frame had and this one has not made yet stays, marked.
pub(super) fn view(wanted: &Wanted, early: Early, last: &View) -> View {
    let Early { model, units, sources, params, drawn } = early;
    let Drawn { mut things, mut buffers, chord_error } = drawn;
    for thing in &mut things {
        let before = last.frame.things.iter().find(|before| before.name == thing.name && before.buffers == thing.buffers);
        thing.facts = before.map(|before| before.facts.clone()).unwrap_or_default();
    }
    let made: BTreeSet<&str> = things.iter().map(|thing| &*thing.name).collect();
    let pending: Vec<Thing> = last.frame.things.iter().filter(|thing| !made.contains(&*thing.name)).cloned().collect();
    for thing in pending {
        for row in &thing.buffers {
            buffers.extend(last.buffers.get(&row.key).map(|buffer| (row.key.clone(), buffer.clone())));
        }
        things.push(Thing { stale: true, unmade: None, ..thing });
    }
    let number = wanted.number.saturating_sub(1);
    let frame = Frame {
        loft: VERSION,
        number,
        partial: true,
        title: model.clone(),
        model,
        units,
        ok: true,
        drawn: number,
        corners: corners_of(&buffers),
        chord_error,
        things,
        sources,
        params,
        ..Frame::default()
    };
    View { frame, buffers }
}

//! The frame of a model whose shapes are evaluated and the rest is not yet: what can be seen early is shown early.

use std::collections::{BTreeMap, BTreeSet};

use super::frame::{Frame, Param, Place, Source, Thing, VERSION};
use super::things::Drawn;
use super::viewer::{ThingNames, View, Wanted, base_of, corners_of};

/// Least time from the shapes of a model to its end for which a frame of its own is worth drawing, seconds.
const WORTH: f64 = 0.15;

/// What is known of a model before all of it is evaluated.
pub(super) struct Early {
    pub model: String,
    pub units: String,
    pub sources: Vec<Source>,
    pub params: Vec<Param>,
    pub drawn: Drawn,
    /// Names that the script declares, with the kinds of those that are made after the shapes, and their lines.
    pub declared: Vec<(String, Option<&'static str>, Option<Place>)>,
}

/// Whether shapes are shown before the rest: at first, and where the rest took its time in the run before.
pub(super) fn is_worth_it(last: &View, rest: f64) -> bool {
    last.frame.loft == 0 || rest > WORTH
}

/// The frame before the one that is wanted. What the last frame had and this one has not made yet stays, marked; what it had not is listed.
pub(super) fn view(wanted: &Wanted, early: Early, last: &View) -> View {
    let Early { model, units, sources, params, drawn, declared } = early;
    let Drawn { mut things, mut buffers, chord_error } = drawn;
    let mut known: BTreeMap<&str, Vec<&Thing>> = BTreeMap::new();
    last.frame.things.iter().for_each(|thing| known.entry(base_of(&thing.name)).or_default().push(thing));
    for thing in &mut things {
        let alike = known.get(base_of(&thing.name)).map_or(&[][..], |alike| alike);
        let before = alike.iter().find(|before| before.name == thing.name && before.buffers == thing.buffers);
        thing.facts = before.map(|before| before.facts.clone()).unwrap_or_default();
    }
    let made: BTreeSet<String> = things.iter().map(|thing| base_of(&thing.name).to_owned()).collect();
    for (name, kind, line) in declared.into_iter().filter(|(name, ..)| !made.contains(name)) {
        let chain: Vec<Place> = line.into_iter().collect();
        let before: Vec<Thing> = known.get(&*name).into_iter().flatten().map(|thing| (*thing).clone()).collect();
        if let (true, Some(kind)) = (before.is_empty(), kind) {
            things.push(Thing { name, kind, chain: chain.clone(), pending: true, ..Thing::default() });
        }
        for thing in before {
            buffers.extend(last.buffers_of(&thing));
            things.push(Thing { stale: true, pending: true, unmade: None, chain: chain.clone(), ..thing });
        }
    }
    let names = ThingNames::new(&things);
    things.iter_mut().for_each(|thing| thing.of = names.all(&thing.of));
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

//! A model that is shown while its script changes.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use super::buffer::Buffer;
use super::frame::{Frame, Place, Thing, VERSION};
use super::params;
use super::partial::{self, Early};
use super::places::{place, sources};
use super::said::{self, Statements};
use super::things::{self, Drawn, Evaluated, Kept};
use crate::base::bbox::Box3;
use crate::base::job::Job;
use crate::lang::diag::diagnostic::FileId;
use crate::lang::eval::context::Cx;
use crate::lang::run::symbols::Symbol;
use crate::lang::syntax::ast::Keyword;
use crate::lang::values::units::number_text;
use crate::session::collect;
use crate::session::guard::Bug;
use crate::session::live::{Clock, Live, Looks};
use crate::session::report::{Corners, Report};
use crate::session::run::Outcome;

/// Significant digits of measured values.
const DIGITS: usize = 6;

/// What is to be shown.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Counts up.
    pub number: u64,
    /// The script.
    pub text: String,
    /// Params set on the page, with the text of a literal.
    pub sets: Vec<(String, String)>,
    /// How far display triangles may be from their surfaces, model units.
    pub chord_error: Option<f64>,
}

/// A frame with its buffers.
#[derive(Clone, Debug, Default)]
pub struct View {
    /// What is listed.
    pub frame: Frame,
    /// What is drawn, by key.
    pub buffers: BTreeMap<String, Buffer>,
}

impl View {
    /// The buffers of a thing, by key.
    pub(super) fn buffers_of(&self, thing: &Thing) -> Vec<(String, Buffer)> {
        thing.buffers.iter().filter_map(|row| Some((row.key.clone(), self.buffers.get(&row.key)?.clone()))).collect()
    }
}

/// A script and what its frames left.
pub struct Viewer {
    live: Live,
    kept: Kept,
    last: View,
    clock: Clock,
    /// Seconds that the last run took from its shapes to its end.
    rest: f64,
}

/// What a run leaves while its model is there.
#[derive(Default)]
struct Seen {
    drawn: Drawn,
    params: Vec<super::frame::Param>,
    statements: Statements,
    /// Names that were declared and have no value, with their lines.
    valueless: Vec<(String, Option<Place>)>,
    /// The script and its modules.
    files: Vec<FileId>,
    /// The text could be read as a script.
    read: bool,
}

impl Viewer {
    /// A model shown as `name`; its imports are looked for beside `script`.
    pub fn new(name: &str, script: Option<&Path>, allow: &[PathBuf], clock: Clock) -> Self {
        let live = Live::new(name, script, allow, clock.clone());
        Self { live, kept: Kept::default(), last: View::default(), clock, rest: 0.0 }
    }

    /// The files that the last run read or looked for and did not find, the script itself apart.
    pub fn files(&self) -> &[PathBuf] {
        self.live.files()
    }

    /// Texts that the next runs read instead of the files of their names.
    pub fn set_unsaved(&mut self, texts: BTreeMap<PathBuf, Arc<str>>) {
        self.live.set_unsaved(Arc::new(texts));
    }

    /// What was shown last.
    pub fn last(&self) -> &View {
        &self.last
    }

    /// Evaluates and draws the script; `None` when it was stopped. What cannot be made now is shown as it was, and marked.
    ///
    /// Fails as [`Live::run`].
    pub fn show(&mut self, wanted: &Wanted, job: &Job) -> Result<Option<View>, Bug> {
        self.shown(wanted, job, None)
    }

    /// The same; where the rest is expected to take longer, `early` gets a frame of the shapes before. It has the number before the wanted
    /// one, and shows with a mark what the frame before had and is not made yet.
    ///
    /// Fails as [`Live::run`].
    pub fn show_early(&mut self, wanted: &Wanted, job: &Job, early: &mut (dyn FnMut(View) + Send)) -> Result<Option<View>, Bug> {
        self.shown(wanted, job, Some(early))
    }

    fn shown(&mut self, wanted: &Wanted, job: &Job, early: Option<&mut (dyn FnMut(View) + Send)>) -> Result<Option<View>, Bug> {
        let (mut seen, kept, clock) = (Seen::default(), Mutex::new(&mut self.kept), self.clock.clone());
        let draw = |cx: &mut Cx<'_>, symbols: &[Symbol], evaluated: Evaluated| {
            let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
            things::draw(cx, symbols, wanted.chord_error, evaluated, &mut kept)
        };
        let places = Places::of(&self.live);
        let mut early = early.filter(|_| partial::is_worth_it(&self.last, self.rest));
        let (last, began) = (&self.last, clock());
        let mut shaped_at = began;
        let mut shaped = |cx: &mut Cx<'_>| {
            if let Some(early) = &mut early
                && job.go_on().is_ok()
            {
                let symbols = cx.symbols();
                let drawn = draw(cx, &symbols, Evaluated::Shapes);
                let sources = sources(&cx.program.sources, &cx.script_files(), &|name| places.path(name));
                let (model, units) = (places.name.clone(), cx.unit().name.to_owned());
                // Without a shape there is nothing to look at yet.
                if !drawn.buffers.is_empty() {
                    let params = params::params(cx);
                    let declared = symbols.iter().filter_map(|symbol| {
                        let line = place(&cx.program.sources, symbol.file, symbol.span, None);
                        let kind = match symbol.keyword {
                            Keyword::Mesh => Some("mesh"),
                            Keyword::Group => Some("group"),
                            _ => None,
                        };
                        Some((symbol.name.clone()?, kind, line))
                    });
                    let declared = declared.collect();
                    early(partial::view(wanted, Early { model, units, sources, params, drawn, declared }, last));
                }
            }
            shaped_at = clock();
        };
        let mut look = |cx: &mut Cx<'_>| {
            let symbols = cx.symbols();
            let drawn = draw(cx, &symbols, Evaluated::Whole);
            let line = |(file, span)| place(&cx.program.sources, file, span, None);
            let valueless = cx.declared_without_value(&symbols).into_iter().map(|(name, at)| (name, line(at))).collect();
            seen = Seen {
                drawn,
                params: params::params(cx),
                statements: said::statements(cx, &symbols),
                valueless,
                files: cx.script_files(),
                read: true,
            };
        };
        let looks = Looks { whole: &mut look, shaped: Some(&mut shaped) };
        let outcome = self.live.run_shown(&wanted.text, &wanted.sets, job, looks)?;
        if outcome.interrupted {
            return Ok(None);
        }
        let ended = clock();
        let seconds = ended - began;
        self.rest = ended - shaped_at;
        let view = self.view(wanted, seen, &outcome, seconds);
        self.last = view.clone();
        Ok(Some(view))
    }

    fn view(&self, wanted: &Wanted, seen: Seen, outcome: &Outcome, seconds: f64) -> View {
        let Drawn { mut things, mut buffers, chord_error } = seen.drawn;
        facts(&mut things, &outcome.report);
        let old = &self.last;
        let made: BTreeSet<String> = things.iter().map(|thing| thing.name.clone()).collect();
        let is_lost = |thing: &&Thing| {
            let base = base_of(&thing.name);
            !thing.buffers.is_empty()
                && !made.contains(&thing.name)
                && (!seen.read || seen.valueless.iter().any(|valueless| valueless.0 == base))
        };
        let lost: Vec<Thing> = old.frame.things.iter().filter(is_lost).cloned().collect();
        let stale = !lost.is_empty();
        for thing in lost {
            buffers.extend(old.buffers_of(&thing));
            // Its lines may have moved since.
            let now = seen.valueless.iter().find(|(name, _)| name == base_of(&thing.name));
            let chain = now.and_then(|(_, line)| line.clone()).into_iter().collect();
            let unmade = Some("it could not be made now".to_owned());
            things.push(Thing { stale: true, unmade, chain, ..thing });
        }
        for (name, line) in &seen.valueless {
            let is_there = things.iter().any(|thing| base_of(&thing.name) == name);
            let row = outcome.report.unmade.iter().find(|row| row.name == *name);
            if let (false, Some(kind)) = (is_there, row.and_then(|row| kind_of(&row.what))) {
                let unmade = Some(match row.and_then(|row| row.because.as_deref()) {
                    None => "it is wrong itself".to_owned(),
                    Some("") => "it uses what could not be made".to_owned(),
                    Some(of) => format!("it needs {of}"),
                });
                let chain = line.iter().cloned().collect();
                things.push(Thing { name: name.clone(), kind, unmade, chain, visible: true, ..Thing::default() });
            }
        }
        let places = Places::of(&self.live);
        let (mut checks, reports) = seen.statements.with(&outcome.report);
        let names = ThingNames::new(&things);
        things.iter_mut().for_each(|thing| thing.of = names.all(&thing.of));
        checks.iter_mut().for_each(|check| check.things = names.all(&check.things));
        let frame = Frame {
            loft: VERSION,
            number: wanted.number,
            partial: false,
            model: places.name.clone(),
            title: places.name.clone(),
            units: outcome.report.units.clone(),
            ok: outcome.report.ok,
            stale,
            drawn: wanted.number,
            seconds,
            corners: corners_of(&buffers),
            chord_error,
            diagnostics: said::diagnostics(&outcome.diagnostics, &outcome.sources, &things),
            things,
            sources: sources(&outcome.sources, &seen.files, &|name| places.path(name)),
            params: seen.params,
            checks,
            reports,
            pictures: seen.statements.pictures,
            outputs: seen.statements.outputs,
            compare: None,
        };
        View { frame, buffers }
    }
}

/// The box of what is drawn, model units.
pub(super) fn corners_of(buffers: &BTreeMap<String, Buffer>) -> Option<Corners> {
    collect::corners(buffers.values().map(|buffer| buffer.around).fold(Box3::EMPTY, Box3::union))
}

/// Where the files of a model stand.
struct Places {
    name: String,
    script: PathBuf,
}

impl Places {
    fn of(live: &Live) -> Self {
        Self { name: live.name().to_owned(), script: live.script().map(Path::to_owned).unwrap_or_default() }
    }

    /// The full path of a file of this name; empty where there is none.
    fn path(&self, name: &str) -> String {
        let place = if name == self.name { self.script.clone() } else { self.script.parent().unwrap_or(Path::new("")).join(name) };
        if place.is_file() { std::path::absolute(&place).unwrap_or(place).to_string_lossy().into_owned() } else { String::new() }
    }
}

/// The declared name of a member: `ribs` of `ribs[2]`.
pub(super) fn base_of(name: &str) -> &str {
    name.split('[').next().unwrap_or_default()
}

/// Which things a name of the script stands for: members of a family stand by themselves or, where there are many, as one.
pub(super) struct ThingNames {
    all: BTreeSet<String>,
    members: BTreeMap<String, Vec<String>>,
}

impl ThingNames {
    pub fn new(things: &[Thing]) -> Self {
        let mut members: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for thing in things.iter().filter(|thing| thing.name.contains('[')) {
            members.entry(base_of(&thing.name).to_owned()).or_default().push(thing.name.clone());
        }
        Self { all: things.iter().map(|thing| thing.name.clone()).collect(), members }
    }

    /// The things of these names, each once.
    pub fn all(&self, names: &[String]) -> Vec<String> {
        let mut seen = BTreeSet::new();
        let of = |name: &String| -> Vec<String> {
            match self.members.get(name) {
                _ if self.all.contains(name) => vec![name.clone()],
                Some(members) => members.clone(),
                None if self.all.contains(base_of(name)) => vec![base_of(name).to_owned()],
                None => vec![name.clone()],
            }
        };
        names.iter().flat_map(of).filter(|name| seen.insert(name.clone())).collect()
    }
}

/// The kind of a thing that a word declares, where it is drawn.
fn kind_of(word: &str) -> Option<&'static str> {
    let kinds = ["point", "curve", "surface", "shell", "mesh", "group"];
    if word == "modeling curve" { Some("curve") } else { kinds.into_iter().find(|kind| *kind == word) }
}

/// What the report says of each thing.
fn facts(things: &mut [Thing], report: &Report) {
    let length = |x: f64, power: &str| format!("{} {}{power}", rounded(x), report.units);
    let count = |n: usize| n.to_string();
    let curves: BTreeMap<&str, _> = report.curves.iter().map(|row| (&*row.name, row)).collect();
    let chains: BTreeMap<&str, _> = report.modeling.iter().map(|row| (&*row.name, row)).collect();
    let surfaces: BTreeMap<&str, _> = report.surfaces.iter().map(|row| (&*row.name, row)).collect();
    for thing in things {
        let name = &*thing.name;
        let mut say = |what: &str, text: String| thing.facts.push((what.to_owned(), text));
        match thing.kind {
            "curve" => {
                if let Some(row) = curves.get(name) {
                    say("kind", row.kind.to_owned());
                    say("length", length(row.length, ""));
                    say("links", count(row.links));
                } else if let Some(row) = chains.get(name) {
                    say("length", length(row.length, ""));
                    say("links", count(row.links));
                    say("kinks", count(row.kinks));
                }
            }
            "surface" => {
                if let Some(row) = surfaces.get(name) {
                    say("kind", row.kind.to_owned());
                    row.flow.iter().for_each(|flow| say("flow", flow.clone()));
                    row.area.iter().for_each(|area| say("area", length(*area, "²")));
                    say("patches", count(row.patches));
                    say("edges", count(row.edges));
                }
            }
            "shell" => {
                if let Some(row) = report.shells.iter().find(|row| row.name == name) {
                    say("faces", count(row.faces));
                    say("closed", if row.closed { "yes" } else { "no" }.to_owned());
                    row.area.iter().for_each(|area| say("area", length(*area, "²")));
                    row.volume.iter().for_each(|volume| say("volume", length(*volume, "³")));
                    row.gap.iter().for_each(|gap| say("largest gap", length(*gap, "")));
                    row.angle.iter().for_each(|angle| say("largest angle", format!("{}°", rounded(*angle))));
                }
            }
            "mesh" => {
                if let Some(row) = report.meshes.iter().find(|row| row.name == name) {
                    say("nodes", count(row.nodes));
                    say("triangles", count(row.triangles));
                    say("quads", count(row.quads));
                    row.min_angle.iter().for_each(|angle| say("least angle", format!("{}°", rounded(*angle))));
                    row.mean_quality.iter().for_each(|quality| say("mean quality", rounded(*quality)));
                    row.min_quality.iter().for_each(|quality| say("least quality", rounded(*quality)));
                    row.area.iter().for_each(|area| say("area", length(*area, "²")));
                    row.chord_error.iter().for_each(|error| say("chord error", length(*error, "")));
                    row.watertight.iter().for_each(|tight| say("watertight", if *tight { "yes" } else { "no" }.to_owned()));
                }
            }
            _ => {}
        }
    }
}

fn rounded(x: f64) -> String {
    number_text(format!("{x:.*e}", DIGITS - 1).parse().unwrap_or(x))
}

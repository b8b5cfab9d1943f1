//! Candidates for a place, the likeliest first.

use crate::lang::assist::function::{Function, Parameter};
use crate::lang::assist::place::{CompletionPlace, Stand, Wanted, stand};
use crate::lang::assist::scripts::{Scripts, Unit};
use crate::lang::assist::shape::KnownType;
use crate::lang::eval::std::{Builtin, builtins, fields};
use crate::lang::syntax::ast::Keyword;
use crate::lang::syntax::keywords::{WORDS, openers, written};
use crate::lang::values::settings::{Setting, default_words};
use crate::lang::values::types::{TYPE_NAMES, Ty};

/// What a candidate is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Sort {
    Name,
    Field,
    Function,
    Argument,
    Setting,
    /// A word of a choice, a unit, or the name of a type.
    Word,
    Keyword,
}

/// What may stand at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Candidate {
    /// Text that is put there.
    pub text: String,
    /// A line about it.
    pub about: String,
    /// What it is.
    pub sort: Sort,
    /// 0 is what is asked for there; what is only possible has more.
    pub rank: u8,
}

/// All that may stand at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Offer {
    /// First byte of what is replaced.
    pub start: usize,
    /// By rank, then by name.
    pub candidates: Vec<Candidate>,
    /// The place is inside a string, which may name a file.
    pub file: bool,
}

/// Candidates under way.
struct Offered<'w> {
    word: &'w str,
    found: Vec<Candidate>,
}

impl Offered<'_> {
    fn put(&mut self, text: &str, about: String, sort: Sort, rank: u8) {
        if text.starts_with(self.word) {
            self.found.push(Candidate { text: text.to_owned(), about, sort, rank });
        }
    }

    fn words(&mut self, words: &[&str], rank: u8) {
        words.iter().for_each(|word| self.put(word, (*word).to_owned(), Sort::Word, rank));
    }

    fn builtin(&mut self, builtin: &Builtin, rank: u8) {
        if builtin.name.starts_with(self.word) {
            self.put(&format!("{}(", builtin.name), builtin.signature(), Sort::Function, rank);
        }
    }

    fn function(&mut self, function: &Function, rank: u8) {
        self.put(&format!("{}(", function.name), function.signature.clone(), Sort::Function, rank);
    }

    fn keywords(&mut self, rank: u8) {
        for word in openers() {
            self.put(word.written(), word.form.lines().next().unwrap_or("").to_owned(), Sort::Keyword, rank);
        }
    }
}

/// Ranks behind those of what is asked for.
const POSSIBLE: u8 = 1;
const ARGUMENT: u8 = 2;
const FUNCTION: u8 = 3;
const OTHER: u8 = 4;

pub(crate) fn offer(scripts: &Scripts<'_>, at: usize, session: bool) -> Offer {
    let home = scripts.unit(0);
    let mut here = stand(scripts, at);
    let mut offered = Offered { word: &home.text[here.start..at], found: Vec::new() };
    match std::mem::replace(&mut here.place, CompletionPlace::Nothing) {
        CompletionPlace::Nothing => {}
        CompletionPlace::Start => {
            offered.keywords(0);
            if session {
                values(scripts, &mut offered, &here, &Wanted::default());
            }
        }
        CompletionPlace::Member(shape) => members(scripts, &mut offered, &shape),
        CompletionPlace::Key(table, clauses, given) => {
            table
                .iter()
                .filter(|s| !given.contains(&s.key.to_owned()))
                .for_each(|s| offered.put(&format!("{}: ", s.key), of_setting(s), Sort::Setting, 0));
            for word in WORDS.iter().filter(|w| clauses && matches!(w.word, "on" | "near" | "in")) {
                let form = if word.word == "in" { "in box(a, b) { size: 5mm }" } else { word.form };
                offered.put(&format!("{} ", word.word), form.to_owned(), Sort::Keyword, POSSIBLE);
            }
        }
        CompletionPlace::Value(wanted) => values(scripts, &mut offered, &here, &wanted),
        CompletionPlace::Behind(words) => {
            let form = |word: &str| WORDS.iter().find(|w| w.word == word).map_or("", |w| w.form).lines().next().unwrap_or("").to_owned();
            words.iter().for_each(|word| offered.put(word, form(word), Sort::Keyword, 0));
            if !offered.word.is_empty() {
                offered.keywords(OTHER);
            }
        }
        CompletionPlace::Type => offered.words(TYPE_NAMES, 0),
        CompletionPlace::Words(words) => offered.words(&words, 0),
    }
    let mut candidates = offered.found;
    write_once(&mut candidates, &home.text[at..]);
    candidates.sort_by(|a, b| (a.rank, &a.text).cmp(&(b.rank, &b.text)));
    let mut seen = std::collections::BTreeSet::new();
    candidates.retain(|c| seen.insert(c.text.clone()));
    Offer { start: here.start, candidates, file: false }
}

/// Leaves out what stands behind the word already: the colon of a key, the bracket of a call.
fn write_once(candidates: &mut [Candidate], behind: &str) {
    let behind = behind.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_').trim_start_matches(' ');
    let Some(sign) = behind.chars().next().filter(|sign| matches!(sign, ':' | '(')) else { return };
    for candidate in candidates {
        let end = candidate.text.trim_end();
        if let Some(bare) = end.strip_suffix(sign) {
            candidate.text = bare.to_owned();
        }
    }
}

/// `size: length = 3mm`.
fn of_setting(setting: &Setting) -> String {
    format!("{}: {}{}", setting.key, setting.ty.signature(), default_words(setting))
}

/// `curve` of a curve, `param: length` of a param.
fn of_name(keyword: Keyword, shape: &KnownType) -> String {
    let (word, shown) = (written(keyword), shape.signature());
    if shown.is_empty() || shown == word || word.ends_with(&shown) { word.to_owned() } else { format!("{word}: {shown}") }
}

fn members(scripts: &Scripts<'_>, offered: &mut Offered<'_>, shape: &KnownType) {
    match shape {
        KnownType::Module(module) => return of_module(scripts, offered, *module),
        KnownType::Record(keys) => {
            keys.iter().filter(|(key, _)| is_name(key)).for_each(|(key, of)| offered.put(key, of.signature(), Sort::Field, 0))
        }
        _ => {}
    }
    let known = *shape != KnownType::Unknown;
    for field in fields().filter(|f| f.params.first().is_some_and(|p| shape.has_fields_of(p.ty))) {
        let about = format!("{}: {}", field.returns.signature(), field.summary());
        offered.put(field.name, about, Sort::Field, 0);
    }
    let home = scripts.unit(0);
    for name in &home.order {
        let Some(function) = Function::of_script(scripts, 0, name) else { continue };
        if function.params.first().is_some_and(|p| shape.fits(p.ty)) {
            offered.function(&function, POSSIBLE);
        }
    }
    for builtin in builtins() {
        let Some(first) = builtin.params.first() else { continue };
        let meant = !matches!(first.ty, Ty::Any | Ty::Rest(_) | Ty::List(Ty::Any)) || matches!(shape, KnownType::List(_));
        if shape.fits(first.ty) && (meant || !known || !offered.word.is_empty()) {
            offered.builtin(builtin, if meant { FUNCTION } else { OTHER });
        }
    }
}

/// Whether a key can stand behind a dot.
fn is_name(key: &str) -> bool {
    let mut letters = key.chars();
    letters.next().is_some_and(|c| c == '_' || c.is_alphabetic()) && letters.all(|c| c == '_' || c.is_alphanumeric())
}

fn of_module(scripts: &Scripts<'_>, offered: &mut Offered<'_>, module: usize) {
    let home = scripts.unit(module);
    for name in &home.order {
        match (Function::of_script(scripts, module, name), home.declared.get(name)) {
            (Some(function), _) => offered.function(&function, 0),
            (None, Some(entry)) if entry.keyword != Keyword::Fn => {
                let shape = scripts.shape_of_name(module, name, &Vec::new());
                offered.put(name, of_name(entry.keyword, &shape), Sort::Name, 0);
            }
            _ => {}
        }
    }
}

fn values(scripts: &Scripts<'_>, offered: &mut Offered<'_>, here: &Stand, wanted: &Wanted) {
    if let Some((function, given)) = &wanted.call {
        let rank = if wanted.named { 0 } else { ARGUMENT };
        let free = |p: &&Parameter| !given.contains(&p.name);
        function.params.iter().filter(free).for_each(|p| offered.put(&format!("{}: ", p.name), p.signature(), Sort::Argument, rank));
    }
    if wanted.named {
        return;
    }
    offered.words(&wanted.words.iter().map(String::as_str).collect::<Vec<_>>(), 0);
    let home = scripts.unit(0);
    let ty = wanted.ty.filter(|ty| *ty != Ty::Any);
    // A name that does not fit may lead to something that does, once it is begun.
    let rank = |shape: &KnownType| match ty {
        None => Some(0),
        Some(ty) if shape.fits(ty) => Some(if *shape == KnownType::Unknown { POSSIBLE } else { 0 }),
        Some(_) if offered.word.is_empty() => None,
        Some(_) => Some(OTHER),
    };
    let rank_of_local: Vec<(String, KnownType, Option<u8>)> =
        here.locals.iter().map(|(name, shape)| (name.clone(), shape.clone(), rank(shape))).collect();
    let own = own_name(&home, here.start);
    let names = home.order.iter().filter(|name| Some(name.as_str()) != own);
    let of_names: Vec<(&String, KnownType, Option<u8>)> = names
        .filter(|name| home.declared.get(*name).is_some_and(|entry| entry.keyword != Keyword::Fn))
        .map(|name| (name, scripts.shape_of_name(0, name, &Vec::new())))
        .map(|(name, shape)| (name, rank(&shape), shape))
        .map(|(name, rank, shape)| (name, shape, rank))
        .collect();
    let typed = !offered.word.is_empty();
    for (name, shape, rank) in rank_of_local {
        if let Some(rank) = rank {
            offered.put(&name, format!("local: {}", shape.signature()).trim_end_matches(": ").to_owned(), Sort::Name, rank);
        }
    }
    for (name, shape, rank) in of_names {
        if let (Some(rank), Some(entry)) = (rank, home.declared.get(name)) {
            offered.put(name, of_name(entry.keyword, &shape), Sort::Name, rank);
        }
    }
    if let Some(words) = ty.and_then(Ty::choices) {
        offered.words(words, 0);
    }
    if ty.is_some_and(|ty| KnownType::Is(Ty::Bool).fits(ty)) {
        offered.words(&["true", "false"], 0);
    }
    functions(scripts, offered, ty, typed);
    if typed {
        WORDS
            .iter()
            .filter(|w| w.keyword.is_none())
            .for_each(|w| offered.put(w.word, w.form.lines().next().unwrap_or("").to_owned(), Sort::Keyword, OTHER));
        offered.keywords(OTHER);
    }
}

/// Functions that give what is wanted; others once they are begun.
fn functions(scripts: &Scripts<'_>, offered: &mut Offered<'_>, ty: Option<Ty>, typed: bool) {
    let rank = |gives: &KnownType| match ty {
        None => Some(FUNCTION),
        Some(ty) if *gives != KnownType::Unknown && gives.fits(ty) => Some(FUNCTION),
        _ if typed => Some(OTHER),
        _ => None,
    };
    let home = scripts.unit(0);
    for function in home.order.iter().filter_map(|name| Function::of_script(scripts, 0, name)) {
        let known = rank(&function.gives).or((function.gives == KnownType::Unknown).then_some(OTHER));
        known.into_iter().for_each(|rank| offered.function(&function, rank));
    }
    for builtin in builtins() {
        if let Some(rank) = rank(&KnownType::of(builtin.returns)) {
            offered.builtin(builtin, rank);
        }
    }
}

/// The name that the declaration around a place makes: it cannot stand in itself.
fn own_name(home: &Unit, at: usize) -> Option<&str> {
    let (span, name) = home.spans.iter().rev().find(|(span, _)| (span.start as usize) < at)?;
    let beyond = home.text.get(span.end as usize..at).is_some_and(|between| between.contains('\n'));
    name.filter(|_| !beyond).map(|name| home.source(name.start, name.end))
}

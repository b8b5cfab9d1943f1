//! Directory entries and the text of their parameters.
//!
//! Pointers are numbers of directory lines. They count as written where the numbers ascend, else lines are counted; parameters are
//! found by their line number and checked by the pointer back to the entry.

use std::cell::Cell;
use std::collections::BTreeMap;

use crate::io::files::fault::Malformed;
use crate::io::iges::global::{self, Global};
use crate::io::iges::lines::{self, DATA, Line, number_of};
use crate::io::iges::params::{Tokens, tokens};

/// Whether a value of the status field says yes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Status {
    /// Not shown.
    pub blanked: bool,
    /// Exists only as a part of its parents.
    pub physically_dependent: bool,
    /// What it is for: 0 geometry, 1 annotation, 2 definition, 3 other, 4 logic, 5 parameter space, 6 construction.
    pub purpose: u8,
}

/// One entity of the directory.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Entry {
    /// Number of its first directory line: what pointers say.
    pub d: u32,
    /// Line of the file.
    pub line: u64,
    /// Entity type.
    pub kind: u32,
    /// Form number.
    pub form: i32,
    /// Layer.
    pub level: i32,
    /// Pointer to its transformation matrix, 0 for none.
    pub transform: u32,
    /// Colour number, or below 0 a pointer to a colour.
    pub color: i64,
    /// Visibility and dependence.
    pub status: Status,
    /// Label, empty for none.
    pub label: String,
    /// Number behind the label.
    pub subscript: u32,
    /// First of its lines in the parameter section, as an index.
    first: usize,
    /// How many.
    lines: usize,
}

/// A file taken apart.
#[derive(Debug)]
pub struct Records<'a> {
    /// Separators, unit, scale.
    pub global: Global,
    /// Entities in file order.
    pub entries: Vec<Entry>,
    /// What was repaired or skipped.
    pub warnings: Vec<Malformed>,
    parameters: Vec<Line<'a>>,
}

/// Takes a file apart, or says why it is none of IGES.
pub fn read(bytes: &[u8]) -> Result<Records<'_>, Malformed> {
    let mut warnings = Vec::new();
    let sections = lines::sections(bytes, &mut warnings)?;
    if sections.global.is_empty() && sections.directory.is_empty() {
        return Err(Malformed::line(sections.last_line, "the file ends before its global section (G)"));
    }
    if sections.directory.is_empty() {
        return Err(Malformed::line(sections.last_line, "the file has no directory section (D)"));
    }
    if sections.parameters.is_empty() {
        return Err(Malformed::line(sections.last_line, "the file ends in its directory section: there is no parameter section (P)"));
    }
    let global = global::read(&sections, &mut warnings);
    let mut entries = directory(&sections.directory, &mut warnings);
    let index = Index::of(&sections.parameters);
    for entry in &mut entries {
        index.locate(entry, &mut warnings);
    }
    Ok(Records { global, entries, warnings, parameters: sections.parameters })
}

/// Pairs of directory lines as entries.
fn directory(lines: &[Line], warnings: &mut Vec<Malformed>) -> Vec<Entry> {
    let ascending = lines.windows(2).all(|w| w[0].sequence < w[1].sequence) && lines[0].sequence > 0;
    if !ascending {
        let broken = lines.windows(2).find(|w| w[0].sequence >= w[1].sequence).map_or(lines[0].line, |w| w[1].line);
        warnings.push(Malformed::line(broken, "the numbers of the directory lines do not ascend; the lines are counted instead"));
    }
    let number = |k: usize| if ascending { lines[k].sequence } else { k as u32 + 1 };
    let mut entries = Vec::with_capacity(lines.len() / 2);
    let mut k = 0;
    while k < lines.len() {
        let (first, d) = (&lines[k], number(k));
        let pair = lines.get(k + 1).filter(|_| number(k + 1) == d + 1 && d % 2 == 1);
        let Some(second) = pair else {
            warnings.push(Malformed::line(first.line, format!("the directory entry D{d} has only one of its two lines and is skipped")));
            k += 1;
            continue;
        };
        match entry(first, second, d) {
            Ok(entry) => entries.push(entry),
            Err(what) => warnings.push(Malformed::line(first.line, format!("the directory entry D{d} is skipped: {what}"))),
        }
        k += 2;
    }
    entries
}

/// The ten fields of a directory line, each 8 columns; of a line whose letter is not in its column the words count.
fn fields<'a>(line: &Line<'a>) -> [&'a [u8]; 9] {
    let mut fields: [&[u8]; 9] = [b""; 9];
    if line.shift == 0 {
        for (k, field) in fields.iter_mut().enumerate() {
            let from = (8 * k).min(line.content.len());
            *field = &line.content[from..(from + 8).min(line.content.len())];
        }
    } else {
        let words = line.content.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty());
        fields.iter_mut().zip(words).for_each(|(field, word)| *field = word);
    }
    fields
}

/// A whole number of a directory field; blank is 0.
fn int(field: &[u8]) -> Option<i64> {
    let text = std::str::from_utf8(field).ok()?.trim();
    if text.is_empty() { Some(0) } else { text.parse().ok().filter(|n: &i64| n.abs() <= i64::from(i32::MAX)) }
}

fn entry(first: &Line, second: &Line, d: u32) -> Result<Entry, String> {
    let (a, b) = (fields(first), fields(second));
    let wanted =
        |field: &[u8], what: &str| int(field).ok_or_else(|| format!("`{}` is not a valid {what}", crate::io::iges::params::shown(field)));
    let kind = wanted(a[0], "entity type")?;
    let again = int(b[0]).unwrap_or(0);
    if kind <= 0 || (again != kind && again != 0) {
        return Err(format!("its lines name entity types {kind} and {again}"));
    }
    let start = wanted(a[1], "line of the parameter section")?;
    let optional = |field: &[u8]| int(field).unwrap_or(0);
    Ok(Entry {
        d,
        line: first.line,
        kind: kind as u32,
        form: optional(b[4]) as i32,
        level: optional(a[4]) as i32,
        transform: optional(a[6]).unsigned_abs() as u32,
        color: optional(b[2]),
        status: status(a[8]),
        label: crate::io::iges::params::shown(b[7]),
        subscript: number_of(b[8]),
        first: start.max(0) as usize,
        lines: optional(b[3]).max(0) as usize,
    })
}

/// Eight digits in pairs: blank, subordinate, use, hierarchy; blanks are zeros.
fn status(field: &[u8]) -> Status {
    let mut digits = [0_u8; 8];
    let text = field.trim_ascii_end();
    for (to, from) in digits.iter_mut().rev().zip(text.iter().rev()) {
        *to = if from.is_ascii_digit() { from - b'0' } else { 0 };
    }
    let pair = |k: usize| digits[k] * 10 + digits[k + 1];
    Status { blanked: pair(0) == 1, physically_dependent: matches!(pair(2), 1 | 3), purpose: pair(4) }
}

/// Where parameter lines are.
struct Index<'l, 'a> {
    lines: &'l [Line<'a>],
    /// Index of the line with a number.
    numbers: BTreeMap<u32, usize>,
    /// First line of each entity by the pointers back.
    owners: BTreeMap<u32, usize>,
    /// Lines that entities without pointers back may still take: they cannot share all lines of a large file.
    free: Cell<usize>,
}

/// The pointer back to the entity, 0 when it cannot be read; column 65 is free, or holds a separator that belongs in 64.
fn owner(line: &Line) -> u32 {
    let field = line.content.get(DATA.saturating_add_signed(line.shift)..).unwrap_or_default();
    number_of(match field {
        [c, rest @ ..] if !c.is_ascii_digit() => rest,
        _ => field,
    })
}

impl<'l, 'a> Index<'l, 'a> {
    fn of(lines: &'l [Line<'a>]) -> Self {
        let (mut numbers, mut owners) = (BTreeMap::new(), BTreeMap::new());
        for (k, line) in lines.iter().enumerate() {
            if line.sequence > 0 {
                numbers.entry(line.sequence).or_insert(k);
            }
            owners.entry(owner(line)).or_insert(k);
        }
        let free = Cell::new(2 * lines.len());
        Self { lines, numbers, owners, free }
    }

    /// Finds the lines of an entity; warns where directory and parameter section disagree.
    fn locate(&self, entry: &mut Entry, warnings: &mut Vec<Malformed>) {
        let (announced, d) = (entry.lines, entry.d);
        let by_number = u32::try_from(entry.first).ok().and_then(|n| self.numbers.get(&n).copied());
        let owned = |k: usize| owner(&self.lines[k]) == d;
        let place = match by_number.filter(|k| owned(*k)).or_else(|| self.owners.get(&d).copied()) {
            Some(k) => k,
            None => match by_number {
                Some(k) => k,
                None => {
                    let what = format!("entity {} at D{d} has no parameters: there is no line P{}", entry.kind, entry.first);
                    warnings.push(Malformed::line(entry.line, what));
                    (entry.first, entry.lines) = (0, 0);
                    return;
                }
            },
        };
        if by_number != Some(place) {
            let line = self.lines[place].line;
            let what = format!("the directory says that the parameters of D{d} are at P{}; they are here", entry.first);
            warnings.push(Malformed::line(line, what));
        }
        let run = self.lines[place..].iter().take_while(|l| owner(l) == d).count();
        entry.first = place;
        entry.lines = run;
        if run == 0 {
            entry.lines = announced.clamp(1, self.lines.len() - place).min(self.free.get());
            self.free.set(self.free.get() - entry.lines);
        }
        if run > 0 && announced != run && announced > 0 {
            let what = format!("the directory says that D{d} has {announced} lines of parameters; it has {run}");
            warnings.push(Malformed::line(self.lines[place].line, what));
        }
    }
}

/// The parameters of one entity.
#[derive(Debug)]
pub struct Parameters {
    /// The text of its lines in a row.
    pub text: Vec<u8>,
    /// Its values; the first one is the entity type again.
    pub list: Tokens,
    /// Line of the file where they start.
    pub line: u64,
    /// Lines whose column 65 holds a separator.
    pub spilled: usize,
}

impl Records<'_> {
    /// The parameters of the entity with this index.
    pub fn parameters(&self, k: usize) -> Parameters {
        let entry = &self.entries[k];
        let separators = self.global.separators;
        let lines = &self.parameters[entry.first.min(self.parameters.len())..];
        let lines = &lines[..entry.lines.min(lines.len())];
        let mut text = Vec::with_capacity(lines.len() * (DATA + 1));
        let mut spilled = 0;
        for line in lines {
            // A shifted line has its letter elsewhere: eight columns before it belong to the pointer back.
            let columns = DATA.saturating_add_signed(line.shift);
            let end = text.len() + columns;
            text.extend_from_slice(&line.content[..line.content.len().min(columns)]);
            text.resize(end, b' ');
            if let Some(&c) = line.content.get(columns)
                && (c == separators.value || c == separators.record)
            {
                text.push(c);
                spilled += 1;
            }
        }
        let list = tokens(&text, separators);
        Parameters { text, list, line: lines.first().map_or(entry.line, |l| l.line), spilled }
    }
}

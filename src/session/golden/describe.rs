//! What changed, for people: the lines as they were and are, and in words what moved.

use super::compare::{Allowance, Change, Move};
use super::line::Line;
use super::quotes::{label, quoted};
use super::values::{Value, rounded};
use super::words::{Kind, Measure, kind_of};
use crate::base::visible::colored;

/// Changes of one run that are described; further ones are counted.
pub const MOST: usize = 40;

/// Significant digits that two numbers get at least.
const DIGITS: usize = 6;

/// A line of a description.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DiffLine {
    /// As it was.
    Old(String),
    /// As it is.
    New(String),
    /// In words.
    Words(String),
}

impl DiffLine {
    /// As text: `- ` before what was, `+ ` before what is.
    pub fn text(&self, color: bool) -> String {
        let paint = |code: &str, text: String| colored(&text, code, color);
        match self {
            Self::Old(line) => paint("31", format!("  - {line}")),
            Self::New(line) => paint("32", format!("  + {line}")),
            Self::Words(words) => format!("    {words}"),
        }
    }
}

/// All changes, up to [`MOST`] in full.
pub fn changes(changes: &[Change], allowance: Allowance) -> Vec<DiffLine> {
    let mut lines: Vec<DiffLine> = changes.iter().take(MOST).flat_map(|change| one(change, allowance)).collect();
    if changes.len() > MOST {
        lines.push(DiffLine::Words(format!("and {} more lines", changes.len() - MOST)));
    }
    lines
}

fn one(change: &Change, allowance: Allowance) -> Vec<DiffLine> {
    // Lines are shown with more digits than rounding needs, so that what differs is seen.
    let text = |line: &Line| line.text(allowance.tolerance * 0.01);
    match change {
        Change::Gone(line) => vec![DiffLine::Old(text(line)), DiffLine::Words(format!("{} is gone", subject(line)))],
        Change::New(line) => vec![DiffLine::New(text(line)), DiffLine::Words(format!("{} is new", subject(line)))],
        Change::Renamed { old, new } => {
            let name = |line: &Line| if line.unnamed { format!("`{}`", line.name) } else { label(&line.name) };
            vec![DiffLine::Words(format!("{} {} is called {} now; nothing else about it changed", old.kind, name(old), name(new)))]
        }
        Change::Changed { old, new, moves } => {
            let head = [DiffLine::Old(text(old)), DiffLine::New(text(new))];
            // Words of which none was there are those of another version of loft.
            let fresh: Vec<&str> = moves.iter().filter(|m| m.old.is_none()).map(|m| m.word).collect();
            let many = fresh.len() > 2;
            let over = is_turned_over(moves, allowance);
            let is_left_out = |m: &Move| many && m.old.is_none() || over && matches!(m.word, "side" | "inside" | "hash");
            let turned = over.then(|| "its normals are reversed".to_owned());
            let described = turned.into_iter().chain(moves.iter().filter(|m| !is_left_out(m)).flat_map(|m| in_words(m, moves, allowance)));
            let words = described.chain(many.then(|| format!("{} are new", fresh.join(", "))));
            head.into_iter().chain(words.map(|w| DiffLine::Words(format!("{}: {w}", subject(new))))).collect()
        }
    }
}

/// Whether something shows its other side and nothing else about its place changed: the words of the side have the other sign.
fn is_turned_over(moves: &[Move], allowance: Allowance) -> bool {
    let negated = |m: &Move| match (m.kind, &m.old, &m.new) {
        (Kind::Real(measure), Some(Value::Real(a, _)), Some(Value::Real(b, _))) => allowance.excess(measure, -a, *b).is_none(),
        (Kind::List(measure), Some(Value::List(a, _)), Some(Value::List(b, _))) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| allowance.excess(measure, -a, *b).is_none())
        }
        _ => false,
    };
    let sides = || moves.iter().filter(|m| matches!(m.word, "side" | "inside"));
    sides().count() > 0 && sides().all(negated) && moves.iter().all(|m| matches!(m.word, "side" | "inside" | "hash"))
}

/// What a line speaks of.
fn subject(line: &Line) -> String {
    if line.is_diagnostic() {
        let severity = match line.kind.as_bytes().first() {
            Some(b'E') => "error",
            Some(b'W') => "warning",
            _ => "note",
        };
        return format!("{severity} {}", line.kind);
    }
    match kind_of(&line.kind) {
        Some(kind) if !kind.named => line.kind.clone(),
        _ if line.unnamed => format!("{} `{}`", line.kind, line.name),
        Some(kind) if !kind.spoken => line.name.clone(),
        _ if line.kind == "check" => format!("check {}", quoted(&line.name)),
        _ => format!("{} {}", line.kind, label(&line.name)),
    }
}

fn in_words(m: &Move, all: &[Move], allowance: Allowance) -> Vec<String> {
    let word = m.word;
    let show = |value: &Value| pretty(&value.text(m.kind, DIGITS));
    let (old, new) = match (&m.old, &m.new) {
        (Some(old), Some(new)) => (old, new),
        (Some(old), None) => return vec![format!("{word} is gone, it was {}", show(old))],
        (None, Some(new)) => return vec![format!("{word} {} is new", show(new))],
        (None, None) => return Vec::new(),
    };
    match (old, new) {
        (Value::Real(a, unit), Value::Real(b, new_unit)) if unit == new_unit => {
            let Kind::Real(measure) = m.kind else { return Vec::new() };
            vec![format!("{word} {}", change_of(measure, (*a, *b), unit, m.times, allowance))]
        }
        (Value::Groups(a), Value::Groups(b)) => groups(a, b),
        (Value::Corners(a, unit), Value::Corners(b, new_unit)) if unit == new_unit => vec![corners(a, b, unit, m.times)],
        (Value::List(a, unit), Value::List(b, new_unit)) if unit == new_unit && a.len() == b.len() => {
            vec![format!("{word}, {}", list(a, b, unit, m.times))]
        }
        (Value::Word(a), Value::Word(b)) if m.kind == Kind::Verdict => {
            let before = |w: &str| if w == "pass" { "passed" } else { "failed" };
            vec![format!("{} before, {}s now", before(a), b)]
        }
        (Value::Word(a), Value::Word(b)) if word == "hash" => {
            let alone = all.iter().all(|m| matches!(m.kind, Kind::Real(_)) || m.word == "hash");
            let why = if alone { "the counts are the same, but an edge runs elsewhere or a group holds other parts: " } else { "" };
            vec![format!("{why}hash {a} → {b}")]
        }
        _ => vec![format!("{word} {} → {}", show(old), show(new))],
    }
}

fn groups(old: &[(String, u64)], new: &[(String, u64)]) -> Vec<String> {
    let of = |groups: &[(String, u64)], name: &str| groups.iter().find(|g| g.0 == name).map(|g| g.1);
    let nodes = |n: u64| format!("{n} node{}", if n == 1 { "" } else { "s" });
    let was = old.iter().filter_map(|(name, n)| match of(new, name) {
        None => Some(format!("group {} is gone, it had {}", label(name), nodes(*n))),
        Some(m) => (m != *n).then(|| format!("group {} {n} → {}", label(name), nodes(m))),
    });
    let is = new.iter().filter(|(name, _)| of(old, name).is_none());
    was.chain(is.map(|(name, n)| format!("group {} is new, with {}", label(name), nodes(*n)))).collect()
}

fn corners(old: &[[f64; 3]; 2], new: &[[f64; 3]; 2], unit: &str, times: Option<f64>) -> String {
    const AXES: [&str; 3] = ["x", "y", "z"];
    let changes = old
        .iter()
        .zip(new)
        .zip(["lower", "upper"])
        .flat_map(|((a, b), end)| (0..3).map(move |axis| ((b[axis] - a[axis]).abs(), axis, end, a[axis], b[axis])));
    let Some((_, axis, end, a, b)) = changes.reduce(|most, other| if other.0 > most.0 { other } else { most }) else {
        return String::new();
    };
    let (a, b) = two_numbers(a, b);
    format!("box, {end} {} {a} → {b} {}{}", AXES[axis], pretty_unit(unit), times.map_or(String::new(), |t| format!(" ({})", tolerances(t))))
}

/// The number of a list that moved most, under the name of its place.
fn list(old: &[f64], new: &[f64], unit: &str, times: Option<f64>) -> String {
    const SQUARES: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "zx"];
    let moved = old.iter().zip(new).enumerate().map(|(k, (a, b))| ((b - a).abs(), k, *a, *b));
    let Some((_, k, a, b)) = moved.reduce(|most, other| if other.0 > most.0 { other } else { most }) else { return String::new() };
    let name = if old.len() == SQUARES.len() { SQUARES[k] } else { ["x", "y", "z"].get(k).copied().unwrap_or("") };
    let (a, b) = two_numbers(a, b);
    format!("{name} {a} → {b} {}{}", pretty_unit(unit), times.map_or(String::new(), |t| format!(" ({})", tolerances(t))))
}

/// `125.664 → 126.010 m² (+0.28 %, allowed 1e-9, 2.8e6 tolerances)`.
fn change_of(measure: Measure, (old, new): (f64, f64), unit: &str, times: Option<f64>, allowance: Allowance) -> String {
    let (a, b) = two_numbers(old, new);
    let unit = match measure {
        Measure::Ratio => String::new(),
        Measure::Angle => "°".to_owned(),
        Measure::Length(_) => format!(" {}", pretty_unit(unit)),
    };
    let share = (old != 0.0).then(|| format!("{}{} %, ", if new > old { "+" } else { "" }, rounded((new - old) / old.abs() * 100.0, 2)));
    let allowed =
        if allowance.tolerance > 0.0 { format!("allowed {}", rounded(allowance.tolerance, 3)) } else { "none allowed".to_owned() };
    let times = times.map_or(String::new(), |t| format!(", {}", tolerances(t)));
    format!("{a} → {b}{unit} ({}{allowed}{times})", share.unwrap_or_default())
}

/// `2.8e6 tolerances`.
pub fn tolerances(times: f64) -> String {
    const PLAIN: f64 = 10_000.0;
    let text = if times < PLAIN { rounded(times, 2) } else { format!("{times:.1e}").replace(".0e", "e") };
    format!("{text} tolerances")
}

/// Two numbers with as many digits as it takes to tell them apart.
pub fn two_numbers(a: f64, b: f64) -> (String, String) {
    let largest = a.abs().max(b.abs());
    let exponent = format!("{largest:e}").split_once('e').and_then(|(_, e)| e.parse::<i32>().ok()).unwrap_or(0);
    for digits in DIGITS..=17 {
        let places = digits as i32 - 1 - exponent;
        let (x, y) = if (0..=15).contains(&places) && exponent >= -4 {
            let places = places as usize;
            (format!("{:.places$}", a + 0.0), format!("{:.places$}", b + 0.0))
        } else {
            (rounded(a, digits), rounded(b, digits))
        };
        if x != y {
            return (short(&x, &y), short(&y, &x));
        }
    }
    (rounded(a, 17), rounded(b, 17))
}

/// The text without zeros at the end of its decimals, as far as both have them.
fn short(x: &str, other: &str) -> String {
    if !x.contains('.') || !other.contains('.') || x.contains('e') || other.contains('e') {
        return x.to_owned();
    }
    let zeros = |t: &str| t.len() - t.trim_end_matches('0').len();
    let cut = zeros(x).min(zeros(other));
    x[..x.len() - cut].trim_end_matches('.').to_owned()
}

fn pretty_unit(unit: &str) -> String {
    unit.strip_suffix('2').map(|u| format!("{u}²")).or_else(|| unit.strip_suffix('3').map(|u| format!("{u}³"))).unwrap_or(unit.to_owned())
}

/// A value's text with its unit as people write it.
fn pretty(text: &str) -> String {
    match text.rsplit_once(' ') {
        Some((value, "deg")) => format!("{value}°"),
        Some((value, unit)) if unit.len() < 4 && unit.ends_with(['2', '3']) => format!("{value} {}", pretty_unit(unit)),
        _ => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::compare::compare;
    use super::super::line::parse_line;
    use super::*;

    fn said(old: &str, new: &str) -> Vec<String> {
        let allowance = Allowance { tolerance: 1e-9, size: 1.0 };
        let found = compare(&[parse_line(old).unwrap()], &[parse_line(new).unwrap()], &std::collections::BTreeSet::new(), allowance);
        let words = |said: DiffLine| match said {
            DiffLine::Words(text) => Some(text),
            _ => None,
        };
        changes(&found, allowance).into_iter().filter_map(words).collect()
    }

    #[test]
    fn what_moved_is_said_in_words() {
        let old = "surface roof  kind coons  flow quadrilateral  area 125.664 m2";
        let new = "surface roof  kind coons  flow uniform trilateral  area 126.01 m2";
        let expected =
            ["roof: flow quadrilateral → uniform trilateral", "roof: area 125.664 → 126.010 m² (+0.28 %, allowed 1e-9, 2.8e6 tolerances)"];
        assert_eq!(said(old, new), expected);
        assert_eq!(said("check \"no slivers\"  pass", "check \"no slivers\"  fail"), ["check \"no slivers\": passed before, fails now"]);
        assert_eq!(
            said("mesh fine  groups a:12 b:4", "mesh fine  groups a:11 c:1"),
            ["mesh fine: group a 12 → 11 nodes", "mesh fine: group b is gone, it had 4 nodes", "mesh fine: group c is new, with 1 node"]
        );
        assert_eq!(said("mesh fine  nodes 9  hash a", "mesh fine  nodes 9  hash b").len(), 1);
        assert_eq!(said("shell s  closed yes  volume 2 m3", "shell s  closed no")[1], "s: volume is gone, it was 2 m³");
        assert_eq!(
            said("surface r  box (0, 0, 0) (1, 1, 1) m", "surface r  box (0, 0, 0) (1, 1.5, 1) m"),
            ["r: box, upper y 1.0 → 1.5 m (5e8 tolerances)"]
        );
    }

    #[test]
    fn small_changes_are_seen() {
        assert_eq!(two_numbers(1.0, 1.000_000_001), ("1.000000000".to_owned(), "1.000000001".to_owned()));
        assert_eq!(two_numbers(0.0, 1e-7), ("0".to_owned(), "1e-7".to_owned()));
        assert_eq!(two_numbers(3e20, 4e20), ("3e20".to_owned(), "4e20".to_owned()));
        assert_eq!(two_numbers(12.0, 13.0), ("12".to_owned(), "13".to_owned()));
    }
}

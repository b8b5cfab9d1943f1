//! Old lines against new ones: matched by kind and name, compared value by value.

use std::collections::{BTreeMap, BTreeSet};

use super::cells;
use super::file::TOLERANCE;
use super::line::Line;
use super::quote::tokens;
use super::renames::Renames;
use super::values::Value;
use super::words::{self, Kind, Measure};

/// How much reals may change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Allowance {
    /// Relative tolerance; 0 is exact.
    pub tolerance: f64,
    /// Diagonal of the model's box, model units.
    pub size: f64,
}

/// One line that is not as it was.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// It was there.
    Gone(Line),
    /// It was not there.
    New(Line),
    /// It has another name, and is otherwise as it was.
    Renamed {
        /// As it was.
        old: Line,
        /// As it is.
        new: Line,
    },
    /// It says something else.
    Changed {
        /// As it was.
        old: Line,
        /// As it is.
        new: Line,
        /// What differs, in the order of the table; never empty.
        moves: Vec<Move>,
    },
}

/// One value that is not as it was.
#[derive(Clone, Debug, PartialEq)]
pub struct Move {
    /// Its word; empty for one that stands alone, `message` for the words of a diagnostic.
    pub word: &'static str,
    /// What kind of value it is.
    pub kind: Kind,
    /// As it was.
    pub old: Option<Value>,
    /// As it is.
    pub new: Option<Value>,
    /// How many times the allowed change; `None` where nothing is allowed.
    pub times: Option<f64>,
}

impl Allowance {
    /// The change that is none, in the unit of the value.
    pub fn of(&self, measure: Measure, old: f64) -> f64 {
        let scale = match measure {
            Measure::Length(power) => crate::base::math::powi(self.size, i32::from(power)),
            Measure::Angle | Measure::Ratio => 1.0,
        };
        self.tolerance * old.abs().max(scale)
    }

    /// How many times the allowed change lies between the two; `None` when they are equal enough.
    pub(super) fn excess(&self, measure: Measure, old: f64, new: f64) -> Option<f64> {
        exceeding((new - old).abs(), self.of(measure, old))
    }

    /// The same where the tolerance is a share of the number alone, however small it is.
    pub(super) fn excess_of_itself(&self, old: f64, new: f64) -> Option<f64> {
        exceeding((new - old).abs(), self.tolerance * old.abs())
    }
}

fn exceeding(change: f64, allowed: f64) -> Option<f64> {
    (change > allowed).then(|| if allowed > 0.0 { change / allowed } else { f64::INFINITY })
}

/// What changed: what was there in the old order, then what is new.
///
/// `names` are all that the script of the new lines uses: a name inside it that is found nowhere any more may have become
/// another one.
pub fn compare(old: &[Line], new: &[Line], names: &BTreeSet<String>, allowance: Allowance) -> Vec<Change> {
    let mut pairing = Pairing { old, new, allowance, partner: vec![None; old.len()], matched: vec![false; new.len()] };
    let mut renames = Renames::between(old, new, names);
    let alone = || (String::new(), String::new());
    let by_name = |line: &Line| if line.unnamed { alone() } else { (line.kind.clone(), line.name.clone()) };
    let by_tokens = |line: &Line| if line.unnamed { (line.kind.clone(), tokens(&line.name).join(" ")) } else { alone() };
    // What has no name is known by its values.
    pairing.by(&by_tokens, Only::Equal);
    pairing.known_by_values(&mut |a, b| a.unnamed && b.unnamed && a.kind == b.kind && a.kind != "row" && same(a, b, allowance));
    pairing.by(&by_name, Only::Any);
    // What has another name now and is otherwise as it was.
    let renamed = pairing.known_by_values(&mut |a, b| {
        let fresh = !a.is_diagnostic() && a.kind == b.kind && same_but_name(a, b, allowance);
        if fresh && !a.unnamed && !b.unnamed && !matches!(a.kind.as_str(), "set" | "settings" | "row") {
            renames.note(&a.name, &b.name);
        }
        fresh
    });
    pairing.known_by_values(&mut |a, b| a.is_diagnostic() && renames.same_diagnostic(a, b));
    pairing.by(&by_tokens, Only::Any);
    pairing.by(&|line: &Line| if line.unnamed { (line.kind.clone(), String::new()) } else { alone() }, Only::Any);
    // A diagnostic whose words changed is found again by what it points at.
    let by_place = |line: &Line| match line.get("at") {
        Some(Value::Word(at)) if line.is_diagnostic() => (line.kind.clone(), tokens(at).join(" ")),
        _ if line.is_diagnostic() => (line.kind.clone(), String::new()),
        _ => alone(),
    };
    pairing.by(&by_place, Only::Any);
    let (partner, matched) = (pairing.partner, pairing.matched);
    let mut changes = Vec::new();
    for (k, line) in old.iter().enumerate() {
        let Some(other) = partner[k].map(|b| &new[b]) else {
            changes.push(Change::Gone(line.clone()));
            continue;
        };
        let today = renames.of_today(line);
        if renamed.contains(&k) {
            if today.name != other.name || line.unnamed != other.unnamed {
                changes.push(Change::Renamed { old: line.clone(), new: other.clone() });
            }
            continue;
        }
        if line.is_diagnostic() && renames.same_diagnostic(line, other) {
            continue;
        }
        let mut moves = moves(&today, other, allowance);
        if is_worded(line) && is_worded(other) && !renames.same_words(&line.name, &other.name) {
            moves.insert(0, worded(line, other));
        }
        if !moves.is_empty() {
            changes.push(Change::Changed { old: line.clone(), new: other.clone(), moves });
        }
    }
    changes.extend(new.iter().zip(matched).filter(|(_, matched)| !matched).map(|(line, _)| Change::New(line.clone())));
    changes
}

type Key = (String, String);

/// Which lines are paired.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Only {
    /// Those that are equal.
    Equal,
    /// Equal ones first, then the others in order.
    Any,
}

/// Which new line each old one is.
struct Pairing<'l> {
    old: &'l [Line],
    new: &'l [Line],
    allowance: Allowance,
    partner: Vec<Option<usize>>,
    matched: Vec<bool>,
}

impl Pairing<'_> {
    fn pair_up(&mut self, a: usize, b: usize) {
        self.partner[a] = Some(b);
        self.matched[b] = true;
    }

    /// Pairs lines with the same key. Lines with an empty key stay alone.
    fn by(&mut self, key: &dyn Fn(&Line) -> Key, only: Only) {
        let mut named: BTreeMap<Key, (Vec<usize>, Vec<usize>)> = BTreeMap::new();
        let (olds, news): (Vec<usize>, Vec<usize>) = (self.free_old(), self.free_new());
        olds.into_iter().for_each(|k| named.entry(key(&self.old[k])).or_default().0.push(k));
        news.into_iter().for_each(|k| named.entry(key(&self.new[k])).or_default().1.push(k));
        for ((kind, _), (olds, mut rest)) in named {
            if kind.is_empty() {
                continue;
            }
            let mut unmatched = Vec::new();
            for a in olds {
                match rest.iter().position(|b| same(&self.old[a], &self.new[*b], self.allowance)) {
                    Some(at) => self.pair_up(a, rest.remove(at)),
                    None => unmatched.push(a),
                }
            }
            if only == Only::Any {
                unmatched.into_iter().zip(rest).for_each(|(a, b)| self.pair_up(a, b));
            }
        }
    }

    /// Pairs lines that are the same in some way; gives the old ones among them.
    fn known_by_values(&mut self, same: &mut dyn FnMut(&Line, &Line) -> bool) -> BTreeSet<usize> {
        let mut found = BTreeSet::new();
        for a in self.free_old() {
            let b = (0..self.new.len()).find(|b| !self.matched[*b] && same(&self.old[a], &self.new[*b]));
            if let Some(b) = b {
                self.pair_up(a, b);
                found.insert(a);
            }
        }
        found
    }

    fn free_old(&self) -> Vec<usize> {
        (0..self.old.len()).filter(|k| self.partner[*k].is_none()).collect()
    }

    fn free_new(&self) -> Vec<usize> {
        (0..self.new.len()).filter(|k| !self.matched[*k]).collect()
    }
}

/// Whether a line stands for what a script says without a label: equal values do not make two of them one.
fn is_worded(line: &Line) -> bool {
    line.unnamed && matches!(line.kind.as_str(), "check" | "report")
}

/// The move from the words of one line to those of another.
fn worded(old: &Line, new: &Line) -> Move {
    let word = |line: &Line| Some(Value::Word(line.name.clone()));
    Move { word: "message", kind: Kind::Word, old: word(old), new: word(new), times: None }
}

/// Whether the words that two lines of any kinds share say the same of places and lengths.
pub fn one_thing(one: &Line, other: &Line, size: f64) -> bool {
    let allowance = Allowance { tolerance: TOLERANCE, size };
    let mut shared = words::fields_of(&one.kind).filter_map(|f| Some((f.kind, one.get(f.word)?, other.get(f.word)?)));
    shared.all(|(kind, a, b)| excess(kind, a, b, allowance).is_none())
}

/// Whether two lines of one kind say the same, names included where they have one.
fn same(old: &Line, new: &Line, allowance: Allowance) -> bool {
    (old.unnamed && new.unnamed || old.name == new.name) && same_but_name(old, new, allowance)
}

/// Whether two lines of one kind say the same, whatever their names; names of groups included.
fn same_but_name(old: &Line, new: &Line, allowance: Allowance) -> bool {
    words::fields_of(&old.kind).all(|field| match (old.get(field.word), new.get(field.word)) {
        (None, None) => true,
        (Some(a), Some(b)) => excess(field.kind, a, b, allowance).is_none(),
        _ => false,
    })
}

/// What differs between two lines of one kind.
fn moves(old: &Line, new: &Line, allowance: Allowance) -> Vec<Move> {
    let mut found = Vec::new();
    if old.name != new.name && !(old.unnamed && new.unnamed) {
        found.push(worded(old, new));
    }
    for field in words::fields_of(&old.kind) {
        let (was, is) = (old.get(field.word), new.get(field.word));
        let times = match (was, is) {
            (None, None) => continue,
            (Some(a), Some(b)) => match excess(field.kind, a, b, allowance) {
                None => continue,
                Some(times) => Some(times).filter(|times| times.is_finite()),
            },
            _ => None,
        };
        found.push(Move { word: field.word, kind: field.kind, old: was.cloned(), new: is.cloned(), times });
    }
    found
}

/// How many times the allowed change; infinite where nothing is allowed, `None` when equal enough.
fn excess(kind: Kind, old: &Value, new: &Value, allowance: Allowance) -> Option<f64> {
    match (kind, old, new) {
        (Kind::Real(measure), Value::Real(a, old_unit), Value::Real(b, new_unit)) if old_unit == new_unit => {
            allowance.excess(measure, *a, *b)
        }
        (Kind::Corners, Value::Corners(a, old_unit), Value::Corners(b, new_unit)) if old_unit == new_unit => {
            let pairs = a.iter().flatten().zip(b.iter().flatten());
            pairs.filter_map(|(a, b)| allowance.excess(Measure::Length(1), *a, *b)).reduce(f64::max)
        }
        (Kind::List(measure), Value::List(a, old_unit), Value::List(b, new_unit)) if old_unit == new_unit && a.len() == b.len() => {
            // All are written as far as the largest of them needs.
            let most = a.iter().fold(0.0, |most: f64, a| most.max(a.abs()));
            a.iter().zip(b).filter_map(|(a, b)| exceeding((b - a).abs(), allowance.of(measure, most))).reduce(f64::max)
        }
        (Kind::Source, Value::Word(a), Value::Word(b)) => (tokens(a) != tokens(b)).then_some(f64::INFINITY),
        (Kind::Cells, Value::Cells(a), Value::Cells(b)) => cells::excess(a, b, &|measure, old, new| allowance.excess(measure, old, new)),
        (Kind::Limit, Value::Cells(a), Value::Cells(b)) => cells::excess(a, b, &|_, old, new| allowance.excess_of_itself(old, new)),
        (Kind::Groups, Value::Groups(a), Value::Groups(b)) => {
            let sorted = |groups: &[(String, u64)]| groups.iter().cloned().collect::<BTreeMap<_, _>>();
            (sorted(a) != sorted(b)).then_some(f64::INFINITY)
        }
        _ => (old != new).then_some(f64::INFINITY),
    }
}

#[cfg(test)]
mod tests {
    use super::super::line::parse_line;
    use super::*;

    fn lines(text: &str) -> Vec<Line> {
        text.lines().map(|l| parse_line(l.trim()).unwrap_or_else(|e| panic!("{l}: {e}"))).collect()
    }

    fn words_moved(old: &str, new: &str) -> Vec<String> {
        let allowance = Allowance { tolerance: 1e-9, size: 10.0 };
        let said = |change: &Change| match change {
            Change::Gone(line) => format!("-{}", line.name),
            Change::New(line) => format!("+{}", line.name),
            Change::Renamed { old, new } => format!("{} = {}", old.name, new.name),
            Change::Changed { new, moves, .. } => {
                format!("{} {}", new.name, moves.iter().map(|m| m.word).collect::<Vec<_>>().join(","))
            }
        };
        compare(&lines(old), &lines(new), &BTreeSet::new(), allowance).iter().map(said).collect()
    }

    #[test]
    fn order_and_last_digits_are_nothing() {
        let old = "curve a  kind line  length 4 m  links 1\ncurve b  kind arc  length 5 m  links 2";
        let new = "curve b  links 2  length 5.000000009 m  kind arc\ncurve a  kind line  length 3.99999999 m  links 1";
        assert!(words_moved(old, new).is_empty());
        let new = "curve b  links 2  length 5.000000011 m  kind arc\ncurve a  kind line  length 4 m  links 1";
        assert_eq!(words_moved(old, new), ["b length"]);
    }

    #[test]
    fn sizes_count_by_their_dimension() {
        // The model is 10 m: an area of any size may change by 1e-7 m2, an angle by 1e-9 of itself.
        assert!(words_moved("surface a  area 1 m2", "surface a  area 1.00000009 m2").is_empty());
        assert_eq!(words_moved("surface a  area 1 m2", "surface a  area 1.00000011 m2"), ["a area"]);
        assert_eq!(words_moved("mesh a  min_angle 60 deg", "mesh a  min_angle 60.0000001 deg"), ["a min_angle"]);
        assert_eq!(words_moved("surface a  area 1 m2", "surface a  area 1 mm2"), ["a area"]);
    }

    #[test]
    fn lines_come_and_go() {
        assert_eq!(words_moved("surface a  area 1 m2", "surface b  area 1 m2"), ["a = b"]);
        assert_eq!(words_moved("surface a  area 1 m2", "surface b  area 2 m2"), ["-a", "+b"]);
        assert_eq!(words_moved("surface a  area 1 m2", "surface a"), ["a area"]);
        assert_eq!(words_moved("mesh a  groups x:1 y:2", "mesh a  groups y:2 x:1"), Vec::<String>::new());
        assert_eq!(words_moved("mesh a  groups x:1 y:2", "mesh a  groups x:1"), ["a groups"]);
    }

    #[test]
    fn equal_names_find_their_equals() {
        let old = "modeling \"c[..a]\"  length 1 m\nmodeling \"c[..a]\"  length 2 m";
        let new = "modeling \"c[..a]\"  length 2 m\nmodeling \"c[..a]\"  length 1 m";
        assert!(words_moved(old, new).is_empty());
        let new = "modeling \"c[..a]\"  length 2 m\nmodeling \"c[..a]\"  length 3 m";
        assert_eq!(words_moved(old, new), ["c[..a] length"]);
    }

    #[test]
    fn the_words_of_a_check_without_a_label_count() {
        let old = "check `not m.watertight`  pass\ncheck `a.length > 3m`  pass  left 4 m  right 3 m";
        assert_eq!(words_moved(old, &old.replace("not m.watertight", "true")), ["true message"]);
        assert_eq!(words_moved(old, &old.replace("a.length", "4m")), ["4m > 3m message"]);
        assert!(words_moved(old, &old.replace("a.length > 3m", "a.length  >  3m")).is_empty());
        assert_eq!(words_moved("report `[a.x]`  rows 1", "report `[1]`  rows 1"), ["[1] message"]);
        assert!(words_moved("curve `line(A, B)`  length 1 m", "curve `line(A, C)`  length 1 m").is_empty());
    }

    #[test]
    fn a_diagnostic_is_known_by_its_place() {
        let old = "W701 3 rules  at `a`\nW701 4 rules  at `b`";
        assert_eq!(words_moved(old, "W701 4 rules  at `b`\nW701 5 rules  at `a`"), ["5 rules message"]);
        assert_eq!(words_moved(old, "W701 3 rules  at `a`\nW701 4 rules  at `c`"), ["4 rules at"]);
        assert_eq!(words_moved(old, "W701 3 rules  at `a`"), ["-4 rules"]);
    }
}

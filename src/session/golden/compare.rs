//! Old lines against new ones: matched by kind and name, compared value by value.

use std::collections::BTreeMap;

use super::cells;
use super::line::Line;
use super::words::{self, Kind, Measure, Value};

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
        let (change, allowed) = ((new - old).abs(), self.of(measure, old));
        (change > allowed).then(|| if allowed > 0.0 { change / allowed } else { f64::INFINITY })
    }
}

/// What changed: what was there in the old order, then what is new.
pub fn compare(old: &[Line], new: &[Line], allowance: Allowance) -> Vec<Change> {
    let mut partner: Vec<Option<usize>> = vec![None; old.len()];
    let mut taken = vec![false; new.len()];
    let by_name = |line: &Line| (line.kind.clone(), line.name.clone());
    // A diagnostic whose words changed is found again by what it points at.
    let by_place = |line: &Line| (line.kind.clone(), format!("{:?}", line.get("at").filter(|_| line.is_diagnostic())));
    let places = |lines: &[Line], free: &dyn Fn(usize) -> bool| lines.iter().enumerate().any(|(k, l)| l.is_diagnostic() && free(k));
    pair_up(old, new, &by_name, allowance, (&mut partner, &mut taken));
    if places(old, &|k| partner[k].is_none()) && places(new, &|k| !taken[k]) {
        let key = |line: &Line| if line.is_diagnostic() { by_place(line) } else { (String::new(), String::new()) };
        pair_up(old, new, &key, allowance, (&mut partner, &mut taken));
    }
    let mut changes = Vec::new();
    for (line, partner) in old.iter().zip(&partner) {
        match partner.map(|k| &new[k]) {
            None => changes.push(Change::Gone(line.clone())),
            Some(other) => {
                let moves = moves(line, other, allowance);
                if !moves.is_empty() {
                    changes.push(Change::Changed { old: line.clone(), new: other.clone(), moves });
                }
            }
        }
    }
    changes.extend(new.iter().zip(taken).filter(|(_, taken)| !taken).map(|(line, _)| Change::New(line.clone())));
    changes
}

type Key = (String, String);

/// Pairs lines with the same key: equal ones first, then in order. Lines with an empty key stay alone.
fn pair_up(
    old: &[Line],
    new: &[Line],
    key: &dyn Fn(&Line) -> Key,
    allowance: Allowance,
    (partner, taken): (&mut [Option<usize>], &mut [bool]),
) {
    let mut named: BTreeMap<Key, (Vec<usize>, Vec<usize>)> = BTreeMap::new();
    (0..old.len()).filter(|k| partner[*k].is_none()).for_each(|k| named.entry(key(&old[k])).or_default().0.push(k));
    (0..new.len()).filter(|k| !taken[*k]).for_each(|k| named.entry(key(&new[k])).or_default().1.push(k));
    for ((kind, _), (olds, news)) in named {
        if kind.is_empty() {
            continue;
        }
        let mut marry = |a: usize, b: usize| {
            partner[a] = Some(b);
            taken[b] = true;
        };
        let mut rest: Vec<usize> = news;
        let mut lonely = Vec::new();
        for a in olds {
            match rest.iter().position(|b| moves(&old[a], &new[*b], allowance).is_empty()) {
                Some(at) => marry(a, rest.remove(at)),
                None => lonely.push(a),
            }
        }
        lonely.into_iter().zip(rest).for_each(|(a, b)| marry(a, b));
    }
}

/// What differs between two lines of one kind.
fn moves(old: &Line, new: &Line, allowance: Allowance) -> Vec<Move> {
    let mut found = Vec::new();
    if old.name != new.name {
        let word = |line: &Line| Some(Value::Word(line.name.clone()));
        found.push(Move { word: "message", kind: Kind::Word, old: word(old), new: word(new), times: None });
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
        (Kind::Cells, Value::Cells(a), Value::Cells(b)) => cells::excess(a, b, allowance),
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
            Change::Changed { new, moves, .. } => {
                format!("{} {}", new.name, moves.iter().map(|m| m.word).collect::<Vec<_>>().join(","))
            }
        };
        compare(&lines(old), &lines(new), allowance).iter().map(said).collect()
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
        assert_eq!(words_moved("surface a  area 1 m2", "surface b  area 1 m2"), ["-a", "+b"]);
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
    fn a_diagnostic_is_known_by_its_place() {
        let old = "W701 3 rules  at `a`\nW701 4 rules  at `b`";
        assert_eq!(words_moved(old, "W701 4 rules  at `b`\nW701 5 rules  at `a`"), ["5 rules message"]);
        assert_eq!(words_moved(old, "W701 3 rules  at `a`\nW701 4 rules  at `c`"), ["4 rules at"]);
        assert_eq!(words_moved(old, "W701 3 rules  at `a`"), ["-4 rules"]);
    }
}

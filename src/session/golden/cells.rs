//! Rows of reported tables: cells between ` | `, numbers with their unit.

use super::quotes::{end_of_quote, quoted, unquoted};
use super::values::{number, rounded};
use super::words::Measure;

/// How many times the allowed change lies between two numbers of a measure; `None` when they are equal enough.
type Apart<'a> = &'a dyn Fn(Measure, f64, f64) -> Option<f64>;
use crate::base::digest::StableHasher;
use crate::lang::values::units::length_unit;
use crate::session::report::Cell;

/// One cell.
#[derive(Clone, Debug, PartialEq)]
pub enum CellValue {
    /// A word, a text, `true`, or `-` for nothing.
    Text(String),
    /// A number, or a short list of them.
    Numbers {
        /// Whether they stand between brackets.
        list: bool,
        /// The numbers, in `unit`.
        all: Vec<f64>,
        /// Their unit; empty for bare ones.
        unit: String,
    },
}

/// What a unit measures; what is neither a length nor an angle is compared like a ratio.
pub fn measure_of(unit: &str) -> Measure {
    let powers = [(unit, 1), (unit.strip_suffix('2').unwrap_or(""), 2), (unit.strip_suffix('3').unwrap_or(""), 3)];
    match powers.iter().find(|(name, _)| length_unit(name).is_some()) {
        Some((_, power)) => Measure::Length(*power),
        None if unit == "deg" => Measure::Angle,
        None => Measure::Ratio,
    }
}

/// Significant digits of numbers in lists inside lists.
const INNER: usize = 17;

impl CellValue {
    /// A cell of a column of this unit.
    pub fn of(cell: &Cell, unit: &str) -> Self {
        let numbers = |list: bool, all: Vec<f64>| Self::Numbers { list, all, unit: unit.to_owned() };
        match cell {
            Cell::Missing => Self::Text("-".to_owned()),
            Cell::Bool(is) => Self::Text(is.to_string()),
            Cell::Number(x) => numbers(false, vec![*x]),
            Cell::Text(text) => Self::Text(text.clone()),
            Cell::List(items) => {
                let plain = |item: &Cell| if let Cell::Number(x) = item { Some(*x) } else { None };
                match items.iter().map(plain).collect::<Option<Vec<f64>>>() {
                    Some(all) if !all.is_empty() => numbers(true, all),
                    _ => {
                        let inside: Vec<Self> = items.iter().map(|item| Self::of(item, unit)).collect();
                        Self::Text(format!("({})", text(&inside, INNER)))
                    }
                }
            }
        }
    }

    fn text(&self, digits: usize) -> String {
        match self {
            Self::Text(text) => {
                let odd = text.is_empty() || text != text.trim() || text.contains("  ") || text.contains(['|', '"', '\\', '`']);
                let read = Self::parse(text);
                if odd || text.contains(char::is_control) || text.contains("//") || read.as_ref() != Ok(self) {
                    quoted(text)
                } else {
                    text.clone()
                }
            }
            Self::Numbers { list, all, unit } => {
                let all: Vec<String> = all.iter().map(|x| rounded(*x, digits)).collect();
                let all = if *list { format!("({})", all.join(", ")) } else { all.join(", ") };
                if unit.is_empty() { all } else { format!("{all} {unit}") }
            }
        }
    }

    fn parse(text: &str) -> Result<Self, String> {
        if text.starts_with('"') {
            return unquoted(text).map(Self::Text);
        }
        let (inside, behind) = match text.strip_prefix('(').and_then(|t| t.split_once(')')) {
            Some((inside, behind)) => (Some(inside), behind),
            None => (None, text.split_once(' ').map_or("", |(_, unit)| unit)),
        };
        let numbers: Option<Vec<f64>> = match inside {
            Some(inside) => inside.split(',').map(|x| number(x.trim())).collect(),
            None => number(text.split(' ').next().unwrap_or("")).map(|x| vec![x]),
        };
        let unit = behind.trim();
        Ok(match numbers {
            Some(all) if !unit.contains(' ') => Self::Numbers { list: inside.is_some(), all, unit: unit.to_owned() },
            _ => Self::Text(text.to_owned()),
        })
    }

    /// How many times the allowed change lies between the two; `None` when they are equal enough.
    fn excess(&self, other: &Self, apart: Apart<'_>) -> Option<f64> {
        match (self, other) {
            (Self::Numbers { all: a, unit: u, list: l }, Self::Numbers { all: b, unit: v, list: m })
                if (u, l) == (v, m) && a.len() == b.len() =>
            {
                let measure = measure_of(u);
                a.iter().zip(b).filter_map(|(a, b)| apart(measure, *a, *b)).reduce(f64::max)
            }
            (Self::Text(a), Self::Text(b)) => texts(a, b, apart),
            _ => (self != other).then_some(f64::INFINITY),
        }
    }
}

/// How far apart texts are that may hold numbers: lists, and quantities of different units.
fn texts(a: &str, b: &str, numbers: Apart<'_>) -> Option<f64> {
    let (one, other) = (pieces(a), pieces(b));
    if one.len() != other.len() {
        return Some(f64::INFINITY);
    }
    let mut at = 0;
    let apart = |(x, y): (&&str, &&str)| {
        at += x.len();
        match (real(x), real(y)) {
            _ if x == y => None,
            (Some(x), Some(y)) => numbers(measure_of(unit_behind(&a[at..])), x, y),
            _ => Some(f64::INFINITY),
        }
    };
    one.iter().zip(&other).filter_map(apart).reduce(f64::max)
}

/// The unit of a number by what stands behind it: a word, or the one behind the bracket of the list that holds it; empty for none.
fn unit_behind(text: &str) -> &str {
    let own = text.strip_prefix(' ').filter(|word| word.starts_with(char::is_alphabetic));
    let of_list = || text.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.e, ".contains(c)).strip_prefix(") ");
    let word = own.or_else(of_list).unwrap_or("");
    word.split(|c: char| !(c.is_alphanumeric() || c == '/')).next().unwrap_or("")
}

/// A number that may have been rounded. What is written without point and exponent may stand for one beside a real.
fn real(piece: &str) -> Option<f64> {
    number(piece).filter(|_| piece.starts_with(|c: char| c.is_ascii_digit() || c == '-'))
}

/// Numbers and what stands between them.
fn pieces(text: &str) -> Vec<&str> {
    let (mut found, mut start, mut at) = (Vec::new(), 0, 0);
    while at < text.len() {
        let rest = &text[at..];
        let free = !text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '.');
        let end = if free { number_end(rest) } else { 0 };
        if end > 0 {
            found.extend([&text[start..at], &rest[..end]]);
            at += end;
            start = at;
        } else {
            at += rest.chars().next().map_or(1, char::len_utf8);
        }
    }
    found.push(&text[start..]);
    found
}

/// Bytes of the number that a text begins with; 0 without one.
fn number_end(text: &str) -> usize {
    let mut best = 0;
    for (end, c) in text.char_indices().map(|(at, c)| (at + c.len_utf8(), c)) {
        if !(c.is_ascii_digit() || matches!(c, '-' | '+' | '.' | 'e')) {
            break;
        }
        if c.is_ascii_digit() && number(&text[..end]).is_some() {
            best = end;
        }
    }
    best
}

/// Significant digits of numbers that stand in a golden as a digest alone: they have no tolerance.
const TOGETHER: usize = 10;

/// Many rows as one: of each column a digest of its words and of its numbers to ten digits, and the sum of the numbers, each
/// times one for its row.
pub fn together(rows: &[Vec<Cell>]) -> Vec<Cell> {
    let width = rows.iter().map(Vec::len).max().unwrap_or(0);
    let column = |c: usize| {
        let (mut sum, mut words) = (0.0, StableHasher::new("words"));
        let mut add = |weight: f64, cell: &Cell| {
            let value = CellValue::of(cell, "");
            let mut add_part = |place: usize, number: Option<f64>, piece: &str| {
                sum += number.map_or(0.0, |x| weight * (1.0 + place as f64) * x);
                let piece = number.map_or_else(|| piece.to_owned(), |x| rounded(x, TOGETHER));
                words = std::mem::take(&mut words).text(&piece);
            };
            match &value {
                CellValue::Numbers { all, .. } => all.iter().enumerate().for_each(|(k, x)| add_part(k, Some(*x), "")),
                CellValue::Text(text) => pieces(text).into_iter().for_each(|piece| add_part(0, real(piece), piece)),
            }
        };
        rows.iter().enumerate().for_each(|(k, row)| add(1.0 + k as f64 / rows.len() as f64, row.get(c).unwrap_or(&Cell::Missing)));
        Cell::List(vec![Cell::Number(sum), Cell::Text(format!("{:032x}", words.finish().0))])
    };
    (0..width).map(column).collect()
}

/// A row as written.
pub fn text(row: &[CellValue], digits: usize) -> String {
    row.iter().map(|entry| entry.text(digits)).collect::<Vec<_>>().join(" | ")
}

/// A row read; the error is what was expected instead.
pub fn parse(text: &str) -> Result<Vec<CellValue>, String> {
    let (mut row, mut rest) = (Vec::new(), text.trim());
    loop {
        let end = match rest.starts_with('"') {
            true => end_of_quote(rest).ok_or("cells between ` | `, texts in quotes closed")?,
            false => rest.find('|').unwrap_or(rest.len()),
        };
        row.push(CellValue::parse(rest[..end].trim())?);
        rest = rest[end..].trim_start();
        match rest.strip_prefix('|') {
            Some(more) => rest = more.trim_start(),
            None if rest.is_empty() => return Ok(row),
            None => return Err("cells between ` | `".to_owned()),
        }
    }
}

/// The largest change of a row in allowed ones; infinite where nothing is allowed.
pub fn excess(old: &[CellValue], new: &[CellValue], apart: Apart<'_>) -> Option<f64> {
    if old.len() != new.len() {
        return Some(f64::INFINITY);
    }
    old.iter().zip(new).filter_map(|(a, b)| a.excess(b, apart)).reduce(f64::max)
}

#[cfg(test)]
mod tests {
    use super::super::compare::Allowance;
    use super::*;

    #[test]
    fn no_row_of_many_changes_unseen() {
        let rows = |odd: usize, by: f64| -> Vec<Vec<Cell>> {
            let number = |k: usize| 1000.0 + k as f64 + if k == odd { by } else { 0.0 };
            (0..5000)
                .map(|k| vec![Cell::Number(number(k)), Cell::List(vec![Cell::Number(number(k)), Cell::Text("a".to_owned())])])
                .collect()
        };
        let summed = |rows: &[Vec<Cell>]| -> Vec<CellValue> { together(rows).iter().map(|cell| CellValue::of(cell, "")).collect() };
        let allowance = Allowance { tolerance: 1e-9, size: 10.0 };
        let (whole, mut other) = (summed(&rows(0, 0.0)), rows(0, 0.0));
        assert_eq!(excess(&whole, &summed(&rows(0, 0.0)), &|measure, x, y| allowance.excess(measure, x, y)), None);
        assert!(excess(&whole, &summed(&rows(3000, 0.005)), &|measure, x, y| allowance.excess(measure, x, y)).is_some());
        other.swap(3000, 3001);
        assert!(excess(&whole, &summed(&other), &|measure, x, y| allowance.excess(measure, x, y)).is_some());
    }

    #[test]
    fn rows_read_back() {
        for row in
            ["12.5 m | 0 | (0, -1.5, 2e-7) mm | spline | -", "true | \"1.5 m\" | \"a | b\" | \"\" | 7850 kg/m3", "a long name | \"a  b\""]
        {
            let read = parse(row).unwrap_or_else(|e| panic!("{row}: {e}"));
            assert_eq!(text(&read, 17), row);
        }
        assert!(parse("\"a\" b").is_err() && parse("\"a").is_err());
    }

    #[test]
    fn numbers_have_a_tolerance_and_words_have_none() {
        let allowance = Allowance { tolerance: 1e-9, size: 10.0 };
        let check = |a: &str, b: &str| excess(&parse(a).unwrap(), &parse(b).unwrap(), &|measure, x, y| allowance.excess(measure, x, y));
        assert_eq!(check("12 m | a", "12.000000001 m | a"), None);
        assert!(check("12 m", "12.0000001 m").is_some_and(|times| times.is_finite() && times > 5.0));
        assert_eq!(check("1000 m3", "1000.0000005 m3"), None);
        // What stands in lists has its unit, and bare numbers are no lengths.
        for (a, b, same) in [
            ("((1, 2.5) mm | \"v\")", "((1, 2.500000005) mm | \"v\")", true),
            ("(1 mm | \"v\")", "(1.000000005 mm | \"v\")", true),
            ("(1.5 | \"v\" | 2 mm)", "(1.500000005 | \"v\" | 2 mm)", false),
            ("((1, 2.5) | 3 mm)", "((1, 2.500000005) | 3 mm)", false),
            ("(7850.5 kg/m3 | \"v\")", "(7850.50001 kg/m3 | \"v\")", false),
        ] {
            let quoted_text = |text: &str| vec![CellValue::Text(text.to_owned())];
            assert_eq!(
                excess(&quoted_text(a), &quoted_text(b), &|measure, x, y| allowance.excess(measure, x, y)).is_none(),
                same,
                "{a} {b}"
            );
        }
        for (a, b) in [("12 m", "12 mm"), ("a", "b"), ("1", "1 | 2"), ("1", "(1)"), ("(1, 2)", "(1, 2, 3)"), ("3", "x")] {
            assert_eq!(check(a, b), Some(f64::INFINITY), "{a} {b}");
        }
    }
}

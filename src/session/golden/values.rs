//! What stands behind the words of a golden file: written, and read back.

use super::cells::{self, CellValue};
use super::quotes::{end_of_quote, label, phrase, unquoted};
use super::words::{Kind, Measure};
use crate::lang::values::units::{length_unit, number_text};

/// What stands behind a word of a line.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A phrase, a verdict or a stretch of source.
    Word(String),
    /// A whole number.
    Count(u64),
    /// A number and its unit (empty for a bare one).
    Real(f64, String),
    /// Names with counts.
    Groups(Vec<(String, u64)>),
    /// Two corners and their unit.
    Corners([[f64; 3]; 2], String),
    /// Numbers and their unit (empty for bare ones).
    List(Vec<f64>, String),
    /// A row of a table.
    Cells(Vec<CellValue>),
}

/// Numbers as far as the largest of them is written with so many significant digits.
fn together(all: &[f64], digits: usize) -> Vec<String> {
    let exponent = |x: f64| format!("{x:e}").split_once('e').and_then(|(_, e)| e.parse::<i32>().ok()).unwrap_or(0);
    let most = exponent(all.iter().fold(0.0, |most, x| most.max(x.abs())));
    let one = |x: &f64| match digits as i32 - (most - exponent(*x)) {
        _ if *x == 0.0 => "0".to_owned(),
        left if left > 0 => rounded(*x, left as usize),
        _ => "0".to_owned(),
    };
    all.iter().map(one).collect()
}

/// A number with so many significant digits, or with all it has.
pub fn rounded(x: f64, digits: usize) -> String {
    let cut: f64 = format!("{x:.*e}", digits.saturating_sub(1)).parse().unwrap_or(x);
    number_text(cut)
}

impl Value {
    /// As written in a golden file, reals with so many significant digits.
    pub fn text(&self, kind: Kind, digits: usize) -> String {
        let number = |x: &f64| rounded(*x, digits);
        let with_unit = |text: String, unit: &str| if unit.is_empty() { text } else { format!("{text} {unit}") };
        match self {
            Self::Word(word) if kind == Kind::Source => format!("`{word}`"),
            Self::Word(word) => phrase(word),
            Self::Count(n) => n.to_string(),
            Self::Real(x, unit) => with_unit(number(x), unit),
            Self::Groups(groups) => groups.iter().map(|(name, n)| format!("{}:{n}", label(name))).collect::<Vec<_>>().join(" "),
            Self::Cells(row) => cells::text(row, digits),
            Self::List(all, unit) => with_unit(format!("({})", together(all, digits).join(", ")), unit),
            Self::Corners(corners, unit) => {
                let point = |p: &[f64; 3]| format!("({})", p.iter().map(number).collect::<Vec<_>>().join(", "));
                with_unit(format!("{} {}", point(&corners[0]), point(&corners[1])), unit)
            }
        }
    }

    /// What a text says; the error is what was expected instead.
    pub fn parse(kind: Kind, text: &str) -> Result<Self, String> {
        match kind {
            Kind::Word => Ok(Self::Word(if text.starts_with('"') { unquoted(text)? } else { text.to_owned() })),
            Kind::Verdict => Ok(Self::Word(text.to_owned())),
            Kind::Source => match text.strip_prefix('`').and_then(|t| t.strip_suffix('`')) {
                Some(inside) => Ok(Self::Word(inside.to_owned())),
                None => Err("a stretch of the script between backquotes".to_owned()),
            },
            Kind::Count => text.parse().map(Self::Count).map_err(|_| "a whole number".to_owned()),
            Kind::Real(measure) => real(measure, text),
            Kind::Groups => groups(text),
            Kind::Cells | Kind::Limit => cells::parse(text).map(Self::Cells),
            Kind::List(measure) => list_of(measure, text),
            Kind::Corners => corners(text).ok_or_else(|| "two corners and a unit: `(0, 0, 0) (4, 3, 1) m`".to_owned()),
        }
    }
}

/// A finite number.
pub fn number(text: &str) -> Option<f64> {
    crate::base::text::parse_real(text).filter(|x| x.is_finite())
}

/// Whether a unit measures this, and what stands behind a number that does.
fn is_unit_of(measure: Measure, unit: &str) -> (bool, String) {
    match measure {
        Measure::Length(power) => {
            let tail = if power == 1 { String::new() } else { power.to_string() };
            (unit.strip_suffix(tail.as_str()).is_some_and(|name| length_unit(name).is_some()), format!(" m{tail}"))
        }
        Measure::Angle => (unit == "deg", " deg".to_owned()),
        Measure::Ratio => (unit.is_empty(), String::new()),
    }
}

fn real(measure: Measure, text: &str) -> Result<Value, String> {
    let (value, unit) = text.split_once(' ').unwrap_or((text, ""));
    let unit = unit.trim();
    let (known, tail) = is_unit_of(measure, unit);
    match number(value) {
        Some(x) if known => Ok(Value::Real(x, unit.to_owned())),
        _ if measure == Measure::Ratio => Err("a number like `0.95`".to_owned()),
        _ => Err(format!("a number and its unit like `12.5{tail}`")),
    }
}

fn list_of(measure: Measure, text: &str) -> Result<Value, String> {
    let wanted = |tail: &str| format!("numbers in brackets{} like `(4, 3, 1){tail}`", if tail.is_empty() { "" } else { " and their unit" });
    let (inside, unit) = text.strip_prefix('(').and_then(|t| t.split_once(')')).unwrap_or(("", ""));
    let unit = unit.trim();
    let (known, tail) = is_unit_of(measure, unit);
    let all: Option<Vec<f64>> = inside.split(',').map(|x| number(x.trim())).collect();
    all.filter(|_| known).map(|all| Value::List(all, unit.to_owned())).ok_or_else(|| wanted(&tail))
}

fn groups(text: &str) -> Result<Value, String> {
    let wanted = || "names with counts like `supports:12 \"west wall\":4`".to_owned();
    let mut found: Vec<(String, u64)> = Vec::new();
    let mut rest = text;
    while !rest.is_empty() {
        let (name, after) = if rest.starts_with('"') {
            let end = end_of_quote(rest).ok_or_else(wanted)?;
            (unquoted(&rest[..end])?, rest[end..].strip_prefix(':').ok_or_else(wanted)?)
        } else {
            let (name, after) = rest.split_once(':').ok_or_else(wanted)?;
            (name.to_owned(), after)
        };
        let (count, after) = after.split_once(' ').unwrap_or((after, ""));
        found.push((name, count.parse().map_err(|_| wanted())?));
        rest = after.trim_start();
    }
    if let Some((_, (name, _))) = found.iter().enumerate().find(|(k, g)| found[..*k].iter().any(|o| o.0 == g.0)) {
        return Err(format!("each group once, and `{name}` is given twice"));
    }
    if found.is_empty() { Err(wanted()) } else { Ok(Value::Groups(found)) }
}

fn corners(text: &str) -> Option<Value> {
    let (first, rest) = text.strip_prefix('(')?.split_once(')')?;
    let (second, unit) = rest.trim_start().strip_prefix('(')?.split_once(')')?;
    let point = |inside: &str| {
        let parts: Vec<f64> = inside.split(',').map(|x| number(x.trim())).collect::<Option<_>>()?;
        <[f64; 3]>::try_from(parts).ok()
    };
    let unit = unit.trim();
    length_unit(unit)?;
    Some(Value::Corners([point(first)?, point(second)?], unit.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(kind: Kind, text: &str) {
        let value = Value::parse(kind, text).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!(value.text(kind, 17), text);
    }

    #[test]
    fn values_read_back() {
        check(Kind::Real(Measure::Length(2)), "9.424777961 m2");
        check(Kind::Real(Measure::Angle), "38.2 deg");
        check(Kind::Groups, "supports:12 \"west \\\"wall\\\"\":4");
        check(Kind::Corners, "(0, -1.5, 0) (4, 1e300, 1) mm");
        check(Kind::List(Measure::Length(2)), "(0, -1.5, 12345678901, 2, 3, 4) mm2");
        assert_eq!(
            Value::List(vec![1234.5, 0.001_234_5, 1e-9], "m".to_owned()).text(Kind::List(Measure::Length(1)), 8),
            "(1234.5, 0.0012, 0) m"
        );
        check(Kind::Source, "`near A { size: 20mm }`");
        check(Kind::Word, "degenerate trilateral closed in u");
        check(Kind::Count, "63");
    }

    #[test]
    fn what_is_wrong_is_said() {
        let said = |kind, text| Value::parse(kind, text).unwrap_err();
        assert_eq!(said(Kind::Count, "63 triangles 96"), "a whole number");
        assert_eq!(said(Kind::Real(Measure::Length(2)), "9.4 m"), "a number and its unit like `12.5 m2`");
        assert_eq!(said(Kind::Real(Measure::Length(1)), "nan m"), "a number and its unit like `12.5 m`");
        assert_eq!(said(Kind::Groups, "a:1 a:2"), "each group once, and `a` is given twice");
    }
}

//! Offsets of a hull: sections of half breadths, and how their tables are read.

use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::ValueFault;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::values::table::Table;
use crate::lang::values::units::number_text;
use crate::lang::values::value::{Dim, Value};

/// A value that is this many times all beside it, or a step of stations this many times the middle one, has another unit.
const OTHER_UNIT: f64 = 100.0;
/// The breadth at the last station may be this share of the largest.
const CLOSED: f64 = 0.02;

/// The half of a cross section.
pub(super) struct Section {
    /// Its station, model units.
    pub x: f64,
    /// Points from below upwards.
    pub points: Vec<DVec3>,
    /// Of these, the ones at which lines of the hull pass: places in `points`, ascending.
    pub marked: Vec<usize>,
}

impl Section {
    /// The largest half breadth.
    pub(super) fn widest(&self) -> f64 {
        self.points.iter().map(|p| p.y).fold(0.0, f64::max)
    }

    /// The parts between marked points.
    pub(super) fn runs(&self) -> Vec<&[DVec3]> {
        let Some(last) = self.points.len().checked_sub(1) else { return Vec::new() };
        let inner = self.marked.iter().copied().filter(|i| *i > 0 && *i < last);
        let stops: Vec<usize> = [0].into_iter().chain(inner).chain([last]).collect();
        stops.windows(2).map(|ends| &self.points[ends[0]..=ends[1]]).collect()
    }
}

/// A line of the hull: sheer, chine, a profile.
pub(super) struct Line {
    pub name: Arc<str>,
    pub points: Vec<DVec3>,
}

/// What a table of offsets holds.
pub(super) struct Offsets {
    pub sections: Vec<Section>,
    /// Heights of waterlines and the points of each forward; none in a table of points.
    pub waterlines: Vec<(f64, Vec<DVec3>)>,
    pub lines: Vec<Line>,
}

/// A fault of a table with its place.
pub(super) fn bad(argument: &'static str, found: String, range: &str) -> Halt {
    ValueFault::OutsideRange { argument, found, range: range.to_owned() }.into()
}

/// Row and column as a text editor or a spreadsheet counts them: the header is row 1, the heights are column 1.
pub(super) fn place(row: usize, column: usize) -> String {
    format!("row {}, column {}", row + 1, column + 1)
}

/// A cell as a length; none where it is empty. `row` and `column` are counted from 0 with the header.
pub(super) fn length(cx: &mut Cx, argument: &'static str, cell: &Value, (row, column): (usize, usize)) -> Result<Option<f64>, Halt> {
    match cell {
        Value::None => Ok(None),
        Value::Number(q) if q.dim == Dim::LENGTH => Ok(Some(q.value)),
        Value::Number(q) if q.dim.is_none() => Ok(Some(q.value * cx.bare_unit(cx.module()))),
        other => Err(bad(argument, format!("{} in {}", cx.show(other), place(row, column)), "one of lengths and empty cells")),
    }
}

/// Places in a row must ascend by steps of one size class; `at` says where one is.
pub(super) fn ascending(places: &[f64], what: &str, at: &dyn Fn(usize) -> String) -> Result<(), Halt> {
    for (i, pair) in places.windows(2).enumerate() {
        if pair[1] <= pair[0] {
            let fault = if pair[1] == pair[0] { "a second time" } else { "out of order" };
            let found = format!("{what} {} {fault} in {}", number_text(pair[1]), at(i + 1));
            return Err(bad("table", found, "one with ascending stations and heights"));
        }
    }
    let steps: Vec<f64> = places.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut sorted = steps.clone();
    sorted.sort_by(f64::total_cmp);
    let Some(middle) = sorted.get(sorted.len() / 2) else { return Ok(()) };
    match steps.iter().position(|step| *step > OTHER_UNIT * middle) {
        Some(i) => {
            let found = format!("{what} {} in {}, as if in another unit", number_text(places[i + 1]), at(i + 1));
            Err(bad("table", found, "in one unit"))
        }
        None => Ok(()),
    }
}

/// A value as if in another unit than the largest one beside it.
pub(super) fn another_unit(argument: &'static str, value: f64, beside: f64, place: &str) -> Result<(), Halt> {
    if beside > 0.0 && value > OTHER_UNIT * beside {
        let found = format!("{} in {place}, as if in another unit: beside it {} at most", number_text(value), number_text(beside));
        return Err(bad(argument, found, "in one unit"));
    }
    Ok(())
}

/// The column of a header with one of some names, whatever their case.
pub(super) fn column(table: &Table, names: &[&str]) -> Option<usize> {
    let of = |cell: &Value| match cell {
        Value::Text(text) => names.iter().any(|name| text.trim().eq_ignore_ascii_case(name)),
        _ => false,
    };
    table.header.as_ref()?.iter().position(of)
}

impl Offsets {
    /// Whether the last station is closed, by its breadths or by a line of the centre plane that reaches it.
    pub(super) fn check_stem(&self) -> Result<(), Halt> {
        let Some(last) = self.sections.last() else { return Ok(()) };
        let all = self.sections.iter().map(Section::widest).fold(0.0, f64::max);
        let reaches = |line: &Line| line.points.iter().all(|p| p.y == 0.0) && line.points.iter().any(|p| p.x >= last.x);
        if last.widest() > CLOSED * all && !self.lines.iter().any(reaches) {
            let found =
                format!("a half breadth of {} at the last station, x = {}: no stem", number_text(last.widest()), number_text(last.x));
            let range = "closed forward, by a station of zeros or a profile in `lines:` (`stem: false` where it need not be)";
            return Err(bad("table", found, range));
        }
        Ok(())
    }
}

//! Tables of offsets by point: a row has a station, a half breadth and a height, and may name a line that passes there.

use std::sync::Arc;

use glam::DVec3;

use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::offsets::{Line, Offsets, Section, another_unit, ascending, bad, column, length, place};
use crate::lang::values::table::Table;
use crate::lang::values::units::number_text;
use crate::lang::values::value::Value;

const STATION: [&str; 2] = ["station", "x"];
const BREADTH: [&str; 3] = ["half breadth", "half_breadth", "y"];
const HEIGHT: [&str; 2] = ["height", "z"];
const LINE: [&str; 3] = ["line", "knuckle", "name"];

/// The columns of a table of points.
pub(super) struct Columns {
    xyz: [usize; 3],
    line: Option<usize>,
}

/// One row.
struct Row {
    /// Counted from 0 with the header.
    row: usize,
    point: DVec3,
    line: Option<Arc<str>>,
}

/// Where the header has its columns; none where it is not that of a table of points.
pub(super) fn columns(table: &Table) -> Option<Columns> {
    let xyz = [column(table, &STATION)?, column(table, &BREADTH)?, column(table, &HEIGHT)?];
    Some(Columns { xyz, line: column(table, &LINE) })
}

fn rows(cx: &mut Cx, argument: &'static str, table: &Table, columns: &Columns) -> Result<Vec<Row>, Halt> {
    let mut found = Vec::with_capacity(table.rows.len());
    for (i, values) in table.rows.iter().enumerate() {
        let row = i + 1;
        let cells = values.len().unwrap_or(0);
        if (0..cells).all(|k| matches!(values.item(k), None | Some(Value::None))) {
            continue;
        }
        let mut point = [0.0; 3];
        for (x, k) in point.iter_mut().zip(columns.xyz) {
            let cell = length(cx, argument, &values.item(k).unwrap_or_default(), (row, k))?;
            let missing = || bad(argument, format!("no value in {}", place(row, k)), "one of whole points");
            *x = cell.ok_or_else(missing)?;
        }
        if point[1] < 0.0 {
            let found = format!("{} in {}", number_text(point[1]), place(row, columns.xyz[1]));
            return Err(bad(argument, found, "one of half breadths from 0 up"));
        }
        let line = match columns.line.and_then(|k| values.item(k)) {
            None | Some(Value::None) => None,
            Some(Value::Text(text)) => Some(text),
            Some(other) => Some(cx.show(&other).into()),
        };
        found.push(Row { row, point: point.into(), line });
    }
    Ok(found)
}

/// The offsets of a table of points: those of a station together and from below upwards, stations ascending.
pub(super) fn read(cx: &mut Cx, table: &Table, columns: &Columns) -> Result<Offsets, Halt> {
    let rows = rows(cx, "table", table, columns)?;
    let mut offsets = Offsets { sections: Vec::new(), waterlines: Vec::new(), lines: Vec::new() };
    let stations: Vec<&[Row]> = rows.chunk_by(|a, b| a.point.x == b.point.x).collect();
    let places: Vec<f64> = stations.iter().map(|s| s[0].point.x).collect();
    ascending(&places, "station", &|k| place(stations[k][0].row, columns.xyz[0]))?;
    check_units(&stations, columns)?;
    for station in stations {
        for pair in station.windows(2) {
            if pair[0].point == pair[1].point {
                let found = format!("one point in row {} and row {}", pair[0].row + 1, pair[1].row + 1);
                return Err(bad("table", found, "one of different points"));
            }
        }
        let points = station.iter().map(|row| row.point).collect();
        let marked = (0..station.len()).filter(|i| station[*i].line.is_some()).collect();
        offsets.sections.push(Section { x: station[0].point.x, points, marked });
        for row in station {
            if let Some(name) = &row.line {
                offsets.lines_mut(name).push(row.point);
            }
        }
    }
    Ok(offsets)
}

/// The lines of a table in which each row names the one that it belongs to, in the order of its rows.
pub(super) fn lines(cx: &mut Cx, table: &Table) -> Result<Vec<Line>, Halt> {
    let range = "one whose header has `line`, `x`, `y` and `z`";
    let columns = columns(table).filter(|columns| columns.line.is_some());
    let columns = columns.ok_or_else(|| bad("lines", "another table".to_owned(), range))?;
    let mut offsets = Offsets { sections: Vec::new(), waterlines: Vec::new(), lines: Vec::new() };
    for row in rows(cx, "lines", table, &columns)? {
        let Some(name) = &row.line else {
            return Err(bad("lines", format!("no line named in row {}", row.row + 1), "one with a line in each row"));
        };
        let points = offsets.lines_mut(name);
        if points.last() == Some(&row.point) {
            return Err(bad("lines", format!("the point of row {} a second time", row.row + 1), "one of different points"));
        }
        points.push(row.point);
    }
    match offsets.lines.iter().find(|line| line.points.len() < 2) {
        Some(line) => Err(bad("lines", format!("one point of `{}`", line.name), "two points of each line or more")),
        None => Ok(offsets.lines),
    }
}

/// The largest half breadth and height of a station in the unit of those of the stations beside it.
fn check_units(stations: &[&[Row]], columns: &Columns) -> Result<(), Halt> {
    for axis in [1, 2] {
        let size = |row: &&Row| row.point[axis].abs();
        let largest = |k: usize| stations.get(k)?.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
        for k in 0..stations.len() {
            let Some(row) = largest(k) else { continue };
            let beside = [k.checked_sub(1).and_then(largest), largest(k + 1)];
            let beside = beside.into_iter().flatten().map(|row| size(&row)).fold(0.0, f64::max);
            another_unit("table", size(&row), beside, &place(row.row, columns.xyz[axis]))?;
        }
    }
    Ok(())
}

impl Offsets {
    /// The points of the line of a name, which is made where there is none.
    fn lines_mut(&mut self, name: &Arc<str>) -> &mut Vec<DVec3> {
        let k = self.lines.iter().position(|line| line.name == *name).unwrap_or_else(|| {
            self.lines.push(Line { name: name.clone(), points: Vec::new() });
            self.lines.len() - 1
        });
        &mut self.lines[k].points
    }
}

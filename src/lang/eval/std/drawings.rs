//! Drawings: plots of tables and lines plans of hulls, for `picture`.

use std::sync::Arc;

use crate::base::fault::ValueFault;
use crate::builtins;
use crate::draw::Drawing;
use crate::draw::plot::{Column, Plot, Style};
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::kinds::Faces;
use crate::lang::eval::std::lines_plans::{Asked, plan};
use crate::lang::values::conversions::Length;
use crate::lang::values::value::{Record, Value};

crate::choices! {
    /// How the columns of a plot are drawn.
    pub enum PlotStyle {
        /// Lines from value to value.
        Lines = "lines",
        /// A sign at each value.
        Points = "points",
        /// Lines and signs.
        Both = "both",
    }
}

crate::choices! {
    /// Where along x the bow of a hull is.
    pub enum Bow {
        /// Where x is large.
        High = "high",
        /// Where x is small.
        Low = "low",
    }
}

/// The columns of a table; E211 for what is none, E306 for one without rows.
fn columns(cx: &mut Cx, rows: &Value) -> Result<Vec<(Column, Option<String>)>, Halt> {
    let is_table = match rows {
        Value::Table(_) => true,
        Value::List(items) => items.iter().all(|row| matches!(row, Value::Record(_))),
        _ => false,
    };
    if !is_table {
        let found = cx.kind(rows);
        return Err(ValueFault::WrongKind { argument: "rows", wanted: "a list of records or an imported table", found }.into());
    }
    let table = cx.table(String::new(), rows);
    if table.rows.is_empty() {
        return Err(ValueFault::OutsideRange { argument: "rows", found: "none".to_owned(), range: "one row or more".to_owned() }.into());
    }
    let column = |(k, column): (usize, crate::lang::values::plans::Column)| {
        let mut other = None;
        let number = |value: &Value| match value {
            Value::Number(q) => q.value,
            Value::None => f64::NAN,
            wrong => {
                other.get_or_insert_with(|| wrong.clone());
                f64::NAN
            }
        };
        let values = table.rows.iter().filter_map(|row| row.get(k)).map(number).collect();
        (Column { name: column.name, unit: column.unit, values }, other.map(|wrong| cx.show_inside(&wrong)))
    };
    Ok(table.columns.into_iter().enumerate().map(column).collect())
}

/// A column by its name; E306 where there is none, or it holds something else than numbers.
fn named(columns: &[(Column, Option<String>)], argument: &'static str, name: &str) -> Result<Column, Halt> {
    match columns.iter().find(|c| c.0.name == name) {
        Some((column, None)) if column.values.iter().any(|x| x.is_finite()) => Ok(column.clone()),
        Some((_, other)) => {
            let held = other.as_ref().map_or_else(String::new, |text| format!(" that holds {text}"));
            let (found, range) = (format!("the column \"{name}\"{held}"), "a column of numbers of one unit".to_owned());
            Err(ValueFault::OutsideRange { argument, found, range }.into())
        }
        None => {
            let names: Vec<&str> = columns.iter().map(|c| c.0.name.as_str()).collect();
            let (found, range) = (format!("\"{name}\""), format!("the name of a column: {}", names.join(", ")));
            Err(ValueFault::OutsideRange { argument, found, range }.into())
        }
    }
}

fn plotted(cx: &mut Cx, rows: &Value, x: &str, y: Option<Vec<Arc<str>>>) -> Result<Plot, Halt> {
    let columns = columns(cx, rows)?;
    let along = named(&columns, "x", x)?;
    let series = match y {
        Some(names) => names.iter().map(|name| named(&columns, "y", name)).collect::<Result<Vec<_>, _>>()?,
        None => {
            let is_drawn = |c: &&(Column, Option<String>)| c.0.name != x && c.1.is_none() && c.0.values.iter().any(|v| v.is_finite());
            columns.iter().filter(is_drawn).map(|c| c.0.clone()).collect()
        }
    };
    if series.is_empty() {
        let (found, range) = ("none".to_owned(), "one column of numbers or more".to_owned());
        return Err(ValueFault::OutsideRange { argument: "y", found, range }.into());
    }
    let plot = Plot { x: along, series, title: String::new(), style: Style::Lines };
    let units = plot.units();
    if units.len() > 2 {
        let written: Vec<&str> = units.iter().map(|u| if u.is_empty() { "no unit" } else { u }).collect();
        let (found, range) = (format!("columns in {}", written.join(", ")), "columns of at most two units, one for each side".to_owned());
        return Err(ValueFault::OutsideRange { argument: "y", found, range }.into());
    }
    Ok(plot)
}

builtins! {
    /// Plot of columns of a table over another one, for `picture`.
    ///
    /// A table is a list of records, as reports and comprehensions give it, or an imported one. Axes have round numbers and the units of the columns; columns of two
    /// units have an axis on either side, of more than two it is E306. Large and small numbers are written in powers of a thousand. A cell
    /// that is `none` is a gap in the line. `picture` takes `width`, `height`, `title` and `legend`.
    /// ```loft
    /// let rows = [for d in 1..9: {draft: d * 1m, volume: 24m2 * d * 1m, area: 24m2 + d * 1m2}]
    /// picture plot(rows, x: "draft", y: ["volume", "area"]) to "form.svg"
    /// picture plot(rows, x: "draft", y: "volume", style: both) to "volume.png" { title: "Volume", width: 800, height: 600 }
    /// ```
    fn plot(
        /// A list of records, or an imported table.
        rows: Value,
        /// Name of the column that goes to the right.
        x: Arc<str>,
        /// Names of the columns that go up; left out, all others of numbers.
        y: Option<Vec<Arc<str>>>,
        /// Words above it; left out, the names of the columns.
        title: Option<Arc<str>>,
        /// Lines, signs at the values, or both.
        style: PlotStyle = "lines",
    ) -> Drawing = |cx, rows, x, y, title, style| {
        let mut plot = plotted(cx, &rows, &x, y)?;
        plot.title = title.as_deref().unwrap_or_default().to_owned();
        plot.style = match style {
            PlotStyle::Lines => Style::Lines,
            PlotStyle::Points => Style::Points,
            PlotStyle::Both => Style::Both,
        };
        Ok(Drawing::Plot(plot))
    };

    /// Lines plan of a hull, for `picture`: three views on one sheet.
    ///
    /// They are the profile, the half-breadth plan and the body plan.
    ///
    /// x runs along the hull, z is up, y = 0 is the centre plane. The hull may be one side of it or whole. Of a whole one whose sides are equal
    /// one is drawn; where they differ both are: port left and starboard right in the body plan with the sections aft of the middle dashed, port above and
    /// starboard below the centreline, starboard buttocks dashed, and no diagonals (E306). Sections are the curves in which planes meet the faces: stations across, waterlines level, buttocks upright along the hull, diagonals in planes along it that
    /// fall by `angle` towards the side from `height` on the centre plane. The profile shows buttocks, the half-breadth plan waterlines and below its centreline diagonals in true length, the
    /// body plan stations, fore ones right and aft ones left of the middle between the first and the last station. Free edges and knuckles are drawn in all three.
    /// The scale is round and holds for a print of the SVG file at 96 pixels an inch; of slender hulls the body plan has a larger one. A plane
    /// beside the hull is E306. `picture` takes `width`, `height`, `title` and `legend`.
    /// ```loft
    /// fn rib(x: length, b: length): curve = spline([(x, 0m, 0m), (x, 0.8 * b, 0.4m), (x, b, 3m)])
    /// surface side = skin([for i in 0..5: rib(i * 4m, 0.6m + i * (4 - i) * 0.5m)])
    /// picture lines_plan(side, stations: [for i in 1..4: i * 4m], waterlines: [1m, 2m], buttocks: [1m]) to "lines.svg"
    /// ```
    fn lines_plan(
        /// Surfaces and shells of the hull, or of its half.
        hull: Faces,
        /// x of the sections across; left out, at each tenth of the length and halfway between the outermost.
        stations: Option<Vec<Length>>,
        /// z of the level sections; left out, at each sixth of the depth.
        waterlines: Option<Vec<Length>>,
        /// Distances of the upright sections from the centre plane; left out, at each quarter of the half beam.
        buttocks: Option<Vec<Length>>,
        /// Records `{height: 8m, angle: 30deg}`.
        diagonals: Option<Vec<Arc<Record>>>,
        /// Where the bow is: where x is large, or where it is small. It stands at the right.
        bow: Bow = "high",
    ) -> Drawing = |cx, hull, stations, waterlines, buttocks, diagonals, bow| {
        let places = |list: Option<Vec<Length>>| list.map(|list| list.into_iter().map(|x| x.0).collect());
        let asked = Asked {
            stations: places(stations),
            waterlines: places(waterlines),
            buttocks: places(buttocks),
            diagonals: diagonals.unwrap_or_default(),
            bow_is_high: bow == Bow::High,
        };
        Ok(Drawing::LinesPlan(plan(cx, &hull, asked)?))
    };
}

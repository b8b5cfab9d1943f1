//! The builtin that makes sections, waterlines and lines of a hull from tables.

use std::sync::Arc;

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::fault::ValueFault;
use crate::base::tolerance::OFFSETS_SAME;
use crate::builtins;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::offsets::{Line, Offsets, Section};
use crate::lang::eval::std::{offsets_grid, offsets_points};
use crate::lang::values::conversions::Length;
use crate::lang::values::table::Table;
use crate::lang::values::value::{Record, Value};

/// Either kind of table, without its lines.
fn read(cx: &mut Cx, table: &Table) -> Result<Offsets, Halt> {
    let Some(header) = &table.header else {
        let example = "import \"offsets.csv\" (header: true, unit: m) as offsets";
        let what = "a table whose header has the stations, or `x`, `y` and `z`";
        return Err(ValueFault::Missing { function: "hull_lines", what, example }.into());
    };
    match offsets_points::columns(table) {
        Some(columns) => offsets_points::read(cx, table, &columns),
        None => offsets_grid::read(cx, table, header),
    }
}

fn points(points: &[DVec3]) -> Value {
    Value::List(Arc::new(points.iter().map(|p| Value::point(*p)).collect()))
}

fn list(items: impl Iterator<Item = Value>) -> Value {
    Value::List(Arc::new(items.collect()))
}

/// Lines by name.
fn by_name(cx: &mut Cx, lines: &[Line]) -> Value {
    let keys = lines.iter().map(|line| cx.program.names.intern(&line.name)).collect();
    let values = lines.iter().map(|line| points(&line.points)).collect();
    Value::Record(Arc::new(Record { keys: Arc::new(keys), values, row: false, part: None }))
}

builtins! {
    /// Sections, waterlines and lines of a hull from tables of half breadths.
    ///
    /// A table of offsets has the stations (x, forward) in its header and the heights (z) of the waterlines in its first column; an empty
    /// cell is where there is no hull, zero a half breadth in the centre plane. A table of points has the columns `x`, `y`, `z` (also
    /// `station`, `half breadth`, `height`), a point in each row, those of a station together and from below upwards; a fourth column
    /// `line` names a line that passes there, as a chine or the sheer.
    ///
    /// `lines:` is a table with the columns `line`, `x`, `y`, `z`: the points of each line in order. Lines are curves through their points,
    /// with corners where these turn by more than 30°. A line of the centre plane (stem, keel, stern) ends the sections where it passes their stations; zeros beyond it
    /// fall away. Any other line (sheer, chine, knuckle) passes the sections at a point of them, which is put in where none is nearer
    /// than `near:`.
    ///
    /// A record: `stations`; `sections`, for each station its points upwards; `runs`, for each station the parts of its section
    /// between the points where lines pass, for curves that keep their kinks; `lines`, the points of each line by name; of a table of
    /// offsets `heights`, and `waterlines`, for each height its points forward. Empty cells are left out. Stations and heights ascend,
    /// half breadths are not negative, nothing is a hundred times what is beside it, and the last station is closed. What is wrong
    /// is told with its row and column as a spreadsheet counts them.
    /// ```loft
    /// // import "offsets.csv" (header: true, unit: m) as offsets
    /// // import "profiles.csv" (unit: m) as profiles
    /// // let hull = hull_lines(offsets, lines: profiles)
    /// // curve bottoms for run in hull.runs = fit(run[0])
    /// let a = 1 // => 1
    /// ```
    fn hull_lines(
        /// A table with a header.
        table: Arc<Table>,
        /// Lines that pass the sections: profiles, sheer, chines.
        lines: Option<Arc<Table>>,
        /// A point of a section that is nearer than this to where a line passes is moved there; when left out a millionth of the hull's diagonal.
        near: Option<Length>,
        /// Whether the last station must be closed, by zeros or a profile that reaches it.
        stem: bool = "true",
    ) -> Value = |cx, table, lines, near, stem| {
        let mut offsets = read(cx, &table)?;
        if near.is_some() && lines.is_none() {
            let example = "hull_lines(offsets, lines: profiles, near: 2mm)";
            return Err(ValueFault::Missing { function: "hull_lines", what: "`lines:`, to which points are near", example }.into());
        }
        if let Some(lines) = lines {
            let size = offsets.sections.iter().flat_map(|s| &s.points).fold(Box3::EMPTY, |all, p| all.with(*p)).diagonal();
            let lines = offsets_points::lines(cx, &lines)?;
            let tolerance = cx.tolerance()?;
            offsets = offsets.with_lines(lines, near.map_or(OFFSETS_SAME * size, |near| near.0), cx.origin(), &tolerance)?;
        }
        if stem {
            offsets.check_stem()?;
        }
        let lines = by_name(cx, &offsets.lines);
        let (sections, waterlines) = (&offsets.sections, &offsets.waterlines);
        let runs = |s: &Section| list(s.runs().into_iter().map(points));
        Ok(cx.record([
            ("stations", list(sections.iter().map(|s| Value::length(s.x)))),
            ("sections", list(sections.iter().map(|s| points(&s.points)))),
            ("runs", list(sections.iter().map(runs))),
            ("lines", lines),
            ("heights", list(waterlines.iter().map(|w| Value::length(w.0)))),
            ("waterlines", list(waterlines.iter().map(|w| points(&w.1)))),
        ]))
    };
}

//! Tables of offsets of hulls: half breadths at stations and heights, in the form that imports have.

use std::sync::Arc;

use crate::base::fault::{Say, ValueFault};
use crate::base::text::real;
use crate::builtins;
use crate::hydrostatics::half_breadths::Hull;
use crate::hydrostatics::sides::Side;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::floating::{Floating, surfaces, triangles};
use crate::lang::values::conversions::Length;
use crate::lang::values::table::Table;
use crate::lang::values::value::{Record, Value};

/// What stands over the heights.
const CORNER: &str = "z\\x";

crate::choices! {
    /// A side of a hull.
    pub enum HullSide {
        /// Where y is positive.
        Port = "port",
        /// Where y is negative.
        Starboard = "starboard",
    }
}

/// Half breadths by station, then by height.
type Cells = Vec<Vec<Option<f64>>>;

/// What is measured.
fn hull(cx: &mut Cx, what: &Floating) -> Result<Hull, Halt> {
    let tolerance = cx.tolerance()?.point;
    match what {
        Floating::Mesh(mesh) => {
            let (nodes, corners) = triangles(cx, mesh)?;
            Ok(Hull::of_triangles(nodes, corners, tolerance))
        }
        Floating::Faces(values) => Ok(Hull::of_faces(&surfaces(values), tolerance)),
    }
}

/// Places in order, each once; E306 where there is none.
fn ascending(argument: &'static str, places: Vec<Length>) -> Result<Vec<f64>, Halt> {
    let mut places: Vec<f64> = places.into_iter().map(|x| x.0).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    if places.is_empty() {
        return Err(ValueFault::OutsideRange { argument, found: "none".to_owned(), range: "one or more".to_owned() }.into());
    }
    Ok(places)
}

/// The first cell in which two sides differ, by station and height, with how much in words.
fn apart(cx: &Cx, port: &Cells, starboard: &Cells, tolerance: f64) -> Option<(usize, usize, String)> {
    for (k, (a, b)) in port.iter().zip(starboard).enumerate() {
        for (j, pair) in a.iter().zip(b).enumerate() {
            match pair {
                (Some(a), Some(b)) if (a - b).abs() <= tolerance => {}
                (None, None) => {}
                (a, b) => {
                    let text = |y: Option<f64>| y.map_or_else(|| "none".to_owned(), |y| cx.length(y));
                    return Some((k, j, format!("{} and {}", text(*a), text(*b))));
                }
            }
        }
    }
    None
}

/// The half breadths of the side asked for; E306 where none is and the sides differ.
fn cells(cx: &mut Cx, hull: &Hull, stations: &[f64], heights: &[f64], side: Option<HullSide>) -> Result<Cells, Halt> {
    let asked = side.map(|side| if side == HullSide::Port { Side::Port } else { Side::Starboard });
    if let Some(side) = asked.or(hull.only_side()) {
        return Ok(hull.half_breadths(stations, heights, side));
    }
    let [port, starboard] = [Side::Port, Side::Starboard].map(|side| hull.half_breadths(stations, heights, side));
    let tolerance = cx.tolerance()?.point;
    if let Some((k, j, values)) = apart(cx, &port, &starboard, tolerance) {
        let place = format!("x = {}, z = {}", cx.length(stations[k]), cx.length(heights[j]));
        let found = format!("none, of a hull whose sides differ: {values} at {place}");
        return Err(ValueFault::OutsideRange { argument: "side", found, range: "port or starboard".to_owned() }.into());
    }
    Ok(port)
}

fn table(cx: &mut Cx, stations: &[f64], heights: &[f64], cells: &Cells) -> Result<Table, Halt> {
    cx.steps((stations.len() + 1) * (heights.len() + 1))?;
    let header = [Value::text(CORNER)].into_iter().chain(stations.iter().map(|x| Value::length(*x))).collect();
    let keys = [CORNER.to_owned()].into_iter().chain(stations.iter().map(|x| real(*x)));
    let keys: Arc<Vec<_>> = Arc::new(keys.map(|key| cx.program.names.intern(&key)).collect());
    let row = |(j, z): (usize, &f64)| {
        let breadths = cells.iter().map(|column| column[j].map_or(Value::None, Value::length));
        let values = [Value::length(*z)].into_iter().chain(breadths).collect();
        Value::Record(Arc::new(Record { keys: Arc::clone(&keys), values, row: true, part: None }))
    };
    let rows = heights.iter().enumerate().map(row).collect();
    Ok(Table { title: "".into(), header: Some(Arc::new(header)), keys: Arc::clone(&keys), rows: Arc::new(rows) })
}

builtins! {
    /// Half breadths of a hull at stations and heights, as a table.
    ///
    /// The header has the stations (x), the first column the heights (z), both in order and each once; a cell is the half breadth there, exact
    /// on the faces: not on triangles of them. An empty cell (`none`) is where there is no hull, zero a half breadth in the centre plane. Where
    /// a station meets the hull several times at one height, as at a bulb, the outermost place is given, and at the height of a flat
    /// bottom or deck its edge. A station at a flat transom has the half breadths of the transom,
    /// one at a stem in the centre plane zeros; at an end that is round and only touched it is empty.
    ///
    /// Of a hull of one side (y of 0 and more, or of 0 and less) that side is measured; of a whole one both, which must be equal within the
    /// tolerance, or `side:` says which. `hull_lines` takes the table, and `export` writes it as csv, bare numbers in one unit, which `import` reads again.
    /// ```loft
    /// units m
    /// let side = bezier_surface([[(-5, 0, -0.625), (0, 0, -0.625), (5, 0, -0.625)], [(-5, 0, -0.3125), (0, 1, -0.3125), (5, 0, -0.3125)], [(-5, 0, 0), (0, 1, 0), (5, 0, 0)]])
    /// let table = offsets_table(side, stations: [-2.5m, 0m, 2.5m], heights: [-0.625m, -0.25m, 0m])
    /// check table.rows[2][2] == 0.5m within 1e-12
    /// export table to "offsets.csv"
    /// ```
    fn offsets_table(
        /// Surfaces, shells or a mesh of the hull, or of its half.
        hull: Floating,
        /// x of the stations.
        stations: Vec<Length>,
        /// z of the waterlines.
        heights: Vec<Length>,
        /// The side that is measured: `port` (y positive) or `starboard`; left out, either where they are equal.
        side: Option<HullSide>,
    ) -> Arc<Table> = |cx, hull, stations, heights, side| {
        let (stations, heights) = (ascending("stations", stations)?, ascending("heights", heights)?);
        let hull = self::hull(cx, &hull)?;
        let cells = cells(cx, &hull, &stations, &heights, side)?;
        Ok(Arc::new(table(cx, &stations, &heights, &cells)?))
    };
}

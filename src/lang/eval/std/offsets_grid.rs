//! Tables of offsets by station and waterline, checked cell by cell.

use glam::DVec3;

use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::offsets::{Offsets, Section, another_unit, ascending, bad, length, place};
use crate::lang::values::table::Table;
use crate::lang::values::units::number_text;
use crate::lang::values::value::Value;

/// Half breadths by waterline, then by station; none where there is no hull.
struct Grid {
    stations: Vec<f64>,
    heights: Vec<f64>,
    breadths: Vec<Vec<Option<f64>>>,
}

/// The offsets of a table whose header has the stations and whose first column has the heights.
pub(super) fn read(cx: &mut Cx, table: &Table, header: &[Value]) -> Result<Offsets, Halt> {
    let grid = cells(cx, table, header)?;
    grid.check()?;
    let sections = (0..grid.stations.len()).map(|k| grid.section(k)).collect();
    let waterlines = (0..grid.heights.len()).map(|j| (grid.heights[j], grid.waterline(j))).collect();
    Ok(Offsets { sections, waterlines, lines: Vec::new() })
}

fn cells(cx: &mut Cx, table: &Table, header: &[Value]) -> Result<Grid, Halt> {
    let filled = header.iter().skip(1).rposition(|cell| !matches!(cell, Value::Text(t) if t.is_empty())).map_or(0, |last| last + 1);
    let mut stations = Vec::with_capacity(filled);
    for (k, cell) in header.iter().enumerate().skip(1).take(filled) {
        let station = length(cx, "table", cell, (0, k))?;
        let missing = || bad("table", format!("no station in {}", place(0, k)), "one with a place of each station in its header");
        stations.push(station.ok_or_else(missing)?);
    }
    let (mut heights, mut breadths) = (Vec::new(), Vec::new());
    for (j, row) in table.rows.iter().enumerate() {
        let height = length(cx, "table", &row.item(0).unwrap_or_default(), (j + 1, 0))?;
        let missing = || bad("table", format!("no height in {}", place(j + 1, 0)), "one with a height in each row");
        heights.push(height.ok_or_else(missing)?);
        let mut line = Vec::with_capacity(stations.len());
        for k in 1..row.len().unwrap_or(0).max(stations.len() + 1) {
            let breadth = length(cx, "table", &row.item(k).unwrap_or_default(), (j + 1, k))?;
            match breadth {
                Some(_) if k > stations.len() => {
                    let found = format!("a value in {} where no station is: a shifted row", place(j + 1, k));
                    return Err(bad("table", found, "one with a station above each value"));
                }
                Some(y) if y < 0.0 => {
                    return Err(bad("table", format!("{} in {}", number_text(y), place(j + 1, k)), "one of half breadths from 0 up"));
                }
                _ if k <= stations.len() => line.push(breadth),
                _ => {}
            }
        }
        breadths.push(line);
    }
    Ok(Grid { stations, heights, breadths })
}

impl Grid {
    fn check(&self) -> Result<(), Halt> {
        ascending(&self.stations, "station", &|k| place(0, k + 1))?;
        ascending(&self.heights, "height", &|j| place(j + 1, 0))?;
        for (j, row) in self.breadths.iter().enumerate() {
            for (k, cell) in row.iter().enumerate() {
                if let Some(y) = *cell {
                    another_unit("table", y, self.beside(j, k), &place(j + 1, k + 1))?;
                }
            }
        }
        Ok(())
    }

    /// The largest of the filled cells beside one, in its row and its column.
    fn beside(&self, j: usize, k: usize) -> f64 {
        let at = |j: Option<usize>, k: Option<usize>| self.breadths.get(j?)?.get(k?).copied().flatten();
        let near = [at(j.checked_sub(1), Some(k)), at(Some(j + 1), Some(k)), at(Some(j), k.checked_sub(1)), at(Some(j), Some(k + 1))];
        near.into_iter().flatten().fold(0.0, f64::max)
    }

    /// The filled cells of a station upwards.
    fn section(&self, k: usize) -> Section {
        let x = self.stations[k];
        let rows = self.heights.iter().zip(&self.breadths);
        let points = rows.filter_map(|(z, row)| row[k].map(|y| DVec3::new(x, y, *z))).collect();
        Section { x, points, marked: Vec::new() }
    }

    /// The filled cells of a waterline from aft forward.
    fn waterline(&self, j: usize) -> Vec<DVec3> {
        let cells = self.stations.iter().zip(&self.breadths[j]);
        cells.filter_map(|(x, y)| y.map(|y| DVec3::new(*x, y, self.heights[j]))).collect()
    }
}

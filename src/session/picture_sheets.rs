//! Several views on one sheet.

use crate::draw::picture::{Format, Picture, Settings};
use crate::draw::{Scene as Drawing, View};

/// The scene from several sides in rows and columns, each with its name. What is the same in all, the legend, stands in the last of the first row.
pub(super) fn sheet(views: &[(String, View)], drawing: &Drawing, settings: &Settings, format: Format) -> Picture {
    let columns = (1..=views.len()).find(|n| n * n >= views.len()).unwrap_or(1);
    let rows = views.len().div_ceil(columns);
    let head = Picture::heading(settings);
    let cell = (settings.width / columns, (settings.height - head) / rows);
    let of_cell = |k: usize| Settings {
        view: views[k].1,
        width: cell.0.max(1),
        height: cell.1.max(1),
        title: views[k].0.clone(),
        legend: settings.legend && k + 1 == columns.min(views.len()),
        ..settings.clone()
    };
    let cells = (0..views.len()).map(|k| {
        let at = (k % columns * cell.0, head + k / columns * cell.1);
        (Picture::new(drawing, &of_cell(k), format), at)
    });
    Picture::sheet(cells.collect(), settings)
}

//! Plots: columns of a table over another one, with axes, grid and legend.

use glam::DVec2;

use super::axis::Axis;
use super::camera::Rect;
use super::color::{self, Rgb};
use super::drawing::{Align, Page, Placed, dashed, stroke, words};
use super::font;
use super::page::Item;
use super::picture::Picture;

/// Colours of series, told apart by who sees no difference between red and green as well.
const COLORS: &[Rgb] = &[
    Rgb(0, 92, 184),
    Rgb(212, 84, 0),
    Rgb(0, 134, 98),
    Rgb(176, 36, 116),
    Rgb(108, 78, 190),
    Rgb(140, 104, 12),
    Rgb(0, 150, 196),
    Rgb(90, 94, 102),
];
/// Lines of the grid.
const GRID: Rgb = Rgb(222, 226, 232);
/// The line of zero.
const ZERO: Rgb = Rgb(150, 156, 166);
/// Series that a legend lists.
const KEYS: usize = 24;

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Lines from value to value.
    Lines,
    /// A sign at each value.
    Points,
    /// Lines and signs.
    Both,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Unit of its numbers; empty for bare ones.
    pub unit: String,
    /// Its numbers; not a number where there is none.
    pub values: Vec<f64>,
}

/// Columns over another one. All have as many values; the columns that go up have one unit or two.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Along the page.
    pub x: Column,
    /// Up the page.
    pub series: Vec<Column>,
    /// Words above it; empty for the names of the columns.
    pub title: String,
    /// How series are drawn.
    pub style: Style,
}

/// Where things stand on the page.
struct Layout {
    size: f64,
    page: Rect,
    /// Where values are.
    frame: Rect,
    x: Axis,
    /// The axes of the first unit, at the left, and of the second one, at the right.
    y: Vec<(Axis, String)>,
}

impl Plot {
    /// The units that go up the page, in order of appearance.
    pub fn units(&self) -> Vec<&str> {
        let mut units: Vec<&str> = Vec::new();
        for series in &self.series {
            if !units.contains(&series.unit.as_str()) {
                units.push(&series.unit);
            }
        }
        units
    }

    /// The plot on a page.
    pub fn picture(&self, page: &Page) -> Picture {
        let title = page.title.clone().unwrap_or_else(|| self.title());
        let layout = self.layout(page, &title);
        let mut items = Vec::new();
        grid(&layout, &mut items);
        for (k, series) in self.series.iter().enumerate() {
            self.series_items(k, series, &layout, &mut items);
        }
        let frame = &layout.frame;
        let corners = [frame.min, DVec2::new(frame.max.x, frame.min.y), frame.max, DVec2::new(frame.min.x, frame.max.y), frame.min];
        items.push(stroke(corners.to_vec(), 0.08 * layout.size, color::INK));
        self.axes(&layout, &mut items);
        if page.legend && self.series.len() > 1 {
            self.legend(&layout, &mut items);
        }
        if !title.is_empty() {
            let at = DVec2::new(1.1 * layout.size, (1.1 + 1.3 * font::CAPITAL) * layout.size);
            items.push(words(at, Align::Left, 1.3 * layout.size, &title, color::INK));
        }
        Picture::flat(items, page.size, &title)
    }

    fn title(&self) -> String {
        if !self.title.is_empty() {
            return self.title.clone();
        }
        let names: Vec<&str> = self.series.iter().map(|s| s.name.as_str()).collect();
        format!("{} over {}", names.join(", "), self.x.name)
    }

    fn layout(&self, page: &Page, title: &str) -> Layout {
        let (size, rect) = (page.words(), page.rect());
        let steps = |pixels: f64, each: f64| ((pixels / (each * size)) as usize).clamp(2, 12);
        let x = Axis::holding(self.x.values.iter().copied(), steps(0.7 * rect.max.x, 6.0));
        let units = self.units();
        let several = self.series.len() > 1;
        let of_unit = |unit: &str| {
            let own = || self.series.iter().filter(|s| s.unit == unit);
            let axis = Axis::holding(own().flat_map(|s| s.values.iter().copied()), steps(0.8 * rect.max.y, 3.5));
            // With two axes each says which series it is of.
            let names =
                if several && units.len() == 1 { String::new() } else { own().map(|s| s.name.as_str()).collect::<Vec<_>>().join(", ") };
            let label = axis.label(&names, unit);
            (axis, label)
        };
        let y: Vec<(Axis, String)> = units.iter().map(|u| of_unit(u)).collect();
        let widest =
            |axis: Option<&(Axis, String)>| axis.map_or(0.0, |(a, _)| a.ticks().map(|t| font::width(&a.text(t), size)).fold(0.0, f64::max));
        let keys = if page.legend && several {
            self.series.iter().map(|s| font::width(&s.name, size)).fold(0.0, f64::max) + 4.2 * size
        } else {
            0.0
        };
        let mut frame = rect;
        frame.min.x += 1.8 * size + widest(y.first());
        frame.max.x -= 2.2 * size + widest(y.get(1)) + keys;
        frame.min.y += (if title.is_empty() { 1.1 } else { 3.2 } + 1.6) * size;
        frame.max.y -= 4.6 * size;
        // Too small a page for words: the values keep half of it.
        let least = 0.5 * rect.size();
        if frame.size().x < least.x {
            (frame.min.x, frame.max.x) = (0.25 * rect.max.x, 0.75 * rect.max.x);
        }
        if frame.size().y < least.y {
            (frame.min.y, frame.max.y) = (0.25 * rect.max.y, 0.75 * rect.max.y);
        }
        Layout { size, page: rect, frame, x, y }
    }

    fn series_items(&self, k: usize, series: &Column, layout: &Layout, items: &mut Vec<Item>) {
        let unit = self.units().iter().position(|u| *u == series.unit).unwrap_or(0);
        let color = COLORS[k % COLORS.len()];
        let mut run: Vec<DVec2> = Vec::new();
        let mut runs: Vec<Vec<DVec2>> = Vec::new();
        for (x, y) in self.x.values.iter().zip(&series.values) {
            if x.is_finite() && y.is_finite() {
                run.push(layout.at(unit, *x, *y));
            } else if !run.is_empty() {
                runs.push(std::mem::take(&mut run));
            }
        }
        runs.push(run);
        for run in &runs {
            if self.style != Style::Points && run.len() > 1 {
                items.extend(drawn(run, k, layout.size, color));
            }
            // A value between two gaps would not be seen as a line.
            if self.style != Style::Lines || run.len() == 1 {
                items.extend(run.iter().map(|at| sign(*at, k, layout.size, color)));
            }
        }
    }

    fn axes(&self, layout: &Layout, items: &mut Vec<Item>) {
        let (size, frame) = (layout.size, &layout.frame);
        let mut placed = Placed::default();
        for tick in layout.x.ticks() {
            let x = frame.min.x + layout.x.share(tick) * frame.size().x;
            let at = DVec2::new(x, frame.max.y + 1.5 * size);
            items.push(stroke(vec![DVec2::new(x, frame.max.y), DVec2::new(x, frame.max.y + 0.4 * size)], 0.08 * size, color::INK));
            placed.put(&[(at, Align::Middle)], size, &layout.x.text(tick), color::INK);
        }
        for (k, (axis, label)) in layout.y.iter().enumerate() {
            let (x, way, align) = if k == 0 { (frame.min.x, -1.0, Align::Right) } else { (frame.max.x, 1.0, Align::Left) };
            for tick in axis.ticks() {
                let y = frame.max.y - axis.share(tick) * frame.size().y;
                items.push(stroke(vec![DVec2::new(x, y), DVec2::new(x + way * 0.4 * size, y)], 0.08 * size, color::INK));
                placed.put(&[(DVec2::new(x + way * 0.7 * size, y + 0.35 * size), align)], size, &axis.text(tick), color::INK);
            }
            let align = if k == 0 { Align::Left } else { Align::Right };
            placed.put(
                &[(DVec2::new(x, frame.min.y - 0.8 * size), align), (DVec2::new(x, frame.min.y - 2.1 * size), align)],
                size,
                label,
                color::INK,
            );
        }
        let at = DVec2::new(0.5 * (frame.min.x + frame.max.x), frame.max.y + 3.3 * size);
        placed.put(&[(at, Align::Middle)], size, &layout.x.label(&self.x.name, &self.x.unit), color::INK);
        items.extend(placed.items);
    }

    fn legend(&self, layout: &Layout, items: &mut Vec<Item>) {
        let size = layout.size;
        let widest = self.series.iter().map(|s| font::width(&s.name, size)).fold(0.0, f64::max);
        let left = layout.page.max.x - 0.8 * size - widest - 2.6 * size;
        let rows = ((layout.frame.size().y / (1.6 * size)) as usize).clamp(1, KEYS);
        for (k, series) in self.series.iter().enumerate().take(rows) {
            let y = layout.frame.min.y + (0.6 + 1.6 * k as f64) * size;
            if k + 1 == rows && self.series.len() > rows {
                let more = format!("and {} more", self.series.len() - k);
                items.push(words(DVec2::new(left, y + 0.35 * size), Align::Left, size, &more, color::GREY));
                break;
            }
            let (a, b) = (DVec2::new(left, y), DVec2::new(left + 2.0 * size, y));
            let color = COLORS[k % COLORS.len()];
            if self.style != Style::Points {
                items.extend(drawn(&[a, b], k, size, color));
            }
            if self.style != Style::Lines {
                items.push(sign(0.5 * (a + b), k, size, color));
            }
            items.push(words(DVec2::new(left + 2.6 * size, y + 0.35 * size), Align::Left, size, &series.name, color::INK));
        }
    }
}

impl Layout {
    /// A place of the page by its values.
    fn at(&self, unit: usize, x: f64, y: f64) -> DVec2 {
        let share = DVec2::new(self.x.share(x), 1.0 - self.y[unit].0.share(y));
        self.frame.min + share * self.frame.size()
    }
}

fn grid(layout: &Layout, items: &mut Vec<Item>) {
    let (frame, size) = (&layout.frame, layout.size);
    let color = |tick: f64| if tick == 0.0 { ZERO } else { GRID };
    for tick in layout.x.ticks() {
        let x = frame.min.x + layout.x.share(tick) * frame.size().x;
        items.push(stroke(vec![DVec2::new(x, frame.min.y), DVec2::new(x, frame.max.y)], 0.06 * size, color(tick)));
    }
    let Some((axis, _)) = layout.y.first() else { return };
    for tick in axis.ticks() {
        let y = frame.max.y - axis.share(tick) * frame.size().y;
        items.push(stroke(vec![DVec2::new(frame.min.x, y), DVec2::new(frame.max.x, y)], 0.06 * size, color(tick)));
    }
}

/// The line of the k-th series: those that repeat a colour are dashed.
fn drawn(points: &[DVec2], k: usize, size: f64, color: Rgb) -> Vec<Item> {
    let width = 0.14 * size;
    match k / COLORS.len() {
        0 => vec![stroke(points.to_vec(), width, color)],
        n => dashed(points, 1.2 * size / n as f64, 0.5 * size, width, color),
    }
}

/// The sign of the k-th series: disc, square, triangle, diamond.
fn sign(at: DVec2, k: usize, size: f64, color: Rgb) -> Item {
    let r = 0.28 * size;
    let corners: &[(f64, f64)] = match k % 4 {
        0 => return stroke(vec![at, at], 2.0 * r, color),
        1 => &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
        2 => &[(0.0, -1.2), (1.05, 0.7), (-1.05, 0.7)],
        _ => &[(0.0, -1.25), (1.25, 0.0), (0.0, 1.25), (-1.25, 0.0)],
    };
    Item::Fill { points: corners.iter().map(|c| at + DVec2::new(c.0, c.1) * r).collect(), color, opacity: 1.0 }
}

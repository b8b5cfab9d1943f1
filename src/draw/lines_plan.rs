//! Lines plans: a hull in profile, half-breadth plan and body plan on one sheet, at a round scale.
//!
//! ```text
//!   profile (sheer plan): edges, buttocks      body plan: sections, aft ones left, fore ones right
//!   half-breadth plan: edges, waterlines, below the centreline diagonals as long as they are
//!                                                                                     title block
//! ```

use glam::{DVec2, DVec3};

use super::annotate::number;
use super::camera::Rect;
use super::color::{self, Rgb};
use super::drawing::{Align, Page, Placed, dimension, stroke, words};
use super::font;
use super::page::Item;
use super::picture::Picture;
use super::plan_views::{self, Views};
use crate::base::math;
use crate::base::tolerance::WHOLE_NUMBER;

/// Millimetres of a pixel of a printed SVG picture: 96 pixels an inch.
const PIXEL: f64 = 25.4 / 96.0;
/// Room round the views in sizes of words: left, between profile and body plan, right.
const ACROSS: (f64, f64, f64) = (5.0, 8.5, 7.5);
/// Above, between profile and half-breadth plan, below.
const DOWN: (f64, f64, f64) = (4.2, 6.4, 3.2);
/// Height of the title block in sizes of words.
const BLOCK: f64 = 5.2;

/// How many times larger than the other views the body plan may be.
const BODY: [f64; 5] = [1.0, 2.0, 2.5, 5.0, 10.0];
/// Share of the room that the body plan gets across or down, where a smaller scale makes room for it.
const LEAST_BODY: f64 = 0.25;
/// How many scales are tried.
const SMALLER: u32 = 6;
/// What takes one scale to the next smaller one.
const NEXT: f64 = 1.01;

/// What a line of a plan is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// A free edge or a knuckle of the hull, or its profile.
    Edge,
    /// A section across the hull.
    Station,
    /// A level section.
    Waterline,
    /// A section along the hull, upright.
    Buttock,
    /// A section along the hull in a plane that is inclined; by its place in the list.
    Diagonal(usize),
}

impl Family {
    /// Its colour.
    pub fn color(self) -> Rgb {
        match self {
            Self::Edge => color::INK,
            Self::Station => Rgb(20, 74, 160),
            Self::Waterline => Rgb(0, 126, 92),
            Self::Buttock => Rgb(188, 84, 0),
            Self::Diagonal(_) => Rgb(150, 40, 150),
        }
    }
}

/// A line of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanLine {
    /// What it is.
    pub family: Family,
    /// Where its plane is along x, y or z, model units; of an edge and of a diagonal nothing.
    pub at: f64,
    /// Points along it, model units; y from the centre plane, below 0 only in a plan of both sides.
    pub points: Vec<DVec3>,
}

/// A plane along the hull, inclined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diagonal {
    /// Where it meets the centre plane, z in model units.
    pub height: f64,
    /// How far it falls towards the side, radians, between 0 and a right angle.
    pub angle: f64,
}

/// A hull by its lines.
#[derive(Clone, Debug, PartialEq)]
pub struct LinesPlan {
    /// All lines.
    pub lines: Vec<PlanLine>,
    /// x of the sections across, in order, model units.
    pub stations: Vec<f64>,
    /// z of the level sections.
    pub waterlines: Vec<f64>,
    /// Distances of the upright sections from the centre plane.
    pub buttocks: Vec<f64>,
    /// The inclined planes.
    pub diagonals: Vec<Diagonal>,
    /// Whether the bow is where x is large.
    pub bow_is_high: bool,
    /// Whether both sides are shown, as they differ: sections port left and starboard right, those aft of the middle dashed.
    pub both_sides: bool,
    /// Least and largest x and z, and the half beam as the largest y.
    pub low: DVec3,
    /// See `low`.
    pub high: DVec3,
    /// How far the hull reaches left and right of the centreline of the body plan, model units.
    pub reach: (f64, f64),
    /// Unit of lengths.
    pub unit: String,
    /// Millimetres of that unit.
    pub millimetres: f64,
}

impl LinesPlan {
    /// The x that parts fore from aft: halfway between the first and the last station.
    pub fn middle(&self) -> f64 {
        match (self.stations.first(), self.stations.last()) {
            (Some(a), Some(b)) if a != b => 0.5 * (a + b),
            _ => 0.5 * (self.low.x + self.high.x),
        }
    }

    /// Whether a section at x lies in the middle or ahead of it.
    pub(super) fn is_ahead(&self, x: f64) -> bool {
        if self.bow_is_high { x >= self.middle() } else { x <= self.middle() }
    }

    /// A coordinate with as many digits as tell it from its neighbours.
    pub(super) fn coordinate(&self, x: f64, of: &[f64]) -> String {
        let size = (self.high - self.low).max_element();
        let step = of.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|d| *d > 0.0).fold(size, f64::min);
        number(x, step.max(0.0001 * size))
    }

    /// How far below the centreline of the half-breadth plan the other side or diagonals reach, model units.
    fn reach_below(&self) -> f64 {
        if self.both_sides {
            return self.high.y;
        }
        let reach = |line: &PlanLine| match line.family {
            Family::Diagonal(k) => line.points.iter().map(|p| self.along_diagonal(k, *p)).fold(0.0, f64::max),
            _ => 0.0,
        };
        self.lines.iter().map(reach).fold(0.0, f64::max)
    }

    /// The distance of a point of the k-th diagonal from the centre plane, along the diagonal.
    pub(super) fn along_diagonal(&self, k: usize, p: DVec3) -> f64 {
        let d = &self.diagonals[k];
        DVec2::new(p.y, p.z - d.height).length()
    }

    /// The plan on a page.
    pub fn picture(&self, page: &Page) -> Picture {
        let (size, rect) = (page.words(), page.rect());
        let frame = rect.grown(-0.9 * size);
        let (views, scale) = self.views(&frame, size);
        let mut items = vec![outline(&frame, 0.14 * size)];
        let mut placed = Placed { halo: true, ..Placed::default() };
        plan_views::grid(self, &views, &mut items);
        plan_views::lines(self, &views, &mut items);
        self.dimensions(&views, &mut items);
        placed.taken.extend(items.iter().filter(|i| !i.words().is_empty()).map(Item::bounds));
        plan_views::names(self, &views, &mut placed);
        items.extend(placed.items);
        let title = page.title.clone().unwrap_or_else(|| page.name.clone());
        self.block(&frame, size, &title, &scale, &mut items);
        if page.legend {
            self.legend(&frame, size, &mut items);
        }
        Picture::flat(items, page.size, &title)
    }

    /// Where the views are, and the scale as words.
    fn views(&self, frame: &Rect, size: f64) -> (Views, String) {
        let extent = self.high - self.low;
        let half = self.high.y.max(0.0);
        let below = self.reach_below();
        let room = frame.size() - DVec2::new(ACROSS.0 + ACROSS.1 + ACROSS.2, DOWN.0 + DOWN.1 + DOWN.2 + BLOCK) * size;
        let whole = DVec2::new(extent.x + 2.0 * half, extent.z + half + below);
        let left_column = |ratio: f64| {
            let k = self.millimetres / (ratio * PIXEL);
            (k, DVec2::new(extent.x * k, (extent.z + half + below) * k))
        };
        let most = (room.max(0.3 * frame.size()) / whole.max(DVec2::splat(f64::MIN_POSITIVE))).min_element();
        // From the largest scale that all views fit in at down to that at which the body plan is not too small beside the others.
        let first = round_scale(self.millimetres / (most * PIXEL));
        let (mut found, mut ratio) = (None, first);
        for _ in 0..SMALLER {
            let (k, column) = left_column(ratio);
            let fits = |m: f64| column.x + 2.0 * half * k * m <= room.x && extent.z * k * m <= room.y;
            let is_large = |m: f64| 2.0 * half * k * m >= LEAST_BODY * room.x || extent.z * k * m >= LEAST_BODY * room.y;
            found = BODY.into_iter().find(|m| fits(*m) && is_large(*m)).map(|m| (ratio, m));
            if found.is_some() {
                break;
            }
            ratio = round_scale(ratio * NEXT);
        }
        let (ratio, times) = found.unwrap_or((first, 1.0));
        let (pixels, column) = left_column(ratio);
        let written =
            |ratio: f64| if ratio >= 1.0 { format!("1 : {}", number(ratio, 0.5)) } else { format!("{} : 1", number(1.0 / ratio, 0.5)) };
        let scale = if times > 1.0 { format!("{}, body plan {}", written(ratio), written(ratio / times)) } else { written(ratio) };
        let body_pixels = pixels * times;
        let used = DVec2::new(column.x + 2.0 * half * body_pixels, column.y.max(extent.z * body_pixels));
        let free = (room - used).max(DVec2::ZERO) * 0.5;
        let left = frame.min.x + ACROSS.0 * size + free.x;
        let top = frame.min.y + DOWN.0 * size + free.y;
        let base = top + extent.z * pixels;
        let views = Views {
            pixels,
            size,
            left,
            base,
            center: base + DOWN.1 * size + half * pixels,
            middle: left + extent.x * pixels + ACROSS.1 * size + half * body_pixels,
            below,
            body_pixels,
            body_base: top + extent.z * body_pixels,
            half,
            low: self.low,
            high: self.high,
            bow_is_high: self.bow_is_high,
        };
        (views, scale)
    }

    /// Length, beam and depth.
    fn dimensions(&self, views: &Views, items: &mut Vec<Item>) {
        let (size, extent) = (views.size, self.high - self.low);
        let written = |x: f64| format!("{} {}", number(x, 0.001 * extent.max_element()), self.unit);
        let right = views.left + extent.x * views.pixels;
        let y = views.base + 3.6 * size;
        items.extend(dimension(DVec2::new(views.left, y), DVec2::new(right, y), size, &format!("length {}", written(extent.x))));
        let top = views.base - extent.z * views.pixels;
        let y = top - 2.0 * size;
        let (left, reach) = (self.reach.0 * views.body_pixels, self.reach.1 * views.body_pixels);
        let (a, b) = (DVec2::new(views.middle - left, y), DVec2::new(views.middle + reach, y));
        items.extend(dimension(a, b, size, &format!("beam {}", written(self.reach.0 + self.reach.1))));
        let x = views.middle + reach + 1.6 * size;
        let depth = dimension(DVec2::new(x, top), DVec2::new(x, views.body_base), size, &written(extent.z));
        items.extend(depth);
        let ends = [
            (DVec2::new(views.left, views.base), DVec2::new(views.left, views.base + 4.0 * size)),
            (DVec2::new(right, views.base), DVec2::new(right, views.base + 4.0 * size)),
            (a, DVec2::new(a.x, top)),
            (b, DVec2::new(b.x, top)),
            (DVec2::new(views.middle + reach, top), DVec2::new(x + 0.4 * size, top)),
            (DVec2::new(views.middle + reach, views.body_base), DVec2::new(x + 0.4 * size, views.body_base)),
        ];
        items.extend(ends.into_iter().map(|(from, to)| stroke(vec![from, to], 0.05 * size, color::GREY)));
    }

    /// The title block in the lower right corner.
    fn block(&self, frame: &Rect, size: f64, title: &str, scale: &str, items: &mut Vec<Item>) {
        let extent = self.high - self.low;
        let written = |x: f64| number(x, 0.001 * extent.max_element());
        let cells = [
            ("scale", scale.to_owned()),
            ("unit", self.unit.clone()),
            ("length × beam × depth", format!("{} × {} × {}", written(extent.x), written(self.reach.0 + self.reach.1), written(extent.z))),
        ];
        let width = |text: &str| font::width(text, size) + 1.6 * size;
        let widths: Vec<f64> = cells.iter().map(|(head, text)| width(text).max(width(head) * 0.8)).collect();
        let own = widths.iter().sum::<f64>().max(width(title) * 1.2).min(frame.size().x);
        let stretch = own / widths.iter().sum::<f64>();
        let block = Rect::new(frame.max - DVec2::new(own, BLOCK * size), frame.max);
        items.push(outline(&block, 0.1 * size));
        let line = block.min.y + 2.3 * size;
        items.push(stroke(vec![DVec2::new(block.min.x, line), DVec2::new(block.max.x, line)], 0.08 * size, color::INK));
        items.push(words(DVec2::new(block.min.x + 0.8 * size, block.min.y + 1.6 * size), Align::Left, 1.2 * size, title, color::INK));
        let mut x = block.min.x;
        for ((head, text), width) in cells.iter().zip(&widths) {
            if x > block.min.x {
                items.push(stroke(vec![DVec2::new(x, line), DVec2::new(x, block.max.y)], 0.08 * size, color::INK));
            }
            items.push(words(DVec2::new(x + 0.8 * size, line + size), Align::Left, 0.75 * size, head, color::GREY));
            items.push(words(DVec2::new(x + 0.8 * size, line + 2.3 * size), Align::Left, size, text, color::INK));
            x += width * stretch;
        }
    }

    /// Colours of the families in the lower left corner.
    fn legend(&self, frame: &Rect, size: f64, items: &mut Vec<Item>) {
        let families = [
            ("edges", Family::Edge, true),
            ("sections", Family::Station, !self.stations.is_empty()),
            ("waterlines", Family::Waterline, !self.waterlines.is_empty()),
            ("buttocks", Family::Buttock, !self.buttocks.is_empty()),
            ("diagonals", Family::Diagonal(0), !self.diagonals.is_empty()),
        ];
        let mut x = frame.min.x + size;
        let y = frame.max.y - 1.1 * size;
        for (name, family, _) in families.into_iter().filter(|f| f.2) {
            items.push(stroke(vec![DVec2::new(x, y), DVec2::new(x + 1.6 * size, y)], plan_views::width(family) * size, family.color()));
            items.push(words(DVec2::new(x + 2.1 * size, y + 0.35 * size), Align::Left, size, name, color::INK));
            x += 3.4 * size + font::width(name, size);
        }
    }
}

fn outline(rect: &Rect, width: f64) -> Item {
    let corners = [rect.min, DVec2::new(rect.max.x, rect.min.y), rect.max, DVec2::new(rect.min.x, rect.max.y), rect.min];
    stroke(corners.to_vec(), width, color::INK)
}

/// The least of 1, 1.5, 2, 2.5, 3, 4, 5, 7.5 times a power of ten that is not below `least`.
fn round_scale(least: f64) -> f64 {
    let power = math::powi(10.0, math::log10(least).floor() as i32);
    let all = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 7.5, 10.0].map(|k| k * power);
    all.into_iter().find(|x| *x >= least * (1.0 - WHOLE_NUMBER)).unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_round() {
        for (least, scale) in [(1.0, 1.0), (1.1, 1.5), (2.2, 2.5), (310.0, 400.0), (0.3, 0.3), (999.0, 1000.0)] {
            assert!((round_scale(least) / scale - 1.0).abs() < WHOLE_NUMBER, "{least}: {}", round_scale(least));
        }
    }
}

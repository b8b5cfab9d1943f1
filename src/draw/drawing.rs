//! Drawings: flat figures on a page of their own, and the pieces that they are put together from.

use glam::DVec2;

use super::camera::Rect;
use super::color::{self, Rgb};
use super::font;
use super::lines_plan::LinesPlan;
use super::page::{Item, text_bounds};
use super::picture::Picture;
use super::plot::Plot;

/// The shorter side of a page over the size of words.
const SHARE: f64 = 50.0;
/// Smallest and largest size of words, pixels.
const SIZES: (f64, f64) = (9.0, 64.0);

/// A flat figure that fills a page by itself.
#[derive(Clone, Debug, PartialEq)]
pub enum Drawing {
    /// Columns of a table over another one.
    Plot(Plot),
    /// A hull in three views with its sections.
    LinesPlan(LinesPlan),
}

/// The page that a drawing is put on.
#[derive(Clone, Debug, PartialEq)]
pub struct Page {
    /// Pixels across and down.
    pub size: (usize, usize),
    /// Words above it; `None` for those that the drawing has itself.
    pub title: Option<String>,
    /// The name that the drawing has where nothing else names it.
    pub name: String,
    /// Colours and signs are explained.
    pub legend: bool,
}

impl Page {
    /// Its size in pixels.
    pub(super) fn rect(&self) -> Rect {
        Rect::new(DVec2::ZERO, DVec2::new(self.size.0 as f64, self.size.1 as f64))
    }

    /// Size of words, pixels.
    pub(super) fn words(&self) -> f64 {
        (self.size.0.min(self.size.1) as f64 / SHARE).clamp(SIZES.0, SIZES.1)
    }
}

impl Drawing {
    /// What the drawing is, in words.
    pub fn words(&self) -> &'static str {
        match self {
            Self::Plot(_) => "a plot",
            Self::LinesPlan(_) => "a lines plan",
        }
    }

    /// The drawing on a page.
    pub fn picture(&self, page: &Page) -> Picture {
        match self {
            Self::Plot(plot) => plot.picture(page),
            Self::LinesPlan(plan) => plan.picture(page),
        }
    }
}

/// A line through points.
pub(super) fn stroke(points: Vec<DVec2>, width: f64, color: Rgb) -> Item {
    Item::Stroke { points, width, color }
}

/// Where words stand from a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Align {
    Left,
    Middle,
    Right,
}

/// Words on a line through a place.
pub(super) fn words(at: DVec2, align: Align, size: f64, text: &str, color: Rgb) -> Item {
    let width = font::width(text, size);
    let left = match align {
        Align::Left => 0.0,
        Align::Middle => 0.5 * width,
        Align::Right => width,
    };
    Item::Text { at: at - DVec2::new(left, 0.0), size, text: text.to_owned(), color, halo: false }
}

/// A line in dashes; `on` and `off` are pixels along it.
pub(super) fn dashed(points: &[DVec2], on: f64, off: f64, width: f64, color: Rgb) -> Vec<Item> {
    let (mut out, mut own) = (Vec::new(), Vec::new());
    let (mut drawn, mut left) = (true, on);
    for pair in points.windows(2) {
        let (a, length) = (pair[0], pair[0].distance(pair[1]));
        let mut s = 0.0;
        while length - s > left {
            s += left;
            let at = a.lerp(pair[1], s / length);
            if drawn {
                if own.is_empty() {
                    own.push(a);
                }
                own.push(at);
                out.push(stroke(std::mem::take(&mut own), width, color));
            } else {
                own.push(at);
            }
            drawn = !drawn;
            left = if drawn { on } else { off };
        }
        left -= length - s;
        if drawn {
            if own.is_empty() {
                own.push(a);
            }
            own.push(pair[1]);
        }
    }
    if own.len() > 1 {
        out.push(stroke(own, width, color));
    }
    out
}

/// Words that were placed, and the room of everything that later ones must not cover.
#[derive(Default)]
pub(super) struct Placed {
    pub items: Vec<Item>,
    pub taken: Vec<Rect>,
    /// Whether a white rim makes them readable over lines.
    pub halo: bool,
}

impl Placed {
    /// Puts words at the first of some places where they cover nothing; `false` where there is none.
    pub fn put(&mut self, places: &[(DVec2, Align)], size: f64, text: &str, color: Rgb) -> bool {
        for (at, align) in places {
            let mut item = words(*at, *align, size, text, color);
            let Item::Text { at: left, halo, .. } = &mut item else { return false };
            *halo = self.halo;
            let room = text_bounds(*left, size, text);
            if !self.taken.iter().any(|r| r.meets(&room)) {
                self.taken.push(room);
                self.items.push(item);
                return true;
            }
        }
        false
    }
}

/// A line that measures a distance on the page, with arrowheads at both ends and words in its middle.
pub(super) fn dimension(a: DVec2, b: DVec2, size: f64, text: &str) -> Vec<Item> {
    let along = (b - a).normalize_or(DVec2::X);
    let across = DVec2::new(-along.y, along.x);
    let head = |tip: DVec2, way: DVec2| Item::Fill {
        points: vec![tip, tip + way * 0.8 * size + across * 0.16 * size, tip + way * 0.8 * size - across * 0.16 * size],
        color: color::INK,
        opacity: 1.0,
    };
    let middle = 0.5 * (a + b);
    let level = along.y.abs() < 0.5;
    let text = if level {
        words(middle - DVec2::new(0.0, 0.35 * size), Align::Middle, size, text, color::INK)
    } else {
        words(middle + DVec2::new(0.45 * size, 0.35 * size), Align::Left, size, text, color::INK)
    };
    vec![stroke(vec![a, b], 0.06 * size, color::INK), head(a, along), head(b, -along), text]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_cover_their_share_of_a_line() {
        let line = [DVec2::ZERO, DVec2::new(10.0, 0.0), DVec2::new(10.0, 10.0)];
        let parts = dashed(&line, 3.0, 1.0, 1.0, color::INK);
        let length = |item: &Item| match item {
            Item::Stroke { points, .. } => points.windows(2).map(|w| w[0].distance(w[1])).sum(),
            _ => 0.0,
        };
        assert_eq!(parts.len(), 5);
        assert!((parts.iter().map(length).sum::<f64>() - 15.0).abs() < crate::base::tolerance::FRAME);
    }

    #[test]
    fn words_never_cover_each_other() {
        let mut placed = Placed::default();
        let at = |x: f64| [(DVec2::new(x, 0.0), Align::Left)];
        assert!(placed.put(&at(0.0), 10.0, "station", color::INK));
        assert!(!placed.put(&at(5.0), 10.0, "station", color::INK));
        assert!(placed.put(&[at(5.0)[0], at(100.0)[0]], 10.0, "station", color::INK));
        assert_eq!(placed.items.len(), 2);
    }
}

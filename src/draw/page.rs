//! What stands on the picture rather than in space: strokes, filled shapes and words; and how they become pixels.

use glam::DVec2;

use super::camera::Rect;
use super::color::{Rgb, WHITE};
use super::font;
use super::raster::Image;

/// Width of the strokes of letters as a share of their size.
pub const LETTER: f64 = 0.1;
/// Width of the halo around letters as a share of their size.
pub const HALO: f64 = 0.40;
/// Places along each side of a pixel where a filled shape is asked for.
const PLACES: usize = 4;

/// A thing on the picture, pixels from its upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// A line with round ends.
    Stroke {
        /// Points along it.
        points: Vec<DVec2>,
        /// Its width.
        width: f64,
        /// Its colour.
        color: Rgb,
    },
    /// A filled shape.
    Fill {
        /// Its corners.
        points: Vec<DVec2>,
        /// Its colour.
        color: Rgb,
        /// How much of what is below it hides, 0…1.
        opacity: f64,
    },
    /// Words.
    Text {
        /// Left end of the line they stand on.
        at: DVec2,
        /// Height of an em.
        size: f64,
        /// The words.
        text: String,
        /// Their colour.
        color: Rgb,
        /// A white rim makes them readable over lines.
        halo: bool,
    },
}

impl Item {
    /// A filled rectangle.
    pub fn rect(rect: &Rect, color: Rgb, opacity: f64) -> Self {
        let (a, b) = (rect.min, rect.max);
        Self::Fill { points: vec![a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y)], color, opacity }
    }

    /// Moved on the page.
    pub(super) fn moved(mut self, by: DVec2) -> Self {
        match &mut self {
            Self::Stroke { points, .. } | Self::Fill { points, .. } => points.iter_mut().for_each(|p| *p += by),
            Self::Text { at, .. } => *at += by,
        }
        self
    }

    /// Its words; none of a shape.
    pub fn words(&self) -> &str {
        match self {
            Self::Text { text, .. } => text,
            _ => "",
        }
    }

    /// The room it takes.
    pub fn bounds(&self) -> Rect {
        let around = |points: &[DVec2], by: f64| {
            let low = points.iter().copied().fold(DVec2::INFINITY, DVec2::min);
            let high = points.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
            Rect::new(low, high).grown(by)
        };
        match self {
            Self::Stroke { points, width, .. } => around(points, 0.5 * width),
            Self::Fill { points, .. } => around(points, 0.0),
            Self::Text { at, size, text, .. } => text_bounds(*at, *size, text),
        }
    }
}

/// The room that words take, accents and descenders included.
pub fn text_bounds(at: DVec2, size: f64, text: &str) -> Rect {
    let width = font::width(text, size);
    Rect::new(at - DVec2::new(0.0, (font::CAPITAL + 0.1) * size), at + DVec2::new(width, font::DESCENT * size))
}

/// Paints items over an image, in order.
pub fn paint(image: &mut Image, items: &[Item]) {
    for item in items {
        match item {
            Item::Stroke { points, width, color } => stroke(image, std::slice::from_ref(points), 0.5 * width, *color),
            Item::Fill { points, color, opacity } => fill(image, points, *color, *opacity),
            Item::Text { at, size, text, color, halo } => {
                let strokes = font::strokes(text, *at, *size);
                if *halo {
                    stroke(image, &strokes, 0.5 * HALO * size, WHITE);
                }
                stroke(image, &strokes, 0.5 * LETTER * size, *color);
            }
        }
    }
}

/// Columns and rows of pixels around a rectangle, inside the image.
fn pixels(image: &Image, around: &Rect) -> (std::ops::Range<usize>, std::ops::Range<usize>) {
    let range = |low: f64, high: f64, n: usize| {
        let first = low.floor().clamp(0.0, n as f64) as usize;
        first..(high.ceil().clamp(0.0, n as f64) as usize).max(first)
    };
    (range(around.min.x, around.max.x, image.width), range(around.min.y, around.max.y, image.height))
}

fn blend(image: &mut Image, column: usize, row: usize, color: Rgb, share: f64) {
    let at = 3 * (row * image.width + column);
    for (old, new) in image.rgb[at..at + 3].iter_mut().zip([color.0, color.1, color.2]) {
        *old = (f64::from(*old) + (f64::from(new) - f64::from(*old)) * share + 0.5) as u8;
    }
}

/// Several lines as one shape, so that crossings are not darker.
fn stroke(image: &mut Image, lines: &[Vec<DVec2>], half: f64, color: Rgb) {
    let all = lines.iter().flatten().copied();
    let (low, high) = all.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
    if !(low.is_finite() && high.is_finite()) {
        return;
    }
    let (columns, rows) = pixels(image, &Rect::new(low, high).grown(half + 1.0));
    let width = columns.len();
    let mut covered = vec![0.0_f32; width * rows.len()];
    for line in lines {
        let pairs = line.windows(2).map(|w| (w[0], w[1])).chain((line.len() == 1).then(|| (line[0], line[0])));
        for (a, b) in pairs {
            let (own_columns, own_rows) = pixels(image, &Rect::new(a.min(b), a.max(b)).grown(half + 1.0));
            let (along, length2) = (b - a, a.distance_squared(b));
            for row in own_rows {
                for column in own_columns.clone() {
                    let from = DVec2::new(column as f64 + 0.5, row as f64 + 0.5) - a;
                    let t = if length2 > 0.0 { (from.dot(along) / length2).clamp(0.0, 1.0) } else { 0.0 };
                    let share = (half + 0.5 - (from - along * t).length()).clamp(0.0, (2.0 * half).min(1.0)) as f32;
                    let place = &mut covered[(row - rows.start) * width + column - columns.start];
                    *place = place.max(share);
                }
            }
        }
    }
    for (k, share) in covered.iter().enumerate().filter(|(_, share)| **share > 0.0) {
        blend(image, columns.start + k % width, rows.start + k / width, color, f64::from(*share));
    }
}

fn fill(image: &mut Image, points: &[DVec2], color: Rgb, opacity: f64) {
    let bounds = Item::Fill { points: points.to_vec(), color, opacity }.bounds();
    let (columns, rows) = pixels(image, &bounds);
    let inside = |p: DVec2| {
        let sides = points.iter().zip(points.iter().cycle().skip(1));
        let crosses = |(a, b): &(&DVec2, &DVec2)| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
        sides.filter(crosses).count() % 2 == 1
    };
    for row in rows {
        for column in columns.clone() {
            let place = |k: usize| {
                let (i, j) = ((k % PLACES) as f64 + 0.5, (k / PLACES) as f64 + 0.5);
                DVec2::new(column as f64 + i / PLACES as f64, row as f64 + j / PLACES as f64)
            };
            let hits = (0..PLACES * PLACES).filter(|k| inside(place(*k))).count();
            if hits > 0 {
                blend(image, column, row, color, opacity * hits as f64 / (PLACES * PLACES) as f64);
            }
        }
    }
}

//! The page around the model: its layout, and title, axes and ruler.

use glam::{DVec2, DVec3};

use super::camera::{Camera, Rect};
use super::color::{self, Rgb};
use super::font;
use super::label_places;
use super::legend;
use super::page::Item;
use super::picture::{Format, MARK_LIFT, Settings};
use super::raster::Image;
use super::scene::Scene;
use crate::base::math;
use crate::base::text::real;

/// Size of words in a picture of 800 pixels.
pub(super) const SIZE: f64 = 16.0;
/// The shorter side of the picture over the size of words.
const SHARE: f64 = 50.0;
/// Smallest and largest size of words.
const SIZES: (f64, f64) = (9.0, 64.0);
/// Least share of the page that the model gets; where words would leave less they give way.
const MODEL: f64 = 0.45;

/// Where things stand on the page.
#[derive(Clone, Debug)]
pub struct Layout {
    /// Size of words, pixels.
    pub size: f64,
    /// Widths of lines are multiplied by this.
    pub line: f64,
    /// Where the model is.
    pub frame: Rect,
    pub(super) page: Rect,
    pub(super) margin: f64,
    title: String,
    unit: String,
    axes: bool,
    ruler: bool,
    legend: bool,
}

/// Outer and inner radius of a mark.
pub fn mark_radius(node: bool, size: f64) -> (f64, f64) {
    if node { (0.30 * size, 0.18 * size) } else { (0.22 * size, 0.0) }
}

/// Size of words, pixels.
pub(super) fn size_of_words(settings: &Settings) -> f64 {
    (settings.width.min(settings.height) as f64 / SHARE).clamp(SIZES.0, SIZES.1)
}

impl Layout {
    /// Shares the page out.
    pub fn new(scene: &Scene, settings: &Settings) -> Self {
        let page = Rect::new(DVec2::ZERO, DVec2::new(settings.width as f64, settings.height as f64));
        let size = size_of_words(settings);
        let margin = 1.1 * size;
        let mut layout = Self {
            size,
            line: size / SIZE,
            frame: page,
            page,
            margin,
            title: settings.title.clone(),
            unit: settings.unit.clone(),
            axes: settings.axes,
            ruler: settings.ruler,
            legend: settings.legend,
        };
        let mut frame = page.grown(-1.6 * margin);
        if !layout.title.is_empty() {
            frame.min.y += 1.6 * size;
        }
        if layout.axes || layout.ruler {
            frame.max.y -= 2.6 * size;
        }
        if layout.legend {
            frame.max.x -= legend::width(scene, size);
        }
        let room = frame.size() / page.size();
        if room.min_element() < MODEL {
            // Too small a page for words beside the model.
            (layout.title, layout.axes, layout.ruler, layout.legend) = (String::new(), false, false, false);
            frame = page.grown(-0.06 * page.max.min_element());
        }
        layout.frame = frame;
        layout
    }

    pub(super) fn text(&self, at: DVec2, words: &str, color: Rgb) -> Item {
        Item::Text { at, size: self.size, text: words.to_owned(), color, halo: true }
    }
}

/// A number with as many digits as tell neighbours of a step apart.
pub(super) fn number(x: f64, step: f64) -> String {
    let scale = step.abs().max(f64::MIN_POSITIVE);
    let digits = (1.0 - math::log10(scale).floor()).clamp(0.0, 12.0) as usize;
    let whole = math::log10(x.abs().max(scale));
    if !(-5.0..7.0).contains(&whole) {
        return format!("{x:.3e}").parse().map_or_else(|_| format!("{x:.3e}"), real);
    }
    let text = format!("{x:.digits$}");
    let short = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if short == "-0" { "0".to_owned() } else { short.to_owned() }
}

/// The largest of 1, 2, 5 times a power of ten that is not above `most`.
fn round_length(most: f64) -> f64 {
    let power = math::powi(10.0, math::log10(most).floor() as i32);
    [5.0, 2.0, 1.0].into_iter().map(|k| k * power).find(|x| *x <= most).unwrap_or(power)
}

/// Everything that stands over the picture.
pub fn items(scene: &Scene, camera: &Camera, image: &Image, layout: &Layout, dense: bool, format: Format) -> Vec<Item> {
    let mut items = Vec::new();
    if !layout.title.is_empty() {
        let (size, room) = (1.3 * layout.size, layout.page.max.x - 2.0 * layout.margin);
        let at = DVec2::new(layout.margin, layout.margin + font::CAPITAL * size);
        items.push(Item::Text { at, size, text: fitting(&layout.title, size, room), color: color::INK, halo: true });
    }
    let mut notes = Vec::new();
    if dense {
        notes.push("element edges too dense to draw".to_owned());
    }
    let mut foot = layout.margin;
    if layout.axes {
        items.extend(axes(camera, layout));
        foot += 5.6 * layout.size;
    }
    if layout.ruler && camera.has_one_scale() {
        let (ruler, end) = ruler(camera, layout, foot);
        items.extend(ruler);
        foot = end;
    }
    if layout.legend {
        items.extend(legend::items(scene, layout));
    }
    if format == Format::Svg {
        items.extend(marks(scene, camera, image, layout));
    }
    let occupied: Vec<Rect> = items.iter().map(Item::bounds).collect();
    let (names, left_out) = label_places::items(scene, camera, image, layout, occupied);
    items.extend(names);
    if left_out > 0 {
        notes.push(format!("{left_out} name{} without room", if left_out == 1 { "" } else { "s" }));
    }
    if !notes.is_empty() && (layout.axes || layout.ruler) {
        let room = layout.page.max.x - layout.margin - foot;
        let words = fitting(&notes.join(", "), 0.85 * layout.size, room);
        let width = font::width(&words, 0.85 * layout.size);
        let at = DVec2::new(layout.page.max.x - layout.margin - width, layout.page.max.y - layout.margin);
        items.push(Item::Text { at, size: 0.85 * layout.size, text: words, color: color::GREY, halo: true });
    }
    items
}

/// The words, or their beginning with `…` where there is no room for all.
pub(super) fn fitting(words: &str, size: f64, room: f64) -> String {
    if font::width(words, size) <= room {
        return words.to_owned();
    }
    let mut short = String::new();
    for c in words.chars() {
        let next = format!("{short}{c}…");
        if font::width(&next, size) > room {
            break;
        }
        short.push(c);
    }
    if short.is_empty() { short } else { format!("{}…", short.trim_end()) }
}

/// Arrows along x, y and z in the lower left corner, the farthest first.
fn axes(camera: &Camera, layout: &Layout) -> Vec<Item> {
    let size = layout.size;
    let origin = DVec2::new(layout.margin + 2.4 * size, layout.page.max.y - layout.margin - 2.2 * size);
    let mut axes = [(DVec3::X, "x", Rgb(196, 30, 30)), (DVec3::Y, "y", Rgb(24, 128, 44)), (DVec3::Z, "z", Rgb(30, 70, 190))];
    axes.sort_by(|a, b| a.0.dot(camera.back).total_cmp(&b.0.dot(camera.back)));
    let mut items = Vec::new();
    for (axis, name, color) in axes {
        let way = DVec2::new(axis.dot(camera.right), -axis.dot(camera.up));
        let tip = origin + way * 1.7 * size;
        items.push(Item::Stroke { points: vec![origin, tip], width: 0.14 * size, color });
        // An axis towards the eye has no direction on the page; its name would stand on the others.
        if way.length() > 0.2 {
            let middle = tip + way.normalize() * 0.55 * size;
            let width = font::width(name, 0.95 * size);
            let at = middle + DVec2::new(-0.5 * width, 0.25 * size);
            items.push(Item::Text { at, size: 0.95 * size, text: name.to_owned(), color, halo: true });
        }
    }
    items
}

/// A bar of a round length with its words; and where it ends.
fn ruler(camera: &Camera, layout: &Layout, left: f64) -> (Vec<Item>, f64) {
    let size = layout.size;
    let length = round_length(0.22 * layout.page.size().x / camera.scale);
    let (width, y) = (length * camera.scale, layout.page.max.y - layout.margin - 0.2 * size);
    let points = [(0.0, -0.4), (0.0, 0.0), (width, 0.0), (width, -0.4)].map(|(x, up)| DVec2::new(left + x, y + up * size));
    let words = format!("{} {}", number(length, length), layout.unit);
    let at = DVec2::new(left + 0.5 * (width - font::width(&words, size)), y - 0.5 * size);
    let at = DVec2::new(at.x.max(left), at.y);
    let end = left + width.max(font::width(&words, size)) + 2.0 * size;
    (vec![Item::Stroke { points: points.to_vec(), width: 0.12 * size, color: color::INK }, layout.text(at, &words, color::INK)], end)
}

/// Marks as shapes, for a vector picture.
fn marks(scene: &Scene, camera: &Camera, image: &Image, layout: &Layout) -> Vec<Item> {
    let mut items = Vec::new();
    for mark in &scene.marks {
        let spot = camera.project(mark.at);
        if image.hides(&spot, MARK_LIFT) {
            continue;
        }
        let (rim, inner) = mark_radius(mark.node, layout.size);
        items.push(Item::Stroke { points: vec![spot.at(), spot.at()], width: 2.0 * rim, color: color::INK });
        if inner > 0.0 {
            items.push(Item::Stroke { points: vec![spot.at(), spot.at()], width: 2.0 * inner, color: color::WHITE });
        }
    }
    items
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_tell_steps_apart() {
        assert_eq!(number(0.25, 0.25), "0.25");
        assert_eq!(number(0.0, 0.25), "0");
        assert_eq!(number(1234.0, 500.0), "1234");
        assert_eq!(number(5.0, 5.0), "5");
        assert_eq!(number(-0.0001, 0.25), "0");
        assert_eq!(number(2e9, 1e9), "2000000000");
        assert_eq!(number(2e-9, 1e-9), "2e-9");
    }

    #[test]
    fn rulers_are_round() {
        for (most, length) in [(1.0, 1.0), (1.9, 1.0), (2.0, 2.0), (4.99, 2.0), (7.0, 5.0), (0.03, 0.02), (12345.0, 10000.0)] {
            assert!((round_length(most) - length).abs() < 1e-9 * length, "{most}: {}", round_length(most));
        }
    }

    #[test]
    fn long_words_are_cut() {
        assert_eq!(fitting("roof", 10.0, 1000.0), "roof");
        let short = fitting("a very long title", 10.0, 40.0);
        assert!(short.ends_with('…') && font::width(&short, 10.0) <= 40.0);
        assert_eq!(fitting("roof", 10.0, 1.0), "");
    }
}

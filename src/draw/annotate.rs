//! Words and signs around the model: title, axes, ruler, legend; and names beside what they name, none over another.

use glam::{DVec2, DVec3};

use super::camera::{Camera, Rect, Spot};
use super::color::{self, Rgb};
use super::font;
use super::page::{Item, text_bounds};
use super::picture::{Format, MARK_LIFT, Settings};
use super::raster::Image;
use super::scene::{Kind, Label, Paint, Scale, Scene};
use crate::base::math;
use crate::base::text::real;

/// Size of words in a picture of 800 pixels.
pub(super) const SIZE: f64 = 16.0;
/// The shorter side of the picture over the size of words.
const SHARE: f64 = 50.0;
/// Smallest and largest size of words.
const SIZES: (f64, f64) = (9.0, 64.0);
/// Names that a picture can hold.
const NAMES: usize = 400;
/// Keys of faces that a legend lists.
const KEYS: usize = 12;
/// Numbers along a scale.
const TICKS: usize = 5;
/// Pixels of a cell in which it is known whether a line is seen.
const CELL: usize = 3;
/// How much nearer than its place a name counts: its own mark does not hide it.
const NAME_LIFT: f64 = MARK_LIFT + 4.0;
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
    page: Rect,
    margin: f64,
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

/// A sign and its words in the legend.
enum Key {
    Line(Kind),
    Face(Rgb),
    More,
}

fn keys(scene: &Scene) -> Vec<(Key, String)> {
    let mut keys: Vec<(Key, String)> = Vec::new();
    if scene.sheets.iter().any(|s| matches!(s.paint, Paint::Sides(..))) {
        keys.push((Key::Face(color::FRONT), "normal side".to_owned()));
        keys.push((Key::Face(color::BACK), "other side".to_owned()));
    }
    keys.extend(scene.keys.iter().take(KEYS).map(|(color, words)| (Key::Face(*color), words.clone())));
    if scene.keys.len() > KEYS {
        keys.push((Key::More, format!("and {} more", scene.keys.len() - KEYS)));
    }
    let drawn = |kind: &Kind| kind.is_explained() && scene.lines.iter().any(|l| l.kind == *kind);
    keys.extend(Kind::ALL.into_iter().filter(drawn).map(|kind| (Key::Line(kind), kind.words().to_owned())));
    keys
}

impl Layout {
    /// Shares the page out.
    pub fn new(scene: &Scene, settings: &Settings) -> Self {
        let page = Rect::new(DVec2::ZERO, DVec2::new(settings.width as f64, settings.height as f64));
        let size = (page.max.min_element() / SHARE).clamp(SIZES.0, SIZES.1);
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
            frame.max.x -= layout.legend_width(scene);
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

    fn legend_width(&self, scene: &Scene) -> f64 {
        let widest = |words: &mut dyn Iterator<Item = String>| words.map(|w| font::width(&w, self.size)).fold(0.0, f64::max);
        let of_keys = widest(&mut keys(scene).into_iter().map(|k| k.1));
        let of_scale = scene.scale.as_ref().map_or(0.0, |scale| widest(&mut ticks(scale).into_iter().map(|t| t.1).chain([title(scale)])));
        let room: f64 = of_keys.max(of_scale);
        if room > 0.0 { room + 2.4 * self.size } else { 0.0 }
    }

    fn text(&self, at: DVec2, words: &str, color: Rgb) -> Item {
        Item::Text { at, size: self.size, text: words.to_owned(), color, halo: true }
    }
}

fn title(scale: &Scale) -> String {
    if scale.unit.is_empty() { scale.title.clone() } else { format!("{} [{}]", scale.title, scale.unit) }
}

/// A number with as many digits as tell neighbours of a step apart.
fn number(x: f64, step: f64) -> String {
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

/// Shares of a scale and the numbers there.
fn ticks(scale: &Scale) -> Vec<(f64, String)> {
    let step = (scale.high - scale.low) / (TICKS - 1) as f64;
    let at = |k: usize| k as f64 / (TICKS - 1) as f64;
    (0..TICKS).map(|k| (at(k), number(scale.low + step * k as f64, step))).collect()
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
        items.extend(legend(scene, layout));
    }
    if format == Format::Svg {
        items.extend(marks(scene, camera, image, layout));
    }
    let taken: Vec<Rect> = items.iter().map(Item::bounds).collect();
    let (names, left_out) = names(scene, camera, image, layout, taken);
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
fn fitting(words: &str, size: f64, room: f64) -> String {
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

/// Right of the model: the scale of values, then signs and words.
fn legend(scene: &Scene, layout: &Layout) -> Vec<Item> {
    let (size, mut items) = (layout.size, Vec::new());
    let left = layout.page.max.x - layout.margin - layout.legend_width(scene) + 0.4 * size;
    let mut y = layout.frame.min.y;
    if !scene.focus.is_empty() && layout.frame.max.x < layout.page.max.x - 3.0 * layout.margin {
        // The model goes on under the legend.
        let rows = keys(scene).len() as f64 * 1.5 * size;
        let bar = if scene.scale.is_some() { (0.42 * layout.page.size().y).min(16.0 * size) + 3.4 * size } else { 0.0 };
        let low = DVec2::new(left - 0.6 * size, y - 1.1 * size);
        items.push(Item::rect(
            &Rect::new(low, DVec2::new(layout.page.max.x - 0.4 * layout.margin, y + rows + bar - 0.4 * size)),
            color::WHITE,
            0.85,
        ));
    }
    if let Some(scale) = &scene.scale {
        items.push(layout.text(DVec2::new(left, y + 0.2 * size), &title(scale), color::INK));
        y += 1.2 * size;
        let height = (0.42 * layout.page.size().y).min(16.0 * size);
        let steps = (height.ceil() as usize).clamp(2, 128);
        for k in 0..steps {
            let share = |k: usize| y + height * k as f64 / steps as f64;
            let color = scale.ramp.at(1.0 - (k as f64 + 0.5) / steps as f64);
            // Each reaches under the next one, so that no paper shows between them.
            let low = if k + 1 < steps { share(k + 2) } else { share(k + 1) };
            items.push(Item::rect(&Rect::new(DVec2::new(left, share(k)), DVec2::new(left + 1.1 * size, low)), color, 1.0));
        }
        for (share, words) in ticks(scale) {
            let at = y + height * (1.0 - share);
            let tick = [DVec2::new(left + 1.1 * size, at), DVec2::new(left + 1.4 * size, at)];
            items.push(Item::Stroke { points: tick.to_vec(), width: 0.08 * size, color: color::INK });
            items.push(layout.text(DVec2::new(left + 1.6 * size, at + 0.35 * size), &words, color::INK));
        }
        y += height + 2.2 * size;
    }
    for (key, words) in keys(scene) {
        let middle = y - 0.15 * size;
        match key {
            Key::Line(kind) => {
                let points = vec![DVec2::new(left, middle), DVec2::new(left + 1.3 * size, middle)];
                items.push(Item::Stroke { points, width: kind.width() * layout.line, color: kind.color() });
            }
            Key::Face(color) => {
                let low = DVec2::new(left + 0.1 * size, middle - 0.5 * size);
                items.push(Item::rect(&Rect::new(low, low + DVec2::splat(size)), color, 1.0));
            }
            Key::More => {}
        }
        items.push(layout.text(DVec2::new(left + 1.8 * size, middle + 0.35 * size), &words, color::INK));
        y += 1.5 * size;
    }
    items
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

/// Names at the first of their places that is seen and has room; and how many that are seen have none.
fn names(scene: &Scene, camera: &Camera, image: &Image, layout: &Layout, mut taken: Vec<Rect>) -> (Vec<Item>, usize) {
    let size = 0.95 * layout.size;
    let mark = |m: &super::scene::Mark| {
        let (at, radius) = (camera.project(m.at).at(), mark_radius(m.node, layout.size).0);
        Rect::new(at, at).grown(radius)
    };
    taken.extend(scene.marks.iter().map(mark));
    let mut order: Vec<&Label> = scene.labels.iter().collect();
    order.sort_by_key(|label| label.rank);
    let busy = Busy::new(scene, camera, image);
    let (mut items, mut left_out) = (Vec::new(), 0);
    for label in order {
        let seen: Vec<Spot> = label.places.iter().map(|p| camera.project(*p)).filter(|s| is_seen(s, image, layout)).collect();
        if seen.is_empty() {
            continue;
        }
        let free = |at: &DVec2| {
            let room = text_bounds(*at, size, &label.text);
            layout.page.grown(-0.3 * layout.margin).holds(&room) && !taken.iter().any(|t| t.meets(&room))
        };
        let stands = seen.iter().flat_map(|s| stands(s.at(), &label.text, size, label.centered)).filter(free);
        let found = stands.min_by_key(|at| busy.under(&text_bounds(*at, size, &label.text)));
        match found {
            Some(at) if items.len() < NAMES => {
                taken.push(text_bounds(at, size, &label.text));
                items.push(Item::Text { at, size, text: label.text.clone(), color: color::INK, halo: true });
            }
            _ => left_out += 1,
        }
    }
    (items, left_out)
}

/// Where lines are seen, in cells of some pixels: names stand beside lines rather than on them.
struct Busy {
    columns: usize,
    rows: usize,
    cells: Vec<bool>,
}

impl Busy {
    fn new(scene: &Scene, camera: &Camera, image: &Image) -> Self {
        let (columns, rows) = (image.width.div_ceil(CELL), image.height.div_ceil(CELL));
        let mut busy = Self { columns, rows, cells: vec![false; columns * rows] };
        for line in scene.lines.iter().filter(|l| l.kind != Kind::Element) {
            let spots: Vec<Spot> = line.points.iter().map(|p| camera.project(*p)).collect();
            for pair in spots.windows(2) {
                let (a, b) = (pair[0], pair[1]);
                // Longer than the page it is not looked at more often than the page has cells.
                let n = (2.0 * a.at().distance(b.at()) / CELL as f64).ceil().min(4.0 * (columns + rows) as f64) as usize;
                for k in 0..=n {
                    let t = k as f64 / n.max(1) as f64;
                    let at = a.at() + (b.at() - a.at()) * t;
                    let spot = Spot { x: at.x, y: at.y, near: a.near + (b.near - a.near) * t, grow: a.grow };
                    let inside = at.x >= 0.0 && at.y >= 0.0 && at.x < image.width as f64 && at.y < image.height as f64;
                    if inside && !image.hides(&spot, NAME_LIFT) {
                        busy.cells[at.y as usize / CELL * columns + at.x as usize / CELL] = true;
                    }
                }
            }
        }
        busy
    }

    /// How many cells with lines lie under a rectangle.
    fn under(&self, room: &Rect) -> usize {
        let range = |low: f64, high: f64, n: usize| (low.max(0.0) as usize / CELL)..(high.max(0.0) as usize / CELL + 1).min(n);
        let columns = range(room.min.x, room.max.x, self.columns);
        range(room.min.y, room.max.y, self.rows)
            .map(|row| columns.clone().filter(|column| self.cells[row * self.columns + column]).count())
            .sum()
    }
}

fn is_seen(spot: &Spot, image: &Image, layout: &Layout) -> bool {
    layout.page.holds(&Rect::new(spot.at(), spot.at())) && !image.hides(spot, NAME_LIFT)
}

/// Where words may stand around a place, the best first: right above, then round it.
fn stands(at: DVec2, text: &str, size: f64, centered: bool) -> Vec<DVec2> {
    let (width, height, gap) = (font::width(text, size), font::CAPITAL * size, 0.45 * size);
    let middle = DVec2::new(-0.5 * width, 0.5 * height);
    let around = [
        DVec2::new(gap, -gap),
        DVec2::new(gap, gap + height),
        DVec2::new(-gap - width, -gap),
        DVec2::new(-gap - width, gap + height),
        DVec2::new(middle.x, -1.4 * gap),
        DVec2::new(middle.x, 1.4 * gap + height),
        DVec2::new(1.4 * gap, middle.y),
        DVec2::new(-1.4 * gap - width, middle.y),
    ];
    let on = centered.then_some(middle);
    on.into_iter().chain(around).map(|d| at + d).collect()
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

//! Names beside what they name, none over another.

use glam::DVec2;

use super::annotate::{Layout, mark_radius};
use super::camera::{Camera, Rect, Spot};
use super::color;
use super::font;
use super::page::{Item, text_bounds};
use super::picture::MARK_LIFT;
use super::raster::Image;
use super::scene::{Kind, Label, Mark, Scene};

/// Names that a picture can hold.
const NAMES: usize = 400;
/// Pixels of a cell in which it is known whether a line is seen.
const CELL: usize = 3;
/// How much nearer than its place a name counts: its own mark does not hide it.
const NAME_LIFT: f64 = MARK_LIFT + 4.0;

/// Names at the first of their places that is seen and has room; and how many that are seen have none.
pub fn items(scene: &Scene, camera: &Camera, image: &Image, layout: &Layout, mut occupied: Vec<Rect>) -> (Vec<Item>, usize) {
    let size = 0.95 * layout.size;
    let mark = |m: &Mark| {
        let (at, radius) = (camera.project(m.at).at(), mark_radius(m.node, layout.size).0);
        Rect::new(at, at).grown(radius)
    };
    occupied.extend(scene.marks.iter().map(mark));
    let mut order: Vec<&Label> = scene.labels.iter().collect();
    order.sort_by_key(|label| label.rank);
    let lines = LineCells::new(scene, camera, image);
    let (mut items, mut left_out) = (Vec::new(), 0);
    for label in order {
        let seen: Vec<Spot> = label.places.iter().map(|p| camera.project(*p)).filter(|s| is_seen(s, image, layout)).collect();
        if seen.is_empty() {
            continue;
        }
        let free = |at: &DVec2| {
            let room = text_bounds(*at, size, &label.text);
            layout.page.grown(-0.3 * layout.margin).holds(&room) && !occupied.iter().any(|t| t.meets(&room))
        };
        let candidates = seen.iter().flat_map(|s| candidates(s.at(), &label.text, size, label.centered)).filter(free);
        let found = candidates.min_by_key(|at| lines.under(&text_bounds(*at, size, &label.text)));
        match found {
            Some(at) if items.len() < NAMES => {
                occupied.push(text_bounds(at, size, &label.text));
                items.push(Item::Text { at, size, text: label.text.clone(), color: color::INK, halo: true });
            }
            _ => left_out += 1,
        }
    }
    (items, left_out)
}

/// Where lines are seen, in cells of some pixels: names stand beside lines rather than on them.
struct LineCells {
    columns: usize,
    rows: usize,
    cells: Vec<bool>,
}

impl LineCells {
    fn new(scene: &Scene, camera: &Camera, image: &Image) -> Self {
        let (columns, rows) = (image.width.div_ceil(CELL), image.height.div_ceil(CELL));
        let mut lines = Self { columns, rows, cells: vec![false; columns * rows] };
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
                        lines.cells[at.y as usize / CELL * columns + at.x as usize / CELL] = true;
                    }
                }
            }
        }
        lines
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
fn candidates(at: DVec2, text: &str, size: f64, centered: bool) -> Vec<DVec2> {
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

//! A scene as a picture: where the model stands on the page, how strong its lines are, and the files it becomes.

use std::io::{self, Write};

use glam::DVec2;

use super::annotate::{self, Layout};
use super::camera::{Camera, Rect, View};
use super::page::{self, Item};
use super::raster::{self, EdgeStyle, Image, Thick};
use super::scene::{Kind, Scene};
use super::{color, font, png, svg};
use crate::base::job;

/// Edges of elements shorter than this on average, in pixels, are not drawn: they would hide the faces.
const DENSE: f64 = 3.0;
/// From this length on they are drawn at full strength.
const SPARSE: f64 = 11.0;
/// Share of full ink that edges of elements get.
const ELEMENT_INK: f64 = 0.85;
/// Sides looked at to find how long edges of elements are.
const MAX_SAMPLES: usize = 4096;
/// How much nearer than they are lines count, pixels, and what each more important kind adds.
const LIFT: (f64, f64) = (2.0, 0.5);
/// How much nearer than they are marks and names count.
pub(super) const MARK_LIFT: f64 = 6.0;

/// What is asked of a picture beside its scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Where it is seen from.
    pub view: View,
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Words above it; none where empty.
    pub title: String,
    /// Unit of lengths in the model.
    pub unit: String,
    /// Edges of elements are drawn.
    pub edges: bool,
    /// The directions of x, y and z stand in a corner.
    pub axes: bool,
    /// A bar shows a length.
    pub ruler: bool,
    /// Colours and kinds of lines are explained.
    pub legend: bool,
}

/// A picture ready to be written.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Faces, and in a raster picture lines.
    pub(super) image: Image,
    /// What stands over it.
    pub(super) items: Vec<Item>,
    /// Lines that are seen, in a vector picture; all of one kind together.
    pub(super) paths: Vec<svg::Path>,
    /// Words above it.
    pub(super) title: String,
}

/// Which file a picture becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Pixels.
    Png,
    /// Faces as pixels, lines and words as shapes.
    Svg,
}

/// Formats by the endings that choose them.
pub const FORMATS: &[(&str, Format)] = &[("png", Format::Png), ("svg", Format::Svg)];

impl Picture {
    /// Draws a scene for a file of this format.
    pub fn new(scene: &Scene, settings: &Settings, format: Format) -> Self {
        let layout = Layout::new(scene, settings);
        let camera = Camera::framing(&settings.view, &scene.points(), &scene.focus, &layout.frame);
        let strength = edge_strength(scene, &camera, settings);
        let lines = thick_lines(scene, &camera, layout.size);
        let size = (settings.width, settings.height);
        let edges = EdgeStyle { strength, width: Kind::Element.width() * layout.line };
        let (image, paths) = match format {
            Format::Png => (raster::draw(scene, &camera, &lines, edges, size), Vec::new()),
            Format::Svg => {
                let image = raster::draw(scene, &camera, &[], EdgeStyle::default(), size);
                let paths = svg::paths(scene, &camera, &image, strength, layout.line);
                (image, paths)
            }
        };
        let dense = settings.edges && strength <= 0.0 && scene.sheets.iter().any(|s| !s.edges.is_empty());
        let items = annotate::items(scene, &camera, &image, &layout, dense, format);
        Self { image, items, paths, title: settings.title.clone() }
    }

    /// A flat picture: items on white paper.
    pub(super) fn flat(items: Vec<Item>, (width, height): (usize, usize), title: &str) -> Self {
        let image = Image { width, height, rgb: vec![u8::MAX; 3 * width * height], near: vec![f32::NEG_INFINITY; width * height] };
        Self { image, items, paths: Vec::new(), title: title.to_owned() }
    }

    /// Rows of pixels that the words above a sheet of several pictures take.
    pub fn heading(settings: &Settings) -> usize {
        let size = annotate::size_of_words(settings);
        if settings.title.is_empty() { 0 } else { ((2.6 * size).ceil() as usize).min(settings.height / 2) }
    }

    /// Several pictures on one page, each from its upper left corner on, under one title.
    pub fn sheet(cells: Vec<(Self, (usize, usize))>, settings: &Settings) -> Self {
        let mut whole = Self::flat(Vec::new(), (settings.width, settings.height), &settings.title);
        for (cell, (left, top)) in cells {
            let image = &cell.image;
            for row in 0..image.height.min(settings.height.saturating_sub(top)) {
                let width = image.width.min(settings.width.saturating_sub(left));
                let (from, to) = (row * image.width, (top + row) * settings.width + left);
                whole.image.rgb[3 * to..3 * (to + width)].copy_from_slice(&image.rgb[3 * from..3 * (from + width)]);
                whole.image.near[to..to + width].copy_from_slice(&image.near[from..from + width]);
            }
            let by = DVec2::new(left as f64, top as f64);
            whole.items.extend(cell.items.into_iter().map(|item| item.moved(by)));
            whole.paths.extend(cell.paths.into_iter().map(|path| path.moved(by)));
        }
        if !settings.title.is_empty() {
            let size = 1.3 * annotate::size_of_words(settings);
            let at = DVec2::new(0.85 * size, 0.85 * size + font::CAPITAL * size);
            let text = annotate::fitting(&settings.title, size, settings.width as f64 - 1.7 * size);
            whole.items.push(Item::Text { at, size, text, color: color::INK, halo: true });
        }
        whole
    }

    /// All words on it with the room they take, in order of painting.
    pub fn texts(&self) -> Vec<(&str, Rect)> {
        self.items.iter().filter(|item| !item.words().is_empty()).map(|item| (item.words(), item.bounds())).collect()
    }

    /// Writes it.
    pub fn write(&self, format: Format, out: &mut dyn Write) -> io::Result<()> {
        match format {
            Format::Png => {
                let mut image = self.image.clone();
                page::paint(&mut image, &self.items);
                png::write(&image, out)
            }
            Format::Svg => svg::write(self, out),
        }
    }
}

/// How strongly edges of elements are drawn, by how long they are on average.
fn edge_strength(scene: &Scene, camera: &Camera, settings: &Settings) -> f64 {
    if !settings.edges {
        return 0.0;
    }
    let with_edges: Vec<_> = scene.sheets.iter().filter(|s| !s.edges.is_empty()).collect();
    let total: usize = with_edges.iter().map(|s| s.triangles.len()).sum();
    let step = total.div_ceil(MAX_SAMPLES).max(1);
    let (mut sum, mut count, mut skip) = (0.0, 0.0, 0);
    for sheet in with_edges {
        for (triangle, sides) in sheet.triangles.iter().zip(&sheet.edges).skip(skip).step_by(step) {
            let p = triangle.map(|c| camera.project(sheet.points[c as usize]).at());
            for k in (0..3).filter(|k| sides & (1 << k) != 0) {
                sum += p[k].distance(p[(k + 1) % 3]);
                count += 1.0;
            }
        }
        skip = (step - sheet.triangles.len() % step) % step;
    }
    if count == 0.0 { 0.0 } else { ELEMENT_INK * ((sum / count - DENSE) / (SPARSE - DENSE)).clamp(0.0, 1.0) }
}

/// How much nearer than it is a line of a kind counts.
pub(super) fn lift(kind: Kind) -> f64 {
    LIFT.0 + LIFT.1 * kind as u8 as f64
}

/// Lines and marks as the raster draws them, the most telling last.
fn thick_lines(scene: &Scene, camera: &Camera, size: f64) -> Vec<Thick> {
    let mut out = Vec::new();
    for kind in Kind::ALL {
        let half = 0.5 * kind.width() * size / annotate::SIZE;
        for line in job::looking(scene.lines.iter().filter(|l| l.kind == kind)) {
            let spots: Vec<_> = line.points.iter().map(|p| camera.project(*p)).collect();
            let pairs = spots.windows(2).map(|w| Thick { a: w[0], b: w[1], half, color: kind.color(), lift: lift(kind) });
            out.extend(pairs);
        }
    }
    for mark in &scene.marks {
        let spot = camera.project(mark.at);
        let (rim, inner) = annotate::mark_radius(mark.node, size);
        out.push(Thick { a: spot, b: spot, half: rim, color: color::INK, lift: MARK_LIFT });
        if inner > 0.0 {
            out.push(Thick { a: spot, b: spot, half: inner, color: color::WHITE, lift: MARK_LIFT + 1.0 });
        }
    }
    out
}

//! From a scene to pixels: what is seen at nine places a pixel, then the colour of that.
//!
//! The picture is cut into bands of rows, each with buffers of its own and made on some thread; a band depends on nothing
//! but the scene, so the bytes do not depend on how many threads there are.
//!
//! ```text
//!   triangles ─┐                     ┌─ which triangle ─┐
//!   lines     ─┴─ project ─ bands ───┤                  ├─ colour of each, mean of nine ─ pixels
//!                                    └─ how near        ┘
//! ```

use glam::DVec3;

use super::camera::{Camera, Spot};
use super::color::{Rgb, WHITE};
use super::scene::{Paint, Scene};
use super::shade::Shader;
use crate::base::job;
use crate::base::par;

/// Places along each side of a pixel where it is asked what is seen.
pub const SAMPLES: usize = 3;
/// Rows of pixels of a band.
const BAND: usize = 16;
/// Points projected by one thread at a time.
const BATCH: usize = 16_384;
/// Nothing is seen.
const NONE: u32 = u32::MAX;
/// How far apart along their normal two faces that lie on each other may be drawn, pixels: each is triangles that are within a
/// quarter of a pixel of its surface.
const SAME: f64 = 0.5;
/// Steepest face that is reckoned with, pixels of depth a pixel: beyond it nothing but its edge is seen.
const STEEPEST: f64 = 20.0;

/// A thick line between two places, or a dot where they are one.
#[derive(Clone, Copy, Debug)]
pub struct Thick {
    /// One end.
    pub a: Spot,
    /// The other end.
    pub b: Spot,
    /// Half its width, pixels.
    pub half: f64,
    /// Its colour.
    pub color: Rgb,
    /// How much nearer than it is it counts, pixels: lines on faces are seen.
    pub lift: f64,
}

/// Colours row by row from the upper left, and how near what is seen in the middle of each pixel is.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Pixels of a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green, blue of each pixel.
    pub rgb: Vec<u8>,
    /// [`Spot::near`] in the middle of each pixel; minus infinity where nothing is.
    pub near: Vec<f32>,
}

impl Image {
    /// Whether something nearer than the spot covers it.
    pub fn hides(&self, spot: &Spot, lift: f64) -> bool {
        let inside = spot.x >= 0.0 && spot.y >= 0.0 && spot.x < self.width as f64 && spot.y < self.height as f64;
        if !inside {
            return false;
        }
        // A face seen from the side rises fast: what lies on it is hidden where all around is nearer.
        let (x, y) = (spot.x as usize, spot.y as usize);
        let (left, right) = (x.saturating_sub(1), (x + 1).min(self.width - 1));
        let rows = y.saturating_sub(1)..=(y + 1).min(self.height - 1);
        let limit = spot.near + lift;
        rows.flat_map(|row| &self.near[row * self.width + left..=row * self.width + right]).all(|near| f64::from(*near) > limit)
    }

    /// Whether faces or lines are seen anywhere.
    pub fn is_empty(&self) -> bool {
        self.near.iter().all(|n| *n == f32::NEG_INFINITY)
    }
}

/// A triangle in the picture.
#[derive(Clone, Copy)]
pub(super) struct Corner3 {
    pub sheet: u32,
    pub triangle: u32,
}

/// All points and triangles of a scene in the picture.
pub(super) struct Projected {
    /// Spots of the points of each sheet.
    pub spots: Vec<Vec<Spot>>,
    /// Triangles with an area in the picture, in order.
    pub triangles: Vec<Corner3>,
    /// Which triangles may show in each band.
    bands: Vec<Vec<u32>>,
}

impl Projected {
    fn new(scene: &Scene, camera: &Camera, height: usize) -> Self {
        let project = |points: &[DVec3]| {
            let batches = par::map(points.len().div_ceil(BATCH), |k| {
                let part = &points[k * BATCH..points.len().min((k + 1) * BATCH)];
                part.iter().map(|p| camera.project(*p)).collect::<Vec<Spot>>()
            });
            batches.concat()
        };
        let spots: Vec<Vec<Spot>> = scene.sheets.iter().map(|sheet| project(&sheet.points)).collect();
        let mut projected =
            Self { spots, triangles: Vec::with_capacity(scene.triangles()), bands: vec![Vec::new(); height.div_ceil(BAND)] };
        for (s, sheet) in scene.sheets.iter().enumerate() {
            let spots = &projected.spots[s];
            for (t, corners) in job::looking(sheet.triangles.iter().enumerate()) {
                let ys = corners.map(|c| spots[c as usize].y);
                let (low, high) = (ys[0].min(ys[1]).min(ys[2]), ys[0].max(ys[1]).max(ys[2]));
                if let Some(range) = bands_of(low, high, height) {
                    let id = projected.triangles.len() as u32;
                    projected.triangles.push(Corner3 { sheet: s as u32, triangle: t as u32 });
                    range.for_each(|band| projected.bands[band].push(id));
                }
            }
        }
        projected
    }

    pub fn corners(&self, scene: &Scene, id: u32) -> [Spot; 3] {
        let Corner3 { sheet, triangle } = self.triangles[id as usize];
        let spots = &self.spots[sheet as usize];
        scene.sheets[sheet as usize].triangles[triangle as usize].map(|c| spots[c as usize])
    }
}

/// The bands that rows between two heights lie in.
fn bands_of(low: f64, high: f64, height: usize) -> Option<std::ops::Range<usize>> {
    (high > 0.0 && low < height as f64).then(|| {
        let first = low.max(0.0) as usize / BAND;
        let last = (high.min(height as f64 - 0.5) as usize) / BAND;
        first..last + 1
    })
}

/// How edges of elements are drawn.
#[derive(Clone, Copy, Debug, Default)]
pub struct EdgeStyle {
    /// How strongly, 0…1.
    pub strength: f64,
    /// Their width, pixels.
    pub width: f64,
}

/// Draws the faces of a scene and then the lines, which are hidden by what is nearer.
pub fn draw(scene: &Scene, camera: &Camera, lines: &[Thick], edges: EdgeStyle, (width, height): (usize, usize)) -> Image {
    let projected = Projected::new(scene, camera, height);
    let mut line_bands: Vec<Vec<u32>> = vec![Vec::new(); height.div_ceil(BAND)];
    for (k, line) in job::looking(lines.iter().enumerate()) {
        let (low, high) = (line.a.y.min(line.b.y) - line.half, line.a.y.max(line.b.y) + line.half);
        if let Some(range) = bands_of(low, high, height) {
            range.for_each(|band| line_bands[band].push(k as u32));
        }
    }
    let shader = Shader::new(scene, camera, &projected, edges);
    let bands = par::map(height.div_ceil(BAND), |band| {
        let rows = BAND.min(height - band * BAND);
        let mut buffer = Buffer::new(width, band * BAND, rows);
        for &id in job::looking(&projected.bands[band]) {
            buffer.triangle(id, projected.triangles[id as usize].sheet, projected.corners(scene, id));
        }
        for &k in job::looking(&line_bands[band]) {
            buffer.line(k, &lines[k as usize]);
        }
        buffer.resolve(&shader, lines)
    });
    let mut image = Image { width, height, rgb: Vec::with_capacity(3 * width * height), near: Vec::with_capacity(width * height) };
    for (rgb, near) in bands {
        image.rgb.extend(rgb);
        image.near.extend(near);
    }
    image
}

/// Places of one band: what is seen there and how near it is.
struct Buffer {
    width: usize,
    rows: usize,
    /// First row of places in the whole picture.
    top: usize,
    near: Vec<f32>,
    /// How fast the face there rises, pixels of depth a pixel.
    steep: Vec<f32>,
    face: Vec<u32>,
    /// The sheet of that face.
    sheet: Vec<u32>,
    line: Vec<u32>,
}

impl Buffer {
    fn new(width: usize, first: usize, rows: usize) -> Self {
        let (width, rows) = (width * SAMPLES, rows * SAMPLES);
        let n = width * rows;
        Self {
            width,
            rows,
            top: first * SAMPLES,
            near: vec![f32::NEG_INFINITY; n],
            steep: vec![0.0; n],
            face: vec![NONE; n],
            sheet: vec![NONE; n],
            line: vec![NONE; n],
        }
    }

    /// Rows of places between two heights, as indices of this band.
    fn rows_between(&self, low: f64, high: f64) -> std::ops::Range<usize> {
        let top = self.top as f64;
        let index = |y: f64| (y - 0.5 - top).ceil().clamp(0.0, self.rows as f64) as usize;
        index(low)..index(high)
    }

    /// Places of a row between two widths.
    fn places_between(&self, low: f64, high: f64) -> std::ops::Range<usize> {
        let index = |x: f64| (x - 0.5).ceil().clamp(0.0, self.width as f64) as usize;
        let first = index(low);
        first..index(high).max(first)
    }

    /// Marks the places where a triangle is nearer than what was there; of sheets that lie on each other the later one is seen. Sides
    /// are cut the same way from both of their triangles, so nothing shows between neighbours.
    fn triangle(&mut self, id: u32, sheet: u32, corners: [Spot; 3]) {
        let n = SAMPLES as f64;
        let p = corners.map(|s| (s.x * n, s.y * n, s.near));
        let area = (p[1].0 - p[0].0) * (p[2].1 - p[0].1) - (p[2].0 - p[0].0) * (p[1].1 - p[0].1);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let (low, high) = (p[0].1.min(p[1].1).min(p[2].1), p[0].1.max(p[1].1).max(p[2].1));
        let (far, close) = (p[0].2.min(p[1].2).min(p[2].2), p[0].2.max(p[1].2).max(p[2].2));
        let (d1, d2) = (p[1].2 - p[0].2, p[2].2 - p[0].2);
        let by_x = (d1 * (p[2].1 - p[0].1) - d2 * (p[1].1 - p[0].1)) / area;
        let by_y = (d2 * (p[1].0 - p[0].0) - d1 * (p[2].0 - p[0].0)) / area;
        let steep = (by_x * by_x + by_y * by_y).sqrt() * n;
        let same = (SAME * (1.0 + steep.min(STEEPEST))) as f32;
        let steep = steep.min(STEEPEST) as f32;
        for row in self.rows_between(low, high) {
            let y = (self.top + row) as f64 + 0.5;
            let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
            for k in 0..3 {
                let (mut a, mut b) = (p[k], p[(k + 1) % 3]);
                if a.1 > b.1 {
                    (a, b) = (b, a);
                }
                if a.1 <= y && y < b.1 {
                    let x = a.0 + (y - a.1) * ((b.0 - a.0) / (b.1 - a.1));
                    (left, right) = (left.min(x), right.max(x));
                }
            }
            let places = self.places_between(left, right);
            let base = p[0].2 + by_y * (y - p[0].1) + by_x * (0.5 - p[0].0);
            let start = row * self.width;
            for place in places {
                // Seen nearly from the side, a plane runs off between its corners.
                let near = (base + by_x * place as f64).clamp(far, close) as f32;
                let at = start + place;
                let over = if self.sheet[at] == sheet { 0.0 } else { same };
                if near > self.near[at] - over {
                    self.near[at] = near.max(self.near[at]);
                    (self.steep[at], self.face[at], self.sheet[at]) = (steep, id, sheet);
                }
            }
        }
    }

    /// Marks the places that a line covers and that nothing nearer hides.
    fn line(&mut self, id: u32, line: &Thick) {
        let n = SAMPLES as f64;
        let (a, b, half) = (line.a.at() * n, line.b.at() * n, line.half * n);
        let along = b - a;
        let length2 = along.length_squared();
        for row in self.rows_between(a.y.min(b.y) - half, a.y.max(b.y) + half) {
            let y = (self.top + row) as f64 + 0.5;
            // The part of the line that reaches this row.
            let reach = |edge: f64| ((edge - a.y) / along.y).clamp(0.0, 1.0);
            let (t0, t1) = if along.y == 0.0 { (0.0, 1.0) } else { (reach(y - half), reach(y + half)) };
            let (x0, x1) = (a.x + along.x * t0, a.x + along.x * t1);
            for place in self.places_between(x0.min(x1) - half, x0.max(x1) + half) {
                let from = glam::DVec2::new(place as f64 + 0.5, y) - a;
                let t = if length2 > 0.0 { (from.dot(along) / length2).clamp(0.0, 1.0) } else { 0.0 };
                let aside = (from - along * t).length_squared();
                if aside > half * half {
                    continue;
                }
                let near = (line.a.near + (line.b.near - line.a.near) * t + line.lift) as f32;
                let at = row * self.width + place;
                // Beside its middle a line on a face that is seen from the side is behind that face by its own width.
                let rise = if self.line[at] == NONE { self.steep[at] * ((aside.sqrt() / n) as f32 + SAME as f32) } else { 0.0 };
                if near >= self.near[at] - rise {
                    self.near[at] = near;
                    self.line[at] = id;
                }
            }
        }
    }

    /// Pixels of the band: the mean colour of what its places see.
    fn resolve(&self, shader: &Shader, lines: &[Thick]) -> (Vec<u8>, Vec<f32>) {
        let (width, rows) = (self.width / SAMPLES, self.rows / SAMPLES);
        let (mut rgb, mut near) = (Vec::with_capacity(3 * width * rows), Vec::with_capacity(width * rows));
        let paper = WHITE.shares();
        for row in 0..rows {
            let y = (self.top / SAMPLES + row) as f64 + 0.5;
            for column in 0..width {
                let x = column as f64 + 0.5;
                let mut sum = [0.0_f32; 3];
                let mut last: (u32, [f32; 3]) = (NONE, paper);
                for k in 0..SAMPLES * SAMPLES {
                    let at = (row * SAMPLES + k / SAMPLES) * self.width + column * SAMPLES + k % SAMPLES;
                    let color = if self.line[at] != NONE {
                        lines[self.line[at] as usize].color.shares()
                    } else if self.face[at] == NONE {
                        paper
                    } else if shader.is_fine(self.face[at]) {
                        let (dx, dy) = ((k % SAMPLES) as f64 - 1.0, (k / SAMPLES) as f64 - 1.0);
                        shader.color(self.face[at], x + dx / SAMPLES as f64, y + dy / SAMPLES as f64)
                    } else {
                        if last.0 != self.face[at] {
                            last = (self.face[at], shader.color(self.face[at], x, y));
                        }
                        last.1
                    };
                    (0..3).for_each(|c| sum[c] += color[c]);
                }
                let mean = sum.map(|s| (s / (SAMPLES * SAMPLES) as f32 * 255.0 + 0.5) as u8);
                rgb.extend(mean);
                near.push(self.near[(row * SAMPLES + SAMPLES / 2) * self.width + column * SAMPLES + SAMPLES / 2]);
            }
        }
        (rgb, near)
    }
}

/// Whether a paint changes inside a pixel.
pub(super) fn is_fine(paint: &Paint) -> bool {
    matches!(paint, Paint::Zebra | Paint::Reflections | Paint::Isophotes)
}

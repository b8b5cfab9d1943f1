//! SVG files: faces as an embedded raster picture, what lies over them as shapes and words.
//!
//! Lines are tested against the depths of the raster picture, so hidden parts are left out; they and the words stay
//! sharp at any magnification, and words can be searched.

use std::io::{self, Write};

use glam::DVec2;

use super::camera::{Camera, Spot};
use super::color::{ELEMENT, Rgb};
use super::page::{HALO, Item};
use super::picture::{Picture, lift};
use super::raster::Image;
use super::scene::{Kind, Scene};
use super::{font, png};
use crate::base::job;
use crate::base::text::real;
use crate::base::xml::escaped;

/// Pixels between two places of a line where it is asked whether it is seen.
const STEP: f64 = 1.0;

/// Lines of one colour and width that are seen.
#[derive(Clone, Debug)]
pub struct Path {
    color: Rgb,
    width: f64,
    opacity: f64,
    lines: Vec<Vec<DVec2>>,
}

impl Path {
    /// All lines moved on the page.
    pub(super) fn moved(mut self, by: DVec2) -> Self {
        self.lines.iter_mut().flatten().for_each(|p| *p += by);
        self
    }
}

/// The seen parts of all lines, one path for each kind. `strength`, 0…1, is that of edges of elements; widths are multiplied by `line`.
pub fn paths(scene: &Scene, camera: &Camera, image: &Image, strength: f64, line: f64) -> Vec<Path> {
    let mut paths = Vec::new();
    for kind in Kind::ALL {
        let mut seen = Seen { image, lift: lift(kind), lines: Vec::new() };
        if kind == Kind::Element && strength > 0.0 {
            element_edges(scene, camera, &mut seen);
        }
        for line in job::looking(scene.lines.iter().filter(|l| l.kind == kind)) {
            let spots: Vec<Spot> = line.points.iter().map(|p| camera.project(*p)).collect();
            spots.windows(2).for_each(|w| seen.segment(w[0], w[1]));
        }
        let opacity = if kind == Kind::Element { strength } else { 1.0 };
        let (color, width) = if kind == Kind::Element { (ELEMENT, kind.width()) } else { (kind.color(), kind.width()) };
        paths.push(Path { color, width: width * line, opacity, lines: seen.lines });
    }
    paths.retain(|p| !p.lines.is_empty());
    paths
}

/// Each edge of the elements once.
fn element_edges(scene: &Scene, camera: &Camera, seen: &mut Seen) {
    for sheet in &scene.sheets {
        let spots: Vec<Spot> = sheet.points.iter().map(|p| camera.project(*p)).collect();
        let sides = sheet.triangles.iter().zip(&sheet.edges);
        let mut edges: Vec<(u32, u32)> = job::looking(sides)
            .flat_map(|(t, bits)| (0..3).filter(move |k| bits & (1 << k) != 0).map(move |k| (t[k], t[(k + 1) % 3])))
            .map(|(a, b)| (a.min(b), a.max(b)))
            .collect();
        job::sort(&mut edges);
        edges.dedup();
        job::looking(edges).for_each(|(a, b)| seen.segment(spots[a as usize], spots[b as usize]));
    }
}

/// Collects what is seen of segments; a segment that goes on where the last one ended lengthens it.
struct Seen<'i> {
    image: &'i Image,
    lift: f64,
    lines: Vec<Vec<DVec2>>,
}

impl Seen<'_> {
    fn segment(&mut self, a: Spot, b: Spot) {
        let n = ((a.at().distance(b.at()) / STEP).ceil() as usize).clamp(1, 4 * (self.image.width + self.image.height));
        let mix = |t: f64| Spot { x: a.x + (b.x - a.x) * t, y: a.y + (b.y - a.y) * t, near: a.near + (b.near - a.near) * t, grow: a.grow };
        let hidden = |k: usize| self.image.hides(&mix((k as f64 + 0.5) / n as f64), self.lift);
        let mut k = 0;
        while k < n {
            if hidden(k) {
                k += 1;
                continue;
            }
            let first = k;
            while k < n && !hidden(k) {
                k += 1;
            }
            let (from, to) = (mix(first as f64 / n as f64).at(), mix(k as f64 / n as f64).at());
            match self.lines.last_mut() {
                Some(line) if first == 0 && line.last() == Some(&from) => line.push(to),
                _ => self.lines.push(vec![from, to]),
            }
        }
    }
}

/// Writes a picture.
pub fn write(picture: &Picture, out: &mut dyn Write) -> io::Result<()> {
    let (width, height) = (picture.image.width, picture.image.height);
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"sans-serif\" stroke-linecap=\"round\" stroke-linejoin=\"round\">"
    )?;
    if !picture.title.is_empty() {
        writeln!(out, "<title>{}</title>", escaped(&picture.title))?;
    }
    writeln!(out, "<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>")?;
    if !picture.image.is_empty() {
        let mut bytes = Vec::new();
        png::write(&picture.image, &mut bytes)?;
        writeln!(out, "<image width=\"{width}\" height=\"{height}\" href=\"data:image/png;base64,{}\"/>", base64(&bytes))?;
    }
    for path in &picture.paths {
        let opacity = if path.opacity < 1.0 { format!(" stroke-opacity=\"{}\"", short(path.opacity)) } else { String::new() };
        write!(out, "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{opacity} d=\"", path.color.hex(), short(path.width))?;
        for line in &path.lines {
            out.write_all(data(line).as_bytes())?;
        }
        writeln!(out, "\"/>")?;
    }
    picture.items.iter().try_for_each(|item| write_item(item, out))?;
    writeln!(out, "</svg>")
}

fn write_item(item: &Item, out: &mut dyn Write) -> io::Result<()> {
    match item {
        Item::Stroke { points, width, color } => {
            writeln!(out, "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" d=\"{}\"/>", color.hex(), short(*width), data(points))
        }
        Item::Fill { points, color, opacity } => {
            writeln!(out, "<path fill=\"{}\" fill-opacity=\"{}\" d=\"{}Z\"/>", color.hex(), short(*opacity), data(points))
        }
        Item::Text { at, size, text, color, halo } => {
            // Whatever font the viewer has, the words take the room that was kept for them.
            let room = font::width(text, *size);
            let place = format!("x=\"{}\" y=\"{}\" font-size=\"{}\"", short(at.x), short(at.y), short(*size));
            let fit = format!("textLength=\"{}\" lengthAdjust=\"spacingAndGlyphs\"", short(room));
            let words = escaped(text);
            // The rim is a text of its own below the words: not every viewer knows `paint-order`.
            if *halo {
                let rim = format!("fill=\"#ffffff\" stroke=\"#ffffff\" stroke-width=\"{}\" aria-hidden=\"true\"", short(HALO * size));
                writeln!(out, "<text {place} {fit} {rim}>{words}</text>")?;
            }
            writeln!(out, "<text {place} {fit} fill=\"{}\">{words}</text>", color.hex())
        }
    }
}

/// A line as path data with hundredths of a pixel.
fn data(points: &[DVec2]) -> String {
    let mut out = String::new();
    for (k, p) in points.iter().enumerate() {
        out.push(if k == 0 { 'M' } else { 'L' });
        out.push_str(&format!("{} {}", short(p.x), short(p.y)));
    }
    out
}

fn short(x: f64) -> String {
    real((x * 100.0).round() / 100.0)
}

/// Bytes as text of 64 signs.
pub fn base64(bytes: &[u8]) -> String {
    const SIGNS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for part in job::looking(bytes.chunks(3)) {
        let word = part.iter().fold(0_u32, |w, b| w << 8 | u32::from(*b)) << (8 * (3 - part.len()));
        for k in 0..4 {
            let sign = SIGNS[(word >> (18 - 6 * k) & 63) as usize];
            out.push(if k <= part.len() { char::from(sign) } else { '=' });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_as_in_rfc_4648() {
        let pairs = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
            ("\u{7ff}\u{fff}?", "37/gv78/"),
        ];
        for (plain, coded) in pairs {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }
}

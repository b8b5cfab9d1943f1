//! The colour of a face at a place of the picture: its paint under two lights, with the edges of its elements.

use glam::{DVec2, DVec3};

use super::camera::{Camera, Spot};
use super::color::{ELEMENT, Rgb};
use super::raster::{self, Corner3, EdgeStyle, Projected};
use super::scene::{Paint, Scene, Sheet};
use crate::base::math;

/// Light that comes from everywhere.
const AMBIENT: f64 = 0.36;
/// Light from beside the eye.
const HEAD: f64 = 0.52;
/// Light from above on the left.
const FILL: f64 = 0.26;
/// Stripes over half a turn of the reflected view.
const STRIPES: f64 = 36.0;
/// Lamps round the model.
const LAMPS: f64 = 36.0;
/// Share of the room between two lamps that the dark line of one takes.
const LAMP: f64 = 0.3;
/// Bands of isophotes between a normal along z and one against it: each is 6 degrees wide.
const BANDS: f64 = 30.0;
/// Light and dark of stripes and bands.
const LIGHT_DARK: [Rgb; 2] = [Rgb(250, 250, 250), Rgb(40, 46, 58)];

/// Everything that shading a face needs.
pub(super) struct Shader<'s> {
    scene: &'s Scene,
    camera: &'s Camera,
    projected: &'s Projected,
    fill: DVec3,
    edges: EdgeStyle,
}

impl<'s> Shader<'s> {
    pub fn new(scene: &'s Scene, camera: &'s Camera, projected: &'s Projected, edges: EdgeStyle) -> Self {
        let fill = (camera.up * 0.8 - camera.right * 0.6 + camera.back * 0.5).normalize();
        Self { scene, camera, projected, fill, edges }
    }

    fn sheet(&self, id: u32) -> (&'s Sheet, usize) {
        let Corner3 { sheet, triangle } = self.projected.triangles[id as usize];
        (&self.scene.sheets[sheet as usize], triangle as usize)
    }

    /// Whether the colour of a face changes inside a pixel.
    pub fn is_fine(&self, id: u32) -> bool {
        raster::is_fine(&self.sheet(id).0.paint)
    }

    /// The colour of a face at a place; a little outside of it the colour of its rim.
    pub fn color(&self, id: u32, x: f64, y: f64) -> [f32; 3] {
        let (sheet, triangle) = self.sheet(id);
        let spots = self.projected.corners(self.scene, id);
        let corners = sheet.triangles[triangle].map(|c| c as usize);
        let (shares, twice_area) = shares(&spots, DVec2::new(x, y));
        let inside = in_space(&spots, shares);
        let points = corners.map(|c| sheet.points[c]);
        let at = points[0] * inside[0] + points[1] * inside[1] + points[2] * inside[2];
        let to_eye = self.camera.to_eye(at);
        let flat = (points[1] - points[0]).cross(points[2] - points[0]).normalize_or(to_eye);
        let mut normal = flat;
        if !sheet.normals.is_empty() {
            let mean = (0..3).fold(DVec3::ZERO, |sum, k| sum + sheet.normals[corners[k]] * inside[k]);
            normal = mean.normalize_or(flat);
        }
        // The side that is seen is the triangle's; near a rim an interpolated normal may lean over.
        let seen_from_front = flat.dot(to_eye) >= 0.0;
        let upward = if seen_from_front { normal } else { -normal };
        let color = match &sheet.paint {
            Paint::Even(color) => *color,
            Paint::Sides(front, back) => {
                if seen_from_front {
                    *front
                } else {
                    *back
                }
            }
            Paint::Zebra => zebra(upward, to_eye, self.camera),
            Paint::Reflections => reflections(upward, to_eye, self.camera),
            Paint::Isophotes => isophotes(normal),
            Paint::OfTriangles(values) => self.of_scale(f64::from(values[triangle])),
            Paint::OfPoints(values) => self.of_scale((0..3).map(|k| f64::from(values[corners[k]]) * inside[k]).sum()),
        };
        let light = AMBIENT + HEAD * upward.dot(to_eye).max(0.0) + FILL * upward.dot(self.fill).max(0.0);
        // Colours that stand for something stay near themselves.
        let lit = if matches!(sheet.paint, Paint::Even(_) | Paint::Sides(..)) { light } else { 0.55 + 0.45 * light };
        let edge = self.edge(sheet, triangle, &spots, shares, twice_area);
        let (face, ink) = (color.shares(), ELEMENT.shares());
        [0, 1, 2].map(|k| {
            let lit = (f64::from(face[k]) * lit).min(1.0);
            (lit + (f64::from(ink[k]) - lit) * edge) as f32
        })
    }

    fn of_scale(&self, value: f64) -> Rgb {
        self.scene.scale.as_ref().map_or(super::color::UNKNOWN, |scale| scale.color(value))
    }

    /// How much of a place the edges of the element cover, 0…1.
    fn edge(&self, sheet: &Sheet, triangle: usize, spots: &[Spot; 3], shares: [f64; 3], twice_area: f64) -> f64 {
        let EdgeStyle { strength, width } = self.edges;
        let half = 0.5 * width;
        let sides = sheet.edges.get(triangle).copied().unwrap_or(0);
        if strength <= 0.0 || sides == 0 {
            return 0.0;
        }
        let mut covered: f64 = 0.0;
        for k in 0..3 {
            if sides & (1 << k) != 0 {
                let length = spots[k].at().distance(spots[(k + 1) % 3].at());
                let distance = (shares[(k + 2) % 3] * twice_area / length).abs();
                covered = covered.max((half + 0.5 - distance).clamp(0.0, 1.0));
            }
        }
        covered * strength
    }
}

/// Shares of the corners at a place of the picture, which may lie outside, and twice the area in pixels.
fn shares(spots: &[Spot; 3], at: DVec2) -> ([f64; 3], f64) {
    let p = spots.map(|s| s.at());
    let twice_area = (p[1] - p[0]).perp_dot(p[2] - p[0]);
    let of = |a: DVec2, b: DVec2| (b - a).perp_dot(at - a) / twice_area;
    let (second, third) = (of(p[2], p[0]), of(p[0], p[1]));
    ([1.0 - second - third, second, third], twice_area)
}

/// Shares of the corners in space: brought inside, and undone what perspective did.
fn in_space(spots: &[Spot; 3], shares: [f64; 3]) -> [f64; 3] {
    let inside = shares.map(|s| s.clamp(0.0, 1.0));
    let weights = [0, 1, 2].map(|k| inside[k] * spots[k].grow);
    let sum: f64 = weights.iter().sum();
    if sum > 0.0 { weights.map(|w| w / sum) } else { [1.0, 0.0, 0.0] }
}

/// Black and white stripes of a room of lamps along the picture's up, as a polished surface reflects them.
fn zebra(normal: DVec3, to_eye: DVec3, camera: &Camera) -> Rgb {
    let reflected = normal * (2.0 * normal.dot(to_eye)) - to_eye;
    let angle = math::asin(reflected.dot(camera.right).clamp(-1.0, 1.0));
    let stripe = (angle * STRIPES / std::f64::consts::PI).floor();
    if stripe.rem_euclid(2.0) < 1.0 { LIGHT_DARK[0] } else { LIGHT_DARK[1] }
}

/// Dark lines where a polished surface reflects straight lamps that run along the picture's right, equally spaced round the model and far from it.
fn reflections(normal: DVec3, to_eye: DVec3, camera: &Camera) -> Rgb {
    let reflected = normal * (2.0 * normal.dot(to_eye)) - to_eye;
    let turn = math::atan2(reflected.dot(camera.up), reflected.dot(camera.back)) / std::f64::consts::TAU;
    if (turn * LAMPS).rem_euclid(1.0) < LAMP { LIGHT_DARK[1] } else { LIGHT_DARK[0] }
}

/// Bands of equal angle between the normal and z, the same from wherever they are seen.
fn isophotes(normal: DVec3) -> Rgb {
    let band = (math::acos(normal.z.clamp(-1.0, 1.0)) * BANDS / std::f64::consts::PI).floor();
    if band.rem_euclid(2.0) < 1.0 { LIGHT_DARK[0] } else { LIGHT_DARK[1] }
}

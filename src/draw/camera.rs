//! Where a picture is seen from: directions, and points in space as points of the picture.

use glam::{DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::math;

/// How far the eye of a perspective picture stands from the middle of what is drawn, in radii of its ball.
const EYE: f64 = 4.0;
/// Two directions closer than this share say the same up.
const SAME: f64 = 0.001;
/// Least part of the ball that a picture shows, so that a single point has a neighbourhood.
const LEAST: f64 = 0.02;

/// The named views and the direction from the model to the eye in each, with what is up where that is not z.
pub const VIEWS: &[(&str, DVec3, DVec3)] = &[
    ("isometric", DVec3::new(1.0, -1.0, 1.0), DVec3::Z),
    ("front", DVec3::new(0.0, -1.0, 0.0), DVec3::Z),
    ("back", DVec3::new(0.0, 1.0, 0.0), DVec3::Z),
    ("left", DVec3::new(-1.0, 0.0, 0.0), DVec3::Z),
    ("right", DVec3::new(1.0, 0.0, 0.0), DVec3::Z),
    ("top", DVec3::new(0.0, 0.0, 1.0), DVec3::Y),
    ("bottom", DVec3::new(0.0, 0.0, -1.0), DVec3::Y),
];

/// The direction from the model to the eye, and the direction that is up in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// From the model to the eye; any length but zero.
    pub eye: DVec3,
    /// Up in the picture; `None` for z, or y where the eye looks along z.
    pub up: Option<DVec3>,
    /// Near things are larger.
    pub perspective: bool,
}

impl View {
    /// A named view; `None` for a word that is none.
    pub fn named(word: &str) -> Option<Self> {
        let (_, eye, up) = VIEWS.iter().find(|view| view.0 == word)?;
        Some(Self { eye: *eye, up: Some(*up), perspective: false })
    }

    /// Whether up says nothing because it is the direction of the eye.
    pub fn up_is_lost(&self) -> bool {
        let eye = self.eye.normalize_or_zero();
        self.up.is_some_and(|up| up.normalize_or_zero().cross(eye).length() < SAME)
    }
}

/// A point as the picture has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Pixels from the left edge.
    pub x: f64,
    /// Pixels from the upper edge.
    pub y: f64,
    /// Pixels towards the eye; linear along straight lines of the picture.
    pub near: f64,
    /// By how much things there are larger than in the middle; 1 without perspective.
    pub grow: f64,
}

impl Spot {
    /// Where it is in the picture.
    pub fn at(&self) -> DVec2 {
        DVec2::new(self.x, self.y)
    }
}

/// A rectangle of the picture, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    /// Upper left corner.
    pub min: DVec2,
    /// Lower right corner.
    pub max: DVec2,
}

impl Rect {
    /// From corner to corner.
    pub fn new(min: DVec2, max: DVec2) -> Self {
        Self { min, max }
    }

    /// Width and height.
    pub fn size(&self) -> DVec2 {
        self.max - self.min
    }

    /// Whether two rectangles share a point.
    pub fn meets(&self, other: &Self) -> bool {
        self.min.cmplt(other.max).all() && other.min.cmplt(self.max).all()
    }

    /// Whether the other lies inside.
    pub fn holds(&self, other: &Self) -> bool {
        self.min.cmple(other.min).all() && other.max.cmple(self.max).all()
    }

    /// Grown on all sides.
    pub fn grown(&self, by: f64) -> Self {
        Self { min: self.min - DVec2::splat(by), max: self.max + DVec2::splat(by) }
    }
}

/// From space to the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Unit vector to the right.
    pub right: DVec3,
    /// Unit vector upwards.
    pub up: DVec3,
    /// Unit vector towards the eye.
    pub back: DVec3,
    /// Pixels of one model unit in the middle.
    pub scale: f64,
    target: DVec3,
    /// Distance of the eye from the target, model units; `None` without perspective.
    eye: Option<f64>,
    offset: DVec2,
}

impl Camera {
    /// A camera that shows all of `focus` inside `frame`; `all` are the points of everything that is drawn.
    pub fn framing(view: &View, all: &[DVec3], focus: &[DVec3], frame: &Rect) -> Self {
        let back = view.eye.normalize_or(DVec3::Z);
        let level = |up: DVec3| (up - back * up.dot(back)).try_normalize();
        let wanted = view.up.filter(|_| !view.up_is_lost());
        let up = wanted.and_then(level).unwrap_or_else(|| {
            let along_z = back.cross(DVec3::Z).length() < SAME;
            level(if along_z { DVec3::Y } else { DVec3::Z }).unwrap_or(math::any_normal(back))
        });
        let around = Box3::of(all.iter().copied());
        let target = if around.is_empty() { DVec3::ZERO } else { around.center() };
        let radius = all.iter().map(|p| p.distance(target)).fold(0.0, f64::max);
        let radius = if radius > 0.0 && radius.is_finite() { radius } else { 1.0 };
        let eye = view.perspective.then_some(EYE * radius);
        let mut camera = Self { right: up.cross(back), up, back, scale: 1.0, target, eye, offset: DVec2::ZERO };
        let shown = if focus.is_empty() { all } else { focus };
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for p in shown {
            let at = camera.project(*p).at();
            (low, high) = (low.min(at), high.max(at));
        }
        if shown.is_empty() {
            (low, high) = (DVec2::ZERO, DVec2::ZERO);
        }
        let least = DVec2::splat(LEAST * radius);
        let (middle, room) = (0.5 * (low + high), (high - low).max(least));
        let share = frame.size() / room;
        camera.scale = share.x.min(share.y);
        camera.offset = 0.5 * (frame.min + frame.max) - middle * camera.scale;
        camera
    }

    /// A point of space in the picture.
    pub fn project(&self, p: DVec3) -> Spot {
        let d = p - self.target;
        let (x, y, z) = (d.dot(self.right), -d.dot(self.up), d.dot(self.back));
        let grow = self.eye.map_or(1.0, |eye| eye / (eye - z));
        let k = grow * self.scale;
        Spot { x: x * k + self.offset.x, y: y * k + self.offset.y, near: z * k, grow }
    }

    /// Unit vector from a point to the eye.
    pub fn to_eye(&self, p: DVec3) -> DVec3 {
        match self.eye {
            None => self.back,
            Some(eye) => (self.target + self.back * eye - p).normalize_or(self.back),
        }
    }

    /// Whether lengths mean the same everywhere in the picture.
    pub fn has_one_scale(&self) -> bool {
        self.eye.is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame() -> Rect {
        Rect::new(DVec2::new(10.0, 20.0), DVec2::new(210.0, 120.0))
    }

    fn corners() -> Vec<DVec3> {
        (0..8).map(|k| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2 & 1)) * 3.0).collect()
    }

    #[test]
    fn everything_is_inside_the_frame_from_everywhere() {
        for perspective in [false, true] {
            let free = View { eye: DVec3::new(0.2, -0.9, 0.3), up: None, perspective };
            let views = VIEWS.iter().map(|(_, eye, up)| View { eye: *eye, up: Some(*up), perspective }).chain([free]);
            for view in views {
                let camera = Camera::framing(&view, &corners(), &[], &frame());
                let grown = frame().grown(0.001);
                let spots: Vec<Spot> = corners().iter().map(|p| camera.project(*p)).collect();
                assert!(spots.iter().all(|s| grown.holds(&Rect::new(s.at(), s.at()))), "{view:?}");
                // One direction is filled.
                let width = spots.iter().map(|s| s.x).fold(f64::MIN, f64::max) - spots.iter().map(|s| s.x).fold(f64::MAX, f64::min);
                let height = spots.iter().map(|s| s.y).fold(f64::MIN, f64::max) - spots.iter().map(|s| s.y).fold(f64::MAX, f64::min);
                assert!((width - 200.0).abs() < 0.001 || (height - 100.0).abs() < 0.001, "{view:?}: {width} {height}");
            }
        }
    }

    #[test]
    fn front_has_x_to_the_right_and_z_up_and_near_things_nearer() {
        let camera = Camera::framing(&View::named("front").unwrap(), &corners(), &[], &frame());
        let at = |x, y, z| camera.project(DVec3::new(x, y, z));
        assert!(at(1.0, 0.0, 0.0).x > at(0.0, 0.0, 0.0).x);
        assert!(at(0.0, 0.0, 1.0).y < at(0.0, 0.0, 0.0).y);
        assert!(at(0.0, 0.0, 0.0).near > at(0.0, 1.0, 0.0).near);
        let top = Camera::framing(&View::named("top").unwrap(), &corners(), &[], &frame());
        assert!(top.project(DVec3::Y).y < top.project(DVec3::ZERO).y && top.right == DVec3::X);
    }

    #[test]
    fn up_along_the_eye_is_known_and_a_point_has_a_neighbourhood() {
        let view = View { eye: DVec3::Z, up: Some(DVec3::Z * 2.0), perspective: false };
        assert!(view.up_is_lost());
        let camera = Camera::framing(&view, &corners(), &[DVec3::ONE], &frame());
        assert!(camera.scale.is_finite() && camera.scale > 0.0);
        let spot = camera.project(DVec3::ONE);
        assert!((spot.x - 110.0).abs() < 0.001 && (spot.y - 70.0).abs() < 0.001);
        let one = Camera::framing(&view, &[DVec3::ONE], &[], &frame());
        assert!(one.scale.is_finite() && one.project(DVec3::ONE).x == 110.0);
    }
}

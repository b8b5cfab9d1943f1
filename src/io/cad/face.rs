//! Trimmed surfaces: a base and the loops of curves on it.

use glam::DVec3;

use crate::base::tolerance::{NEAR_MISS, ONE_BORDER, Tolerance};
use crate::geometry::Motion;
use crate::geometry::closest;
use crate::io::cad::base_surface::Base;
use crate::io::cad::border::Border;
use crate::io::cad::healing::{Off, Rule};
use crate::io::cad::natural_bounds::{Allowance, is_natural, matched};
use crate::surface::{Nearest, Side, Surface};

/// A part of a surface inside an outer loop and outside inner ones.
#[derive(Clone, Debug)]
pub struct Face {
    /// The surface it is part of.
    pub base: Surface,
    /// Other surfaces that are all of the face with it; only where it has no loops.
    pub also: Vec<Surface>,
    /// The outer loop; `None`: the surface's own border.
    pub outer: Option<Vec<Border>>,
    /// Loops of holes.
    pub holes: Vec<Vec<Border>>,
    /// The face looks the other way than the base.
    pub flipped: bool,
    /// The base lies in a plane.
    pub flat: bool,
    /// The normal of the base is against the file's.
    pub against: bool,
    /// A point inside its loops by their (u, v), where the file has all of them.
    pub inside: Option<DVec3>,
    /// Largest distance found of its curves from the base, and of the end of each from the start of the next, model units.
    pub off: Off,
    /// What may lie between two points that the file calls one, model units.
    pub slack: f64,
}

/// What is known of a face beside its surface and the curves of its loops.
#[derive(Clone, Copy, Debug)]
pub struct Known {
    /// The first loop bounds the face from outside.
    pub has_outer: bool,
    /// The normal of the surface is against the file's.
    pub against: bool,
    /// A point inside the loops, where one is known.
    pub inside: Option<DVec3>,
    /// What may lie between two points that the file calls one, model units.
    pub slack: f64,
}

impl Face {
    /// All of a surface.
    pub fn whole(base: &Base, surface: Surface, tolerance: &Tolerance) -> Self {
        let (flat, against) = (base.is_flat(tolerance), base.is_against());
        Self {
            base: surface,
            also: Vec::new(),
            outer: None,
            holes: Vec::new(),
            flipped: false,
            flat,
            against,
            inside: None,
            off: Off::NONE,
            slack: 0.0,
        }
    }

    /// The part of a surface inside its loops.
    pub fn inside(base: &Base, surface: Surface, mut loops: Vec<Vec<Border>>, known: Known, tolerance: &Tolerance) -> Self {
        if let ([outer], true) = (loops.as_slice(), known.has_outer)
            && let Some(gap) = matched(base, &surface, outer, ONE_BORDER * tolerance.point, tolerance)
        {
            let off = Off { distance: gap, place: outer[0].space.start(), rule: Rule::Border };
            return Self { against: known.against, inside: known.inside, off, slack: known.slack, ..Self::whole(base, surface, tolerance) };
        }
        let off = off(&surface, &loops);
        for border in &mut loops {
            cut_at_poles(&surface, border, NEAR_MISS * known.slack);
        }
        let mut loops = loops.into_iter();
        let outer = if known.has_outer { loops.next() } else { None };
        // Round a closed surface the seam in an outer loop decides which side of the other loops is meant.
        let seam_decides = surface.closed() != (false, false) && loops.len() > 0;
        let allowed = Allowance { seam: known.slack.max(2.0 * off.distance), free: ONE_BORDER * tolerance.point };
        let outer = outer.filter(|outer| seam_decides || !is_natural(base, &surface, outer, allowed, tolerance));
        Self {
            base: surface,
            also: Vec::new(),
            outer,
            holes: loops.collect(),
            flipped: false,
            flat: base.is_flat(tolerance),
            against: known.against,
            inside: known.inside,
            off,
            slack: known.slack,
        }
    }
}

impl Face {
    /// Moved by a motion; one that mirrors keeps the side it looks to.
    pub fn moved(&self, motion: &Motion) -> Self {
        let transformed = |border: &Vec<Border>| {
            let one = |b: &Border| Border { space: b.space.moved(motion), uv: b.uv.clone() };
            border.iter().map(one).collect::<Vec<Border>>()
        };
        Self {
            base: self.base.moved(motion),
            also: self.also.iter().map(|surface| surface.moved(motion)).collect(),
            outer: self.outer.as_ref().map(transformed),
            holes: self.holes.iter().map(transformed).collect(),
            flipped: self.flipped != motion.mirrors(),
            against: self.against != motion.mirrors(),
            inside: self.inside.map(|p| motion.point(p)),
            slack: self.slack * motion.scale(),
            off: Off { distance: self.off.distance * motion.scale(), place: motion.point(self.off.place), ..self.off },
            ..*self
        }
    }
}

/// Cuts curves where they run through a pole of the surface: their (u, v) jump there.
fn cut_at_poles(surface: &Surface, border: &mut Vec<Border>, room: f64) {
    for k in 0..surface.n_sides() {
        let Side::Pole(pole) = surface.side(k) else { continue };
        let mut cut = Vec::with_capacity(border.len());
        for piece in border.drain(..) {
            let found = closest(&piece.space, pole);
            let inside = |end: DVec3| found.point.distance(end) > room;
            if found.distance <= room && inside(piece.space.start()) && inside(piece.space.end()) {
                let (a, b) = piece.space.domain();
                cut.push(Border { space: piece.space.part(a, found.t), uv: None });
                cut.push(Border { space: piece.space.part(found.t, b), uv: None });
            } else {
                cut.push(piece);
            }
        }
        // At the pole the loop begins: its (u, v) jump there and nowhere else.
        if let Some(first) = cut.iter().position(|b| b.space.start().distance(pole) <= room) {
            cut.rotate_left(first);
        }
        *border = cut;
    }
}

/// Places along a curve at which its distance from the surface is measured.
const SAMPLES: usize = 8;

/// Largest distance of the curves from the surface, and of the end of each from the start of the next one in its loop.
pub fn off(surface: &Surface, loops: &[Vec<Border>]) -> Off {
    let nearest = Nearest::new(surface);
    let foot = |p: DVec3| match surface.flat_uv(p) {
        Some((u, v)) => p.distance(surface.point(u, v)),
        None => nearest.at(p).distance,
    };
    let mut widest = Off::NONE;
    for border in loops {
        for (k, curve) in border.iter().enumerate() {
            let (a, b) = curve.space.domain();
            for i in 0..=SAMPLES {
                let at = curve.space.point(a + (b - a) * i as f64 / SAMPLES as f64);
                widest = widest.or(foot(at), at, Rule::Border);
            }
            let end = curve.space.end();
            widest = widest.or(end.distance(border[(k + 1) % border.len()].space.start()), end, Rule::Ends);
        }
    }
    widest
}

/// What any surface with these loops as border has at least: the area that the first spans in a plane, less those of the others.
pub fn least_area(loops: &[&Vec<Border>]) -> f64 {
    let spanned = |border: &Vec<Border>| {
        let along = |b: &Border| {
            let (t0, t1) = b.space.domain();
            (0..SAMPLES).map(|k| b.space.point(t0 + (t1 - t0) * k as f64 / SAMPLES as f64)).collect::<Vec<DVec3>>()
        };
        let points: Vec<DVec3> = border.iter().flat_map(along).collect();
        let first = points.first().copied().unwrap_or_default();
        0.5 * points.windows(2).map(|w| (w[0] - first).cross(w[1] - first)).sum::<DVec3>().length()
    };
    let areas: Vec<f64> = loops.iter().map(|border| spanned(border)).collect();
    (areas.first().copied().unwrap_or_default() - areas.iter().skip(1).sum::<f64>()).max(0.0)
}

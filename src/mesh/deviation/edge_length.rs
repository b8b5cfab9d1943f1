//! How long an edge may be for triangles at it to keep chord error and angle: by curvatures, by samples, or by bounds.

use glam::{DVec2, DVec3};

use crate::mesh::chart::parametric_surface::Spot;
use crate::mesh::deviation::bend_bounds::{on_side, turning};
use crate::mesh::deviation::triangle;
use crate::mesh::request::limits::Limits;
use crate::mesh::request::plan::TALL;
use crate::surface::{Evaluator, Jet2};

/// What steers the search for the length of an edge.
struct EdgeLengthSettings {
    /// Least length over the chord error: a triangle as small keeps it however the surface bends, for no place over it is further away.
    min_over_limit: f64,
    /// Lengths tried by samples before any is bounded.
    samples: usize,
    /// Lengths bounded until one keeps the limit.
    tries: usize,
    /// The same for triangles beside a coarse border.
    coarse_tries: usize,
    /// A length that is made smaller is made smaller by this factor more.
    shrink: f64,
    /// Share of a limit that an edge of a coarse border uses up, at least and at most: the rest is left to the height of triangles.
    used_share: (f64, f64),
    /// Height over base of the triangles beside a coarse border, at least and at most.
    aspect: (f64, f64),
    /// The most that such a triangle is sheared along the border, over its height.
    max_shear: f64,
    /// Share of such a height that must be left of it on the surface.
    min_kept_height: f64,
}

const SETTINGS: EdgeLengthSettings = EdgeLengthSettings {
    min_over_limit: 0.5,
    samples: 2,
    tries: 2,
    coarse_tries: 8,
    shrink: 0.98,
    used_share: (0.5, 0.9),
    aspect: (0.001, 2.0),
    max_shear: 1.5,
    min_kept_height: 0.25,
};

/// Where an edge lies.
#[derive(Clone, Copy)]
pub struct EdgePlace<'a> {
    /// Its middle in (u, v).
    pub at: DVec2,
    /// The surface there.
    pub jet: &'a Jet2,
    /// Its direction in space, of any length.
    pub along: DVec3,
}

/// Wanted edge length for limits at a place: of an equilateral triangle, however it lies.
///
/// On the local quadric of principal curvatures k1 ≥ |k2| it is at most k1 h² (1/8 + max(k2/k1, 0)/24) away.
pub fn wanted(jet: &Jet2, chord: Option<f64>, angle: Option<f64>) -> f64 {
    let normal = jet.du.cross(jet.dv).normalize_or_zero();
    let (mean, half_difference) = jet.curvatures(normal);
    let (k1, k2) = (mean.abs() + half_difference, mean.abs() - half_difference);
    if !(k1 > 0.0 && k1.is_finite()) {
        return f64::INFINITY;
    }
    let share = 1.0 / 8.0 + (k2 / k1).max(0.0) / 24.0;
    let by_chord = chord.map_or(f64::INFINITY, |limit| (limit / (k1 * share)).sqrt().max(SETTINGS.min_over_limit * limit));
    let by_angle = angle.map_or(f64::INFINITY, |limit| limit / k1);
    by_chord.min(by_angle)
}

/// The longest side up to `from` of an equilateral triangle over an edge that provably keeps a chord error, to either side of the edge where
/// the surface is.
pub fn bounded(evaluator: Evaluator, edge: EdgePlace, limit: f64, from: f64) -> f64 {
    longest(evaluator, edge, limit, from, Apex { tall: TALL, shear: 0.0, held: false, tries: SETTINGS.tries })
}

/// The same by samples, for a twentieth of the work: a first guess where triangles are bounded later.
pub fn sampled(evaluator: Evaluator, edge: EdgePlace, limit: f64, from: f64) -> f64 {
    longest(evaluator, edge, limit, from, Apex { tall: TALL, shear: 0.0, held: false, tries: 0 })
}

/// Triangles over an edge.
struct Apex {
    /// Height over base.
    tall: f64,
    /// How far it stands along the base off the middle of it, over the height.
    shear: f64,
    /// What stands out of the surface is held on its border; otherwise it is none.
    held: bool,
    /// Lengths tried that are bounded; before them as many are sampled as are for a guess.
    tries: usize,
}

/// The longest base up to `from` of triangles that keep a chord error.
fn longest(evaluator: Evaluator, EdgePlace { at, jet, along }: EdgePlace, limit: f64, from: f64, apex: Apex) -> f64 {
    let Apex { tall, shear, held, tries } = apex;
    let surface = evaluator.surface();
    let spot = Spot { p: jet.p, dx: jet.du, dy: jet.dv };
    let normal = spot.normal();
    let Some(along) = along.reject_from_normalized(normal).try_normalize() else { return from };
    let closed = turning(surface);
    let inside = |uv: DVec2| surface.is_flat() || (closed.0 || (0.0..=1.0).contains(&uv.x)) && (closed.1 || (0.0..=1.0).contains(&uv.y));
    let point = |uv: DVec2| evaluator.point(uv.x, uv.y);
    // Over the line of the base, however far along it the apex is sheared.
    let across = normal.cross(along);
    let aside = across + along * shear;
    let height = |uv: DVec2| (jet.du * (uv.x - at.x) + jet.dv * (uv.y - at.y)).dot(across).abs();
    let (mut h, least) = (from, (SETTINGS.min_over_limit * limit).min(from));
    for way in [aside, -aside] {
        for k in 0..SETTINGS.samples + tries {
            if h <= least {
                return least;
            }
            let corners = [along * (-0.5 * h), along * (0.5 * h), way * (tall * h)].map(|d| spot.step(d).map(|step| at + step));
            let [Some(a), Some(b), Some(c)] = corners else { break };
            let hold = |uv: DVec2| {
                DVec2::new(if closed.0 { uv.x } else { uv.x.clamp(0.0, 1.0) }, if closed.1 { uv.y } else { uv.y.clamp(0.0, 1.0) })
            };
            let kept = hold(c);
            let out = if held { height(kept) < SETTINGS.min_kept_height * height(c) } else { !inside(c) };
            if out {
                break;
            }
            let c = if held { kept } else { c };
            let uv = [hold(a), hold(b), c].map(|corner| on_side(surface, at, c, corner));
            let p = uv.map(point);
            let guessed = if k < SETTINGS.samples { triangle::sampled(&point, uv, p) / limit } else { 1.0 };
            let ratio = if guessed <= 1.0 && tries > 0 { triangle::chord(evaluator, uv, None, p, limit) / limit } else { guessed };
            if ratio <= 1.0 {
                break;
            }
            h *= (SETTINGS.shrink / ratio.sqrt()).max(0.5);
        }
    }
    h
}

/// Wanted length of an edge of a border, where triangles may be long, on a face that is nowhere wider than `wide`: by the curvature along
/// it, and by the twist; where triangles may be `sheared` along the border, by what is left of the twist for those that are sheared to
/// where there is none, as along the lines of a cylinder.
///
/// Of errors A h² + B w² ≤ c along and across, the longest triangles have half in each, or all of the first where the second is
/// small all over the face.
pub fn on_coarse_border(evaluator: Evaluator, edge: EdgePlace, limits: &Limits, wide: f64, sheared: bool) -> f64 {
    let EdgePlace { jet, along, .. } = edge;
    let spot = Spot { p: jet.p, dx: jet.du, dy: jet.dv };
    let normal = spot.normal();
    let Some(along) = along.reject_from_normalized(normal).try_normalize() else { return f64::INFINITY };
    let (Some(x), Some(y)) = (spot.step(along), spot.step(normal.cross(along))) else { return f64::INFINITY };
    let form = |a: DVec2, b: DVec2| (jet.duu * (a.x * b.x) + jet.duv * (a.x * b.y + a.y * b.x) + jet.dvv * (a.y * b.y)).dot(normal);
    let (bend, twist) = (form(x, x), form(x, y));
    let turned = (bend * bend + twist * twist).sqrt();
    // Where more shear would be needed there is none: lines of the surface do not run along it there.
    let shear = if sheared && twist.abs() <= SETTINGS.max_shear * bend.abs() && twist != 0.0 { -twist / bend } else { 0.0 };
    let across = (form(y, y) + shear * (2.0 * twist + shear * bend)).abs();
    let (bend, twist) = (bend.abs(), (twist + shear * bend).abs());
    let used = |rest: f64| (1.0 - rest).clamp(SETTINGS.used_share.0, SETTINGS.used_share.1);
    let by_chord = limits.chord.map_or(f64::INFINITY, |limit| {
        let most = 8.0 * limit;
        let plain = (most * used(across * wide * wide / most) / (bend + twist)).sqrt().min(wide);
        // The height at which the rest is used up.
        let tall = ((1.0 - used(across * wide * wide / most)) * most / across).sqrt().min(wide) / plain;
        let apex = Apex { tall: tall.clamp(SETTINGS.aspect.0, SETTINGS.aspect.1), shear, held: true, tries: SETTINGS.coarse_tries };
        longest(evaluator, EdgePlace { along, ..edge }, limit, plain, apex)
    });
    let by_angle = limits.angle.map_or(f64::INFINITY, |limit| limit * used(across * wide / limit) / turned);
    by_chord.min(by_angle)
}

//! How far a triangle may be from its surface: bounded by interval arithmetic, not sampled.
//!
//! Along the triangle's normal n, the surface less the triangle's plane is a function of (u, v) that vanishes at the three
//! corners. With second derivatives H = M ± R over the triangle's box, at barycentric λ it is
//! −½ Σ λi λj (eᵀ M e + eᵀ R e) over the three sides e: Taylor's formula about the point, and Σ λi (vi − x)(vi − x)ᵀ =
//! Σ λi λj e eᵀ. For constant H this is exact.

use glam::{DVec2, DVec3};

use crate::base::range::Interval3;
use crate::base::tolerance::NUDGE;
use crate::mesh::chart::parametric_surface::Spot;
use crate::mesh::deviation::poles;
use crate::mesh::request::plan::TALL;
use crate::surface::core::power_form::{Bends, PowerForm};
use crate::surface::{Domain, Jet2, Surface};

/// Share of the box of a triangle by which it is widened: feet of its points lie a little beside their (u, v).
const WIDER: f64 = 0.05;

/// Bounds over a box of (u, v) inside the surface's own; `None` where nothing is known.
fn bent(surface: &Surface, quick: Option<&PowerForm>, (low, high): (DVec2, DVec2), normal: DVec3) -> Option<Bends> {
    if let Some(bends) = quick.and_then(|quick| quick.bends((low, high), normal)) {
        return Some(bends);
    }
    let enclosure = surface.enclosure((low.x, high.x), (low.y, high.y));
    let all = [enclosure.duu, enclosure.duv, enclosure.dvv];
    if all.iter().any(Interval3::is_unbounded) {
        return None;
    }
    let along = all.map(|r| r.along(normal));
    Some(Bends { mid: along.map(|r| 0.5 * (r.low + r.high)), slack: along.map(|r| 0.5 * (r.high - r.low)), jump: 0.0 })
}

/// Bounds over any box: where the surface closes, parameters go on over the seam.
pub fn bent_over(surface: &Surface, quick: Option<&PowerForm>, (low, high): (DVec2, DVec2), normal: DVec3) -> Option<Bends> {
    let closed = turning(surface);
    if surface.is_flat() || low.cmpge(DVec2::ZERO).all() && high.cmple(DVec2::ONE).all() {
        return bent(surface, quick, (low, high), normal);
    }
    let mut whole: Option<Bends> = None;
    for (x0, x1) in turns(low.x, high.x, closed.0).into_iter().flatten() {
        for (y0, y1) in turns(low.y, high.y, closed.1).into_iter().flatten() {
            let own = bent(surface, quick, (DVec2::new(x0, y0), DVec2::new(x1, y1)), normal)?;
            whole = Some(whole.map_or(own, |w| w.union(&own)));
        }
    }
    whole
}

/// Directions in which parameters may go on over a seam.
fn turning(surface: &Surface) -> (bool, bool) {
    if surface.domain() == Domain::Loop { surface.closed() } else { (false, false) }
}

/// An interval in 0…1: held there, or cut at the seams of a closed direction and each part turned back.
fn turns(low: f64, high: f64, closed: bool) -> [Option<(f64, f64)>; 2] {
    if !closed {
        return [Some((low.clamp(0.0, 1.0), high.clamp(0.0, 1.0))), None];
    }
    if high - low >= 1.0 {
        return [Some((0.0, 1.0)), None];
    }
    let (low, high) = (low - low.floor(), high - low.floor());
    if high <= 1.0 { [Some((low, high)), None] } else { [Some((low, 1.0)), Some((0.0, high - 1.0))] }
}

/// How often a triangle is quartered when the bound over the whole of it does not do.
const PARTS: u32 = 3;

/// Largest distance of a triangle from the surface, by the places and points of its corners; infinite where the surface
/// has no bounded second derivative. `quick` is the surface made ready, where it can be.
///
/// Of a triangle with a corner at a pole a second one in (u, v) belongs to it, with two corners there: each is looked at. A bound above
/// `wanted` is found by parts, with the heights at their corners: of a part half as wide what is not known of the
/// bend weighs an eighth. Nearly what there is, for some five times the work.
pub fn chord(of: (&Surface, Option<&PowerForm>), (uv, second): ([DVec2; 3], Option<[DVec2; 3]>), p: [DVec3; 3], wanted: f64) -> f64 {
    let normal = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
    if normal == DVec3::ZERO {
        return in_any_direction(of.0, uv);
    }
    let most = |of| {
        let first = above_plane(of, uv, (p[0], normal), wanted);
        match second {
            Some(second) if first <= wanted => first.max(above_plane(of, second, (p[0], normal), wanted)),
            _ => first,
        }
    };
    let found = most(of);
    if found > wanted && of.1.is_some() && goes_round_tip(of, uv) { found.min(most((of.0, None))) } else { found }
}

/// Whether a triangle goes a good part of the way round a tip: bounds of third derivatives are those of a whole box, and do not get less
/// with the distance from it.
fn goes_round_tip(of: (&Surface, Option<&PowerForm>), uv: [DVec2; 3]) -> bool {
    let (low, high) = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
    let middle = 0.5 * (low + high);
    let tangents = |at: DVec2| of.0.tangents_by(of.1, at.x, at.y);
    let at = [DVec2::new(middle.x, middle.y.round()), DVec2::new(middle.x.round(), middle.y)];
    (high - low).max_element() > ROUND && at.into_iter().any(|at| poles::tip(of.0, &tangents, at).is_some())
}

/// Width in (u, v) from which a triangle goes round a tip.
const ROUND: f64 = 0.03;

/// The most that the surface over a triangle of (u, v) is off a plane in which its corners are.
fn above_plane(of: (&Surface, Option<&PowerForm>), uv: [DVec2; 3], (on, normal): (DVec3, DVec3), wanted: f64) -> f64 {
    let first = part(of, uv, normal, None);
    if first <= wanted || first > TOO_FAR * wanted {
        return first;
    }
    let height = |uv: DVec2| {
        let at = of.0.point_by(of.1, uv.x, uv.y);
        (at - on).dot(normal)
    };
    let quarter = |uv: [DVec2; 3], above: [f64; 3]| {
        let middle = |i: usize, j: usize| 0.5 * (uv[i] + uv[j]);
        let m = [middle(1, 2), middle(2, 0), middle(0, 1)];
        let f = m.map(height);
        let corner = |k: usize| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            ([uv[k], m[j], m[i]], [above[k], f[j], f[i]])
        };
        let seen = f.into_iter().fold(0.0, |seen: f64, f| seen.max(f.abs()));
        ([(m, f), corner(0), corner(1), corner(2)], seen)
    };
    let (mut worst, mut open) = (0.0_f64, Vec::with_capacity(4 * PARTS as usize));
    let mut next = Some((uv, [0.0_f64; 3], PARTS));
    while let Some((uv, above, left)) = next {
        let (parts, seen) = quarter(uv, above);
        if seen > wanted {
            return seen;
        }
        for (uv, above) in parts {
            let bound = part(of, uv, normal, Some(above));
            if bound > wanted && left > 1 {
                open.push((uv, above, left - 1));
            } else if bound > wanted {
                return bound;
            } else {
                worst = worst.max(bound);
            }
        }
        next = open.pop();
    }
    worst
}

/// How far the surface over a triangle of (u, v) may be from the places between its corners in space, in any direction: |S − L| where L is linear
/// and S at the corners. Infinite where no second derivative is bounded; nothing where (u, v) are on a line, as in a pole.
///
/// A bound for three corners on a line, which have no plane, and for a triangle that stands on edge.
pub fn in_any_direction(surface: &Surface, uv: [DVec2; 3]) -> f64 {
    if (uv[1] - uv[0]).perp_dot(uv[2] - uv[0]).abs() <= NUDGE * NUDGE {
        return 0.0;
    }
    let (low, high) = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
    let hold = |x: f64| x.clamp(0.0, 1.0);
    let enclosure = surface.enclosure((hold(low.x), hold(high.x)), (hold(low.y), hold(high.y)));
    let all = [enclosure.duu, enclosure.duv, enclosure.dvv];
    if all.iter().any(Interval3::is_unbounded) {
        return f64::INFINITY;
    }
    over_sides(&Bends { mid: [0.0; 3], slack: all.map(|r| r.reach()), jump: 0.0 }, uv, high - low)
}

/// How far the surface over a triangle of (u, v) is from a plane along its normal, by the heights of the corners where they
/// are not in the plane.
fn part((surface, quick): (&Surface, Option<&PowerForm>), uv: [DVec2; 3], normal: DVec3, above: Option<[f64; 3]>) -> f64 {
    let (low, high) = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
    let width = high - low;
    let whole = beside_kinks(surface, (low, high), (low - width * WIDER, high + width * WIDER));
    bent_over(surface, quick, whole, normal)
        .map_or(f64::INFINITY, |bends| above.map_or_else(|| over_sides(&bends, uv, width), |above| over_corners(above, &bends, uv, width)))
}

/// A bound farther off than this is not looked at by parts.
const TOO_FAR: f64 = 8.0;

/// Second derivatives over the box of a triangle, `width` wide, along its sides in the order of the corners opposite: in the
/// middle, and how far they may be from there.
fn forms(Bends { mid, slack, .. }: &Bends, uv: [DVec2; 3], width: DVec2) -> [(f64, f64); 3] {
    // 2 |x y| ≤ a x² + y² / a, with a that makes both alike over the box.
    let a = if width.x > 0.0 && width.y > 0.0 { width.y / width.x } else { 1.0 };
    let (ru, rv) = (slack[0] + slack[1] * a, slack[2] + slack[1] / a);
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
        let e = uv[j] - uv[i];
        let m = mid[0] * e.x * e.x + 2.0 * mid[1] * e.x * e.y + mid[2] * e.y * e.y;
        (m, ru * e.x * e.x + rv * e.y * e.y)
    })
}

/// The bound of a triangle by second derivatives over its box, `width` wide.
pub fn over_sides(bends: &Bends, uv: [DVec2; 3], width: DVec2) -> f64 {
    let forms = forms(bends, uv, width);
    bends.jump + 0.5 * most(forms.map(|(m, r)| m + r)).max(most(forms.map(|(m, r)| r - m)))
}

/// The same where the corners are so far above the plane.
fn over_corners(above: [f64; 3], bends: &Bends, uv: [DVec2; 3], width: DVec2) -> f64 {
    let forms = forms(bends, uv, width);
    let highest = highest(above, forms.map(|(m, r)| 0.5 * (r - m)));
    bends.jump + highest.max(crate::mesh::deviation::triangle::highest(above.map(|f| -f), forms.map(|(m, r)| 0.5 * (r + m))))
}

/// The most that Σ a λi + Σ c λi λj can be for barycentric λ, `c` in the order of the sides opposite the corners.
fn highest(a: [f64; 3], c: [f64; 3]) -> f64 {
    let mut highest = a[0].max(a[1]).max(a[2]);
    for k in 0..3 {
        let (from, to, bend) = (a[(k + 1) % 3], a[(k + 2) % 3], c[k]);
        let t = 0.5 + 0.5 * (to - from) / bend;
        if bend > 0.0 && t > 0.0 && t < 1.0 {
            highest = highest.max(from + t * t * bend);
        }
    }
    // Inside, by λ1 and λ2.
    let (p, q, r) = (c[2], c[1], c[2] + c[1] - c[0]);
    let (x, y) = (a[1] - a[0] + p, a[2] - a[0] + q);
    let det = 4.0 * p * q - r * r;
    let (l1, l2) = ((2.0 * q * x - r * y) / det, (2.0 * p * y - r * x) / det);
    if p > 0.0 && det > 0.0 && l1 > 0.0 && l2 > 0.0 && l1 + l2 < 1.0 {
        highest = highest.max(a[0] + 0.5 * (x * l1 + y * l2));
    }
    highest
}

/// The longest side up to `from` of an equilateral triangle that keeps a chord error for sure: over an edge along `along`
/// with its middle at a place, to either side of it where the surface is.
pub fn surely(surface: (&Surface, Option<&PowerForm>), (at, jet): (DVec2, &Jet2), along: DVec3, (limit, from): (f64, f64)) -> f64 {
    surely_tall(surface, (at, jet), along, (limit, from), Apex { tall: TALL, shear: 0.0, held: false, tries: TRIES })
}

/// The same by samples, for a twentieth of the work: a first guess where triangles are bounded later.
pub fn likely(surface: (&Surface, Option<&PowerForm>), (at, jet): (DVec2, &Jet2), along: DVec3, (limit, from): (f64, f64)) -> f64 {
    surely_tall(surface, (at, jet), along, (limit, from), Apex { tall: TALL, shear: 0.0, held: false, tries: 0 })
}

/// Sides of a triangle over the chord error that it keeps however the surface bends: no place over it is further away.
const SMALL: f64 = 0.5;

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

/// The same of other triangles.
fn surely_tall(
    (surface, quick): (&Surface, Option<&PowerForm>),
    (at, jet): (DVec2, &Jet2),
    along: DVec3,
    (limit, from): (f64, f64),
    Apex { tall, shear, held, tries }: Apex,
) -> f64 {
    let spot = Spot { p: jet.p, dx: jet.du, dy: jet.dv };
    let normal = spot.normal();
    let Some(along) = along.reject_from_normalized(normal).try_normalize() else { return from };
    let closed = turning(surface);
    let inside = |uv: DVec2| surface.is_flat() || (closed.0 || (0.0..=1.0).contains(&uv.x)) && (closed.1 || (0.0..=1.0).contains(&uv.y));
    let point = |uv: DVec2| surface.point_by(quick, uv.x, uv.y);
    // Over the line of the base, however far along it the apex leans.
    let across = normal.cross(along);
    let aside = across + along * shear;
    let height = |uv: DVec2| (jet.du * (uv.x - at.x) + jet.dv * (uv.y - at.y)).dot(across).abs();
    let (mut h, least) = (from, (SMALL * limit).min(from));
    for way in [aside, -aside] {
        for k in 0..GUESSES + tries {
            if h <= least {
                return least;
            }
            let corners = [along * (-0.5 * h), along * (0.5 * h), way * (tall * h)].map(|d| spot.step(d).map(|step| at + step));
            let [Some(a), Some(b), Some(c)] = corners else { break };
            let hold = |uv: DVec2| {
                DVec2::new(if closed.0 { uv.x } else { uv.x.clamp(0.0, 1.0) }, if closed.1 { uv.y } else { uv.y.clamp(0.0, 1.0) })
            };
            let kept = hold(c);
            let out = if held { height(kept) < LOW * height(c) } else { !inside(c) };
            if out {
                break;
            }
            let c = if held { kept } else { c };
            let uv = [hold(a), hold(b), c].map(|corner| on_side(surface, (at, c), corner));
            let p = uv.map(point);
            let guessed = if k < GUESSES { sampled(&point, uv, p) / limit } else { 1.0 };
            let load = if guessed <= 1.0 && tries > 0 { chord((surface, quick), (uv, None), p, limit) / limit } else { guessed };
            if load <= 1.0 {
                break;
            }
            h *= (LESS / load.sqrt()).max(0.5);
        }
    }
    h
}

/// How far the surface is from a triangle in the middles of its sides and in its own.
pub fn sampled(point: &impl Fn(DVec2) -> DVec3, uv: [DVec2; 3], p: [DVec3; 3]) -> f64 {
    let normal = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
    let middle = |i: usize, j: usize| 0.5 * (uv[i] + uv[j]);
    let places = [middle(0, 1), middle(1, 2), middle(2, 0), (uv[0] + uv[1] + uv[2]) / 3.0];
    places.into_iter().map(|at| (point(at) - p[0]).dot(normal).abs()).fold(0.0, f64::max)
}

/// A place held on the side of each kink line on which another is, or where that is on the line, a third.
fn on_side(surface: &Surface, (at, beyond): (DVec2, DVec2), mut place: DVec2) -> DVec2 {
    let (us, vs) = surface.kinks();
    for (axis, kinks) in [us, vs].into_iter().enumerate() {
        for kink in kinks.iter().copied() {
            let below = if (at[axis] - kink).abs() > NUDGE { at[axis] < kink } else { beyond[axis] < kink };
            place[axis] = if below { place[axis].min(kink) } else { place[axis].max(kink) };
        }
    }
    place
}

/// Lengths guessed by samples.
const GUESSES: usize = 2;
/// Lengths tried until one keeps a limit for sure.
const TRIES: usize = 2;
/// What is made smaller is made a little more so.
const LESS: f64 = 0.98;

/// The wider one of two boxes in (u, v), held on the side of each kink line on which the other lies: a triangle beside a kink
/// line sees nothing of what is beyond.
fn beside_kinks(surface: &Surface, own: (DVec2, DVec2), (mut low, mut high): (DVec2, DVec2)) -> (DVec2, DVec2) {
    let (us, vs) = surface.kinks();
    for (axis, kinks) in [us, vs].into_iter().enumerate() {
        for kink in kinks.iter().copied() {
            if low[axis] < kink && own.0[axis] >= kink - NUDGE {
                low[axis] = kink;
            } else if high[axis] > kink && own.1[axis] <= kink + NUDGE {
                high[axis] = kink;
            }
        }
    }
    (low, high)
}

/// The most that Σ c λi λj can be for barycentric λ, `c` in the order of the sides opposite the corners.
fn most(c: [f64; 3]) -> f64 {
    let on_side = c.iter().fold(0.0_f64, |m, c| m.max(0.25 * c));
    stationary(c).map_or(on_side, |(value, _)| on_side.max(value))
}

/// The value of Σ c λi λj where it is stationary, and the barycentric λ of that place; `None` where that is outside of the triangle.
pub fn stationary(c: [f64; 3]) -> Option<(f64, [f64; 3])> {
    // The three derivatives are equal: λ ∝ c_a (c_b + c_c − c_a).
    let weight = |k: usize| c[k] * (c[(k + 1) % 3] + c[(k + 2) % 3] - c[k]);
    let w = [weight(0), weight(1), weight(2)];
    let sum: f64 = w.iter().sum();
    let l = w.map(|x| x / sum);
    l.iter().all(|x| *x > 0.0).then(|| (c[0] * l[1] * l[2] + c[1] * l[2] * l[0] + c[2] * l[0] * l[1], l))
}

/// Wanted edge length for limits at a place: of an equilateral triangle, however it lies.
///
/// On the local quadric of principal curvatures k1 ≥ |k2| it is at most k1 h² (1/8 + max(k2/k1, 0)/24) away.
pub fn wanted(jet: &Jet2, chord: Option<f64>, angle: Option<f64>) -> f64 {
    let normal = jet.du.cross(jet.dv).normalize_or_zero();
    let (mean, enclosure) = jet.curvatures(normal);
    let (k1, k2) = (mean.abs() + enclosure, mean.abs() - enclosure);
    if !(k1 > 0.0 && k1.is_finite()) {
        return f64::INFINITY;
    }
    let share = 1.0 / 8.0 + (k2 / k1).max(0.0) / 24.0;
    let by_chord = chord.map_or(f64::INFINITY, |limit| (limit / (k1 * share)).sqrt().max(SMALL * limit));
    let by_angle = angle.map_or(f64::INFINITY, |limit| limit / k1);
    by_chord.min(by_angle)
}

/// The most of a limit that an edge of a border uses up, and the least that is worth leaving to it.
const MOST_USED: f64 = 0.9;
const LEAST_USED: f64 = 0.5;

/// The most that a triangle leans along a border, over its height.
const MOST_SHEAR: f64 = 1.5;
/// Share of a height that must be left of it on the surface.
const LOW: f64 = 0.25;
/// Heights over bases of triangles that stand for those beside a border.
const LEAST_TALL: f64 = 0.001;
const MOST_TALL: f64 = 2.0;
/// Lengths tried for them.
const MORE_TRIES: usize = 8;

/// Wanted length of an edge along a direction of a border, where triangles may be long, on a face that is nowhere wider than
/// `wide`: by the curvature along it, and by the twist; where triangles may lean along the border, `leans`, by what is left of the twist for those
/// that lean to where there is none, as along the lines of a cylinder.
///
/// Of errors A h² + B w² ≤ c along and across, the longest triangles have half in each, or all of the first where the second is
/// small all over the face.
pub fn wanted_along(
    surface: (&Surface, Option<&PowerForm>),
    (at, jet): (DVec2, &Jet2),
    along: DVec3,
    (chord, angle): (Option<f64>, Option<f64>),
    (wide, leans): (f64, bool),
) -> f64 {
    let spot = Spot { p: jet.p, dx: jet.du, dy: jet.dv };
    let normal = spot.normal();
    let Some(along) = along.reject_from_normalized(normal).try_normalize() else { return f64::INFINITY };
    let (Some(x), Some(y)) = (spot.step(along), spot.step(normal.cross(along))) else { return f64::INFINITY };
    let form = |a: DVec2, b: DVec2| (jet.duu * (a.x * b.x) + jet.duv * (a.x * b.y + a.y * b.x) + jet.dvv * (a.y * b.y)).dot(normal);
    let (bend, twist) = (form(x, x), form(x, y));
    let turned = (bend * bend + twist * twist).sqrt();
    // Where it would have to lean further it does not at all: lines of the surface do not run along it there.
    let shear = if leans && twist.abs() <= MOST_SHEAR * bend.abs() && twist != 0.0 { -twist / bend } else { 0.0 };
    let across = (form(y, y) + shear * (2.0 * twist + shear * bend)).abs();
    let (bend, twist) = (bend.abs(), (twist + shear * bend).abs());
    let used = |rest: f64| (1.0 - rest).clamp(LEAST_USED, MOST_USED);
    let by_chord = chord.map_or(f64::INFINITY, |limit| {
        let most = 8.0 * limit;
        let plain = (most * used(across * wide * wide / most) / (bend + twist)).sqrt().min(wide);
        // The height at which the rest is used up.
        let tall = ((1.0 - used(across * wide * wide / most)) * most / across).sqrt().min(wide) / plain;
        let apex = Apex { tall: tall.clamp(LEAST_TALL, MOST_TALL), shear, held: true, tries: MORE_TRIES };
        surely_tall(surface, (at, jet), along, (limit, plain), apex)
    });
    let by_angle = angle.map_or(f64::INFINITY, |limit| limit * used(across * wide / limit) / turned);
    by_chord.min(by_angle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_of_a_form_on_a_triangle() {
        assert!((most([1.0; 3]) - 1.0 / 3.0).abs() < 1e-15);
        assert_eq!(most([4.0, 0.0, 0.0]), 1.0);
        // Against a fine grid.
        for c in [[1.0, 0.5, 0.7], [1.0, -0.5, 0.3], [2.0, 1.9, 0.2], [-1.0, -2.0, -0.5]] {
            let mut best = 0.0_f64;
            for i in 0..=400 {
                for j in 0..=400 - i {
                    let (a, b) = (f64::from(i) / 400.0, f64::from(j) / 400.0);
                    let d = 1.0 - a - b;
                    best = best.max(c[0] * b * d + c[1] * d * a + c[2] * a * b);
                }
            }
            assert!((most(c) - best).abs() < 1e-4, "{c:?}: {} {best}", most(c));
        }
    }

    #[test]
    fn the_most_of_a_form_with_heights_on_a_triangle() {
        let all = [[1.0, 0.5, 0.7], [1.0, -0.5, 0.3], [2.0, 1.9, 0.2], [-1.0, -2.0, -0.5], [0.0; 3], [4.0, 3.0, 5.0]];
        for (a, c) in all.iter().flat_map(|a| all.iter().map(move |c| (*a, *c))) {
            let mut best = f64::NEG_INFINITY;
            for i in 0..=400 {
                for j in 0..=400 - i {
                    let l = [f64::from(i) / 400.0, f64::from(j) / 400.0, 1.0 - f64::from(i + j) / 400.0];
                    let bends = c[0] * l[1] * l[2] + c[1] * l[2] * l[0] + c[2] * l[0] * l[1];
                    best = best.max(a[0] * l[0] + a[1] * l[1] + a[2] * l[2] + bends);
                }
            }
            let found = highest(a, c);
            assert!(found >= best - 1e-12 && found < best + 1e-4, "{a:?} {c:?}: {found} {best}");
            if a == [0.0; 3] {
                assert!((found - most(c).max(0.0)).abs() < 1e-12);
            }
        }
    }
}

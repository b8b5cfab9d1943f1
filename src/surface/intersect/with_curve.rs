//! Where surfaces meet curves: subdivision with guaranteed bounds, Newton's method where there is one meeting
//! or one line. `docs/notes/intersections.md` has the reasons.

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::base::tolerance::{EPSILON, ROUNDING_SHARE, Tolerance};
use crate::geometry::Curve;
use crate::geometry::construct::build::line;
use crate::geometry::data::fault::CurveFault;
use crate::network::fault::MeetingFault;
use crate::network::snap::may_snap;
use crate::network::{Chain, meet as meet_chains};
use crate::surface::closest::foot::step;
use crate::surface::closest::nearest::{Nearest, closest};
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::Domain;
use crate::surface::intersect::coplanar::is_flat;
use crate::surface::intersect::curve_overlap::SHORTEST_OVERLAP;
use crate::surface::intersect::curve_patch::{Contact, CurveTouch, contacts};
use crate::surface::intersect::sheet::{Sheet, grounded, patches};
use crate::surface::rails::side::Side;
use crate::surface::trims::compose::rational;
use crate::surface::trims::trim::over_frame;

/// A meeting of a curve and a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceMeeting {
    /// The place, on the curve.
    pub point: DVec3,
    /// Arc-length fraction of the curve.
    pub f: f64,
    /// Place on the surface.
    pub uv: (f64, f64),
    /// Where an overlap that lies on the surface ends.
    pub overlap_end: Option<f64>,
}

/// Share of the tolerance within which a curve lies in a plane.
const LYING: f64 = 0.5;

/// What stays within the tolerance of a surface for longer lies on it: eight times what a curve as bent as the model is large
/// does that merely touches.
pub(crate) fn long(tolerance: &Tolerance, size: f64) -> f64 {
    const TOUCH: f64 = 8.0;
    TOUCH * (tolerance.point * size.min(tolerance.rounding / ROUNDING_SHARE)).sqrt()
}

/// All meetings of a curve and surfaces within the tolerance, in order along the curve, each place once.
///
/// A touch is one meeting, an overlap that lies on a surface one with both its ends. Of a trimmed surface only the kept
/// part counts. E413 when the work exceeds its limit.
pub fn with_curve(chain: &Chain, surfaces: &[Surface], tolerance: &Tolerance) -> Result<Vec<SurfaceMeeting>> {
    let mut all: Vec<SurfaceMeeting> = Vec::new();
    for surface in surfaces {
        all.extend(CurveSearch::new(surface, tolerance)?.meetings(chain)?);
    }
    Ok(united_meetings(all, chain, tolerance))
}

/// Meetings with surfaces in order along the curve, each place once.
fn united_meetings(mut all: Vec<SurfaceMeeting>, chain: &Chain, tolerance: &Tolerance) -> Vec<SurfaceMeeting> {
    all.sort_by(|a, b| a.f.total_cmp(&b.f));
    let near = tolerance.point / chain.length();
    let mut out: Vec<SurfaceMeeting> = Vec::with_capacity(all.len());
    for m in all {
        match out.last_mut() {
            // Faces side by side share the place on their edge, and overlaps go on.
            Some(last) if m.f <= last.overlap_end.unwrap_or(last.f) + 2.0 * near => {
                if let Some(to) = m.overlap_end {
                    last.overlap_end = Some(last.overlap_end.map_or(to, |f| f.max(to)));
                }
            }
            _ => out.push(m),
        }
    }
    out
}

/// A surface that curves are met with: bounds of it that one curve asked for serve the next.
pub(crate) struct CurveSearch<'a> {
    mapped: &'a Surface,
    /// The same over its own frame where it is a plane: the map of a triangle folds at a corner.
    surface: Surface,
    /// Its patches between kink lines, once they are asked for.
    sheets: Vec<Sheet>,
    tolerance: &'a Tolerance,
}

impl<'a> CurveSearch<'a> {
    /// A surface within a tolerance.
    pub(crate) fn new(mapped: &'a Surface, tolerance: &'a Tolerance) -> Result<Self> {
        Ok(Self { mapped, surface: over_frame(mapped, tolerance)?, sheets: Vec::new(), tolerance })
    }

    /// What [`with_curve`] finds on this surface.
    pub(crate) fn with_curve(&mut self, chain: &Chain) -> Result<Vec<SurfaceMeeting>> {
        Ok(united_meetings(self.meetings(chain)?, chain, self.tolerance))
    }

    fn meetings(&mut self, chain: &Chain) -> Result<Vec<SurfaceMeeting>> {
        let curve = chain.to_curve()?;
        let (overlaps, points) = match in_plane(chain, &curve, &self.surface, self.tolerance)? {
            Some(found) => found,
            None => self.searched(&curve)?,
        };
        kept(chain, curve.length(), (self.mapped, &self.surface), (overlaps, points), self.tolerance)
    }

    /// Overlaps of a curve and the surface without its loops, and other meetings, both by fractions of the curve.
    fn searched(&mut self, curve: &Curve) -> Result<(Vec<Stretch>, Vec<CurveTouch>)> {
        let over = |reach| patches(&grounded(&self.surface, reach)).into_iter().map(Sheet::new).collect::<Vec<_>>();
        // Of an unbounded plane the part that the curve reaches.
        if self.sheets.is_empty() || self.surface.ground() == Domain::Unbounded {
            self.sheets = over(curve.bbox());
        }
        let mut found: Vec<Contact> = Vec::new();
        for sheet in &mut self.sheets {
            found.extend(on_patch(curve, sheet, self.tolerance)?);
        }
        let length = curve.length();
        let fraction = |t: f64| curve.length_at(t) / length;
        let (mut overlaps, mut points): (Vec<Stretch>, Vec<CurveTouch>) = (Vec::new(), Vec::new());
        for contact in found {
            match contact {
                Contact::Overlap { t } => overlaps.push((fraction(t.0), fraction(t.1))),
                Contact::Point(touch) => points.push(CurveTouch { t: fraction(touch.t), ..touch }),
            }
        }
        Ok((overlaps, points))
    }
}

/// The meetings that the kept part of a surface has, over its frame and as it is mapped; `length` is that of the curve.
fn kept(
    chain: &Chain,
    length: f64,
    (mapped, surface): (&Surface, &Surface),
    (overlaps, mut points): (Vec<Stretch>, Vec<CurveTouch>),
    tolerance: &Tolerance,
) -> Result<Vec<SurfaceMeeting>> {
    let near = tolerance.point / length;
    let mut out = Vec::new();
    for (from, to) in kept_intervals(chain, surface, united(overlaps, &points, near), tolerance)? {
        let uv = closest(surface, chain.point(from)).uv;
        out.push(SurfaceMeeting { point: chain.point(from), f: from, uv, overlap_end: Some(to) });
    }
    // The start of a closed curve stands for its end.
    if chain.is_closed(tolerance) {
        points.iter_mut().filter(|t| t.t >= 1.0 - near).for_each(|t| t.t = 0.0);
    }
    for touch in distinct(points, length, tolerance) {
        let on_stretch = out.iter().any(|m| m.overlap_end.is_some_and(|to| m.f - near <= touch.t && touch.t <= to + near));
        if !on_stretch && surface.keeps_point(touch.p, touch.uv, tolerance.point) {
            let at_end = [(0.0, chain.start()), (1.0, chain.end())].into_iter().find(|(f, _)| (f - touch.t).abs() <= near);
            let (f, point) = at_end.filter(|_| !chain.is_closed(tolerance)).unwrap_or((touch.t, chain.point(touch.t)));
            out.push(SurfaceMeeting { point, f, uv: touch.uv.into(), overlap_end: None });
        }
    }
    out.sort_by(|a, b| a.f.total_cmp(&b.f));
    if surface.domain() != mapped.domain() {
        out.iter_mut().for_each(|m| m.uv = closest(mapped, m.point).uv);
    }
    Ok(out)
}

/// Parts of a curve in the plane of a flat face that lie on its ground, and where the curve meets the loops of the face, both by fractions
/// of the curve; `None` for other curves and faces. The borders alone tell which parts lie on the face, however small these are beside the
/// curve.
fn in_plane(chain: &Chain, curve: &Curve, surface: &Surface, tolerance: &Tolerance) -> Result<Option<(Vec<Stretch>, Vec<CurveTouch>)>> {
    if !is_flat(surface) {
        return Ok(None);
    }
    let Some(curve) = rational(curve) else { return Ok(None) };
    let jet = surface.jet(0.0, 0.0);
    let normal = jet.du.cross(jet.dv).normalize_or_zero();
    let height = |k: usize| normal.dot(curve.pole(k) - jet.p).abs();
    if normal == DVec3::ZERO || !(0..curve.poles.len()).all(|k| height(k) <= LYING * tolerance.point) {
        return Ok(None);
    }
    let uv = |p: DVec3| step(jet.du, jet.dv, p - jet.p).unwrap_or_default();
    let mut borders = Vec::new();
    match surface.domain() {
        Domain::Unbounded => {}
        Domain::Loop => {
            for k in 0..surface.n_sides() {
                if let Side::Chain { chain: border, .. } = surface.side(k) {
                    borders.push(border);
                }
            }
        }
        Domain::Square => {
            let corners = [jet.p, jet.p + jet.du, jet.p + jet.du + jet.dv, jet.p + jet.dv];
            for k in 0..4 {
                borders.push(Chain::of_curve(&line(corners[k], corners[(k + 1) % 4], Origin::NONE)?));
            }
        }
        Domain::Triangle => return Ok(None),
    }
    let (mut touches, mut cuts) = (Vec::new(), vec![0.0, 1.0]);
    for border in &borders {
        for m in meet_chains(chain, border, tolerance)? {
            let p = chain.point(m.fa);
            touches.push(CurveTouch { t: m.fa, uv: uv(m.point), p, gap: p.distance(border.point(m.fb)), sine: 1.0 });
            cuts.push(m.fa);
            cuts.extend(m.overlap_end.map(|(f, _)| f));
        }
    }
    if surface.domain() != Domain::Square {
        return Ok(Some((vec![(0.0, 1.0)], touches)));
    }
    cuts.sort_by(f64::total_cmp);
    // Where the curve runs along a side its middle is beside it by rounding.
    let room = DVec2::new(tolerance.point / jet.du.length(), tolerance.point / jet.dv.length());
    let inside = |p: DVec2| p.cmpge(-room).all() && p.cmple(1.0 + room).all();
    let parts = cuts.windows(2).filter(|w| w[0] < w[1] && inside(uv(chain.point(0.5 * (w[0] + w[1])))));
    Ok(Some((parts.map(|w| (w[0], w[1])).collect(), touches)))
}

/// A part of a curve, from one fraction of its length to another.
type Stretch = (f64, f64);

/// Meetings of a curve with one patch.
fn on_patch(curve: &Curve, sheet: &mut Sheet, tolerance: &Tolerance) -> Result<Vec<Contact>> {
    let size = curve.bbox().diagonal().min(sheet.bounds().diagonal());
    contacts(curve, sheet, tolerance.point, long(tolerance, size)).map_err(|at| {
        let what = "where the curve meets the surface".to_owned();
        CurveFault::NotConverged { of: curve.origin(), what, at }.into()
    })
}

/// Overlaps that touch or share a part as one, ascending. What is between two, or between one and an end of the curve that is on the
/// surface, and no longer than the shortest overlap is part of it: a curve may have a span as short as that.
fn united(mut overlaps: Vec<Stretch>, points: &[CurveTouch], near: f64) -> Vec<Stretch> {
    let short = SHORTEST_OVERLAP * near;
    overlaps.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut out: Vec<Stretch> = Vec::new();
    for (from, to) in overlaps {
        match out.last_mut() {
            Some(last) if from <= last.1 + short => last.1 = last.1.max(to),
            _ => out.push((from, to)),
        }
    }
    let touched = |end: f64| points.iter().any(|touch| (touch.t - end).abs() <= near);
    if let Some(first) = out.first_mut()
        && first.0 <= short
        && touched(0.0)
    {
        first.0 = 0.0;
    }
    if let Some(last) = out.last_mut()
        && last.1 >= 1.0 - short
        && touched(1.0)
    {
        last.1 = 1.0;
    }
    out
}

/// Each place once: the nearest of those that are one meeting.
fn distinct(mut points: Vec<CurveTouch>, length: f64, tolerance: &Tolerance) -> Vec<CurveTouch> {
    const SAME: f64 = 4.0;
    points.sort_by(|a, b| a.gap.total_cmp(&b.gap).then(a.t.total_cmp(&b.t)));
    let mut kept: Vec<CurveTouch> = Vec::new();
    for touch in points {
        // Where the curve leaves the surface slowly all of a long way is within the tolerance.
        let slow = if touch.gap > tolerance.rounding { 2.0 * tolerance.point / touch.sine.max(ROUNDING_SHARE) } else { 0.0 };
        let reach = slow.max(SAME * tolerance.point);
        let same = |k: &CurveTouch| (k.t - touch.t).abs() * length <= reach && k.p.distance(touch.p) <= reach;
        if !kept.iter().any(same) {
            kept.push(touch);
        }
    }
    kept
}

/// The parts of intervals of a chain that lie in the kept part of a trimmed surface.
pub(crate) fn kept_intervals(
    chain: &Chain,
    surface: &Surface,
    intervals: Vec<(f64, f64)>,
    tolerance: &Tolerance,
) -> Result<Vec<(f64, f64)>> {
    if surface.domain() != Domain::Loop {
        return Ok(intervals);
    }
    let mut cuts = Vec::new();
    for k in 0..surface.n_sides() {
        if let Side::Chain { chain: border, .. } = surface.side(k) {
            for m in meet_chains(chain, &border, tolerance)? {
                cuts.push(m.fa);
                cuts.extend(m.overlap_end.map(|(fa, _)| fa));
            }
        }
    }
    cuts.sort_by(f64::total_cmp);
    let mut out: Vec<(f64, f64)> = Vec::new();
    let near = tolerance.point / chain.length();
    let below = Nearest::new(&surface.untrimmed());
    // What ends beside a border within the tolerance ends on it.
    let settled = |f: f64| {
        let beside = cuts.iter().copied().filter(|cut| (cut - f).abs() <= near);
        let nearest = beside.min_by(|a, b| (a - f).abs().total_cmp(&(b - f).abs()));
        nearest.filter(|cut| (cut - f).abs() > EPSILON.sqrt() * near).unwrap_or(f)
    };
    for (from, to) in intervals.into_iter().map(|(from, to)| (settled(from), settled(to))) {
        let inner = cuts.iter().copied().filter(|f| *f > from + near && *f < to - near);
        let stops: Vec<f64> = std::iter::once(from).chain(inner).chain(std::iter::once(to)).collect();
        for w in stops.windows(2) {
            let p = chain.point(0.5 * (w[0] + w[1]));
            let foot = below.at(p);
            if surface.keeps_point(p, DVec2::new(foot.uv.0, foot.uv.1), tolerance.point) {
                match out.last_mut() {
                    Some(last) if last.1 >= w[0] - near => last.1 = w[1],
                    _ => out.push((w[0], w[1])),
                }
            }
        }
    }
    Ok(out)
}

/// The one place where a curve and a surface meet; none, several or an overlap are E507, E508, E509 with candidates and
/// the closest miss.
pub fn with_curve_once(chain: &Chain, surfaces: &[Surface], tolerance: &Tolerance) -> Result<SurfaceMeeting> {
    let meetings = with_curve(chain, surfaces, tolerance)?;
    let overlaps: Vec<(DVec3, DVec3)> = meetings.iter().filter_map(|m| m.overlap_end.map(|to| (m.point, chain.point(to)))).collect();
    let (a, b) = (chain.origin(), surfaces.first().map_or(Origin::NONE, Surface::origin));
    if !overlaps.is_empty() {
        return Err(MeetingFault::Overlap { a, b, overlaps }.into());
    }
    match meetings.as_slice() {
        [one] => Ok(*one),
        [] => {
            let pairs = surfaces.iter().map(|surface| (closest_points(chain, surface), surface.origin()));
            let nearest = pairs.min_by(|x, y| x.0.0.distance(x.0.1).total_cmp(&y.0.0.distance(y.0.1)));
            let ((pa, pb), b) = nearest.unwrap_or(((chain.start(), chain.start()), b));
            let near = may_snap(pa.distance(pb), chain.length());
            Err(MeetingFault::NoMeeting { a: (a, pa), b: (b, pb), near, tolerance: tolerance.point }.into())
        }
        several => {
            let candidates = several.iter().map(|m| (m.point, m.f)).collect();
            Err(MeetingFault::SeveralMeetings { a, b, candidates }.into())
        }
    }
}

/// About the nearest points of a curve and a surface, from samples of the curve made better by turns.
fn closest_points(chain: &Chain, surface: &Surface) -> (DVec3, DVec3) {
    const SAMPLES: usize = 64;
    const ROUNDS: usize = 32;
    let nearest = Nearest::new(surface);
    let at = |f: f64| {
        let p = chain.point(f);
        (p, nearest.at(p).point)
    };
    let gap = |pair: &(DVec3, DVec3)| pair.0.distance(pair.1);
    let mut best = at(0.0);
    for k in 1..=SAMPLES {
        let next = at(k as f64 / SAMPLES as f64);
        if gap(&next) < gap(&best) {
            best = next;
        }
    }
    for _ in 0..ROUNDS {
        let next = at(chain.closest(best.1).0);
        if gap(&next) >= gap(&best) {
            break;
        }
        best = next;
    }
    best
}

//! What divides a surface: its border and the curves that cut it, parted where they meet.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::geometry::construct::build;
use crate::geometry::{Hit, self_intersect};
use crate::network::Chain;
use crate::surface::closest::nearest::closest;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::Domain;
use crate::surface::faults::BorderFault;
use crate::surface::rails::side::{Border, Side, between};
use crate::surface::rails::trim_curve::{Pcurve, TrimCurve};
use crate::surface::trims::pcurve::{OffSurface, is_pole};
use crate::surface::trims::project::{Way, project};
use crate::surface::trims::shared_runs;
use crate::surface::trims::trim_loop::{TrimLoop, natural};

/// A border of the surface or a cutter, whole.
#[derive(Clone, Debug)]
pub(crate) struct DividingCurve {
    /// In the direction of the loop; `None` at a pole.
    pub chain: Option<Chain>,
    /// The border of the surface; `None` for a cutter.
    pub border: Option<(Border, TrimCurve)>,
    /// Both sides of it are one place of a closed surface.
    pub seam: bool,
    /// Which cutter.
    pub cutter: Option<usize>,
    /// The chain was only made along the border, to be met.
    is_drawn: bool,
    cuts: Vec<f64>,
}

impl DividingCurve {
    /// Makes a closed cutter begin at the cut that is nearest to its own start, which parts nothing: a piece between the two may be shorter
    /// than vertices are apart, or run along what it crosses.
    fn begin_at_cut(&mut self, tolerance: &Tolerance) -> Result<()> {
        let Some(chain) = self.chain.as_ref().filter(|chain| self.cutter.is_some() && chain.is_closed(tolerance)) else { return Ok(()) };
        let off = |f: &f64| f.min(1.0 - *f);
        if let Some(first) = self.cuts.iter().copied().min_by(|f, g| off(f).total_cmp(&off(g))).filter(|f| off(f) > 0.0) {
            self.chain = Some(chain.slice(first, first, tolerance)?);
            self.cuts.iter_mut().for_each(|f| *f = (*f - first).rem_euclid(1.0));
        }
        Ok(())
    }
}

/// A part of a dividing curve between two meetings.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// Number of the dividing curve.
    pub curve: usize,
    pub border: Border,
    pub trim_curve: TrimCurve,
    /// Ends in (u, v).
    pub uv: (DVec2, DVec2),
    /// Ends and a point between.
    pub p: (DVec3, DVec3, DVec3),
    /// Whether the face goes on across it, round a closed surface.
    pub seam: bool,
    /// Part of the border of the surface, seams and poles included: the surface lies on its left.
    pub rim: bool,
}

impl Piece {
    /// The chain whose fractions its trim curve in (u, v) knows.
    pub fn own_chain(&self) -> Option<&Chain> {
        if let Side::Chain { chain, .. } = &self.border.side { Some(chain) } else { None }
    }

    /// Puts an end, the last one or the first, at another place of a pole.
    fn end_at(&mut self, last: bool, place: DVec2) {
        if last {
            self.uv.1 = place
        } else {
            self.uv.0 = place
        }
        if let TrimCurve::Pcurve(pcurve) = &self.trim_curve {
            self.trim_curve = TrimCurve::Pcurve(Arc::new(pcurve.as_ref().clone().ending(last, place)));
        }
    }
}

/// What cutters are taken to meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meets {
    /// The border, each other and themselves, anywhere.
    Anywhere,
    /// The border anywhere; each other at their ends alone, as the curves of loops do.
    AtEnds,
}

/// Borders and cutters with the places where they part each other.
pub(crate) fn dividing_curves(base: &Surface, cutters: &[Chain], meets: Meets, tolerance: &Tolerance) -> Result<Vec<DividingCurve>> {
    let mut all = Vec::new();
    for trim_loop in natural(base, tolerance)? {
        all.extend(of_loop(base, &trim_loop, tolerance)?);
    }
    for (k, chain) in cutters.iter().enumerate() {
        let curve =
            DividingCurve { chain: Some(chain.clone()), border: None, seam: false, cutter: Some(k), is_drawn: false, cuts: Vec::new() };
        all.push(curve);
    }
    part(&mut all, meets, tolerance)?;
    Ok(all)
}

/// Both sides of a seam are cut at the same places.
fn mirror_cuts(all: &mut [DividingCurve], tolerance: &Tolerance) {
    let seams: Vec<usize> = (0..all.len()).filter(|k| all[*k].seam && all[*k].chain.is_some()).collect();
    for &i in &seams {
        let Some(own) = all[i].chain.clone() else { continue };
        let places: Vec<DVec3> = all[i].cuts.iter().map(|f| own.point(*f)).collect();
        for &j in seams.iter().filter(|j| **j != i) {
            let Some(other) = all[j].chain.clone() else { continue };
            for p in &places {
                let (f, _, distance) = other.closest(*p);
                let known = |g: &f64| other.point(*g).distance(*p) <= 2.0 * tolerance.point;
                if distance <= tolerance.point && !all[j].cuts.iter().any(known) {
                    all[j].cuts.push(f);
                }
            }
        }
    }
}

/// The borders of a loop of a surface.
pub(crate) fn of_loop(base: &Surface, trim_loop: &TrimLoop, tolerance: &Tolerance) -> Result<Vec<DividingCurve>> {
    let each = |(k, twin): (usize, Option<usize>)| {
        let (border, trim_curve) = (trim_loop.borders[k].clone(), trim_loop.trim_curves[k].clone());
        of_border(base, border, trim_curve, twin.map(|j| trim_loop.borders[j].turned()), tolerance)
    };
    trim_loop.twins(base).into_iter().enumerate().map(each).collect()
}

/// A border with the other side of the seam that it is.
fn of_border(base: &Surface, border: Border, trim_curve: TrimCurve, twin: Option<Border>, tolerance: &Tolerance) -> Result<DividingCurve> {
    let along = |side: &Side| match side {
        Side::Chain { chain, from, to } => between(chain, *from, *to, tolerance).map(Some),
        _ => Ok(None),
    };
    let seam = twin.is_some();
    let mut chain = along(&border.side)?;
    if chain.is_none() {
        chain = twin.map(|twin| along(&twin.side)).transpose()?.flatten();
    }
    let mut is_drawn = false;
    if chain.is_none()
        && !matches!(border.side, Side::Pole(_))
        && let TrimCurve::Line(a, b) = &trim_curve
    {
        let line = build::line(DVec3::new(a.0, a.1, 0.0), DVec3::new(b.0, b.1, 0.0), Origin::NONE)?;
        chain = project(base, &Chain::of_curve(&line), Way::Parameters, base.origin(), tolerance).ok().map(|c| Chain::of_curve(&c));
        is_drawn = true;
    }
    Ok(DividingCurve { chain, border: Some((border, trim_curve)), seam, cutter: None, is_drawn, cuts: Vec::new() })
}

/// Cuts the curves where cutters meet them and each other.
fn part(all: &mut [DividingCurve], meets: Meets, tolerance: &Tolerance) -> Result<()> {
    for j in 0..all.len() {
        let Some(b) = all[j].chain.clone() else { continue };
        if all[j].cutter.is_none() {
            continue;
        }
        for i in 0..j {
            let Some(a) = all[i].chain.clone().filter(|_| meets == Meets::Anywhere || all[i].cutter.is_none()) else { continue };
            for m in shared_runs::meetings(&a, &b, tolerance)? {
                all[i].cuts.push(m.fa);
                all[j].cuts.push(m.fb);
                if let Some((fa, fb)) = m.overlap_end {
                    all[i].cuts.push(fa);
                    all[j].cuts.push(fb);
                }
            }
        }
        if meets == Meets::AtEnds {
            continue;
        }
        let curve = b.to_curve()?;
        let share = |t: f64| curve.length_at(t) / curve.length();
        for hit in self_intersect(&curve, tolerance)? {
            if let Hit::Point { ta, tb, .. } = hit {
                all[j].cuts.extend([share(ta), share(tb)]);
            }
        }
    }
    mirror_cuts(all, tolerance);
    for curve in all {
        curve.begin_at_cut(tolerance)?;
        let Some(chain) = &curve.chain else { continue };
        let near = tolerance.point / chain.length();
        // A loop that is cut begins at a cut: its own start is no end.
        curve.cuts.retain(|f| *f > near && *f < 1.0 - near);
        curve.cuts.sort_by(f64::total_cmp);
        curve.cuts.dedup_by(|b, a| *b - *a <= 2.0 * near);
        let beside = [curve.cuts.first(), curve.cuts.last()].map(|cut| cut.is_some_and(|f| f.min(1.0 - f) <= 2.0 * near));
        // Between two cuts a loop's own start is no reason to take them as one.
        if !(chain.is_closed(tolerance) && curve.cuts.len() > 1 && beside == [true; 2]) {
            curve.cuts.retain(|f| *f > 2.0 * near && *f < 1.0 - 2.0 * near);
        }
        curve.cuts.insert(0, 0.0);
        curve.cuts.push(1.0);
    }
    Ok(())
}

/// The parts of all dividing curves; cutters that run along a border or an earlier cutter count once, those beyond the border not at
/// all. With the numbers of the cutters of which a part runs along something else.
pub(crate) fn pieces(base: &Surface, curves: &[DividingCurve], tolerance: &Tolerance) -> Result<(Vec<Piece>, BTreeSet<usize>)> {
    let (mut out, mut along): (Vec<Piece>, BTreeSet<usize>) = (Vec::new(), BTreeSet::new());
    let loops = if bounded(base) { natural(base, tolerance)? } else { Vec::new() };
    for (k, curve) in curves.iter().enumerate() {
        let Some(chain) = &curve.chain else { continue };
        for w in curve.cuts.windows(2) {
            let whole = curve.cuts.len() == 2;
            let run = if whole { chain.clone() } else { chain.slice(w[0], w[1], tolerance)? };
            let middle = run.point(MIDDLE);
            let places = ALONG.map(|f| run.point(f));
            let is_along = |c: &Chain| places.iter().all(|p| c.closest(*p).2 <= 2.0 * tolerance.point);
            let lies_on = |other: &DividingCurve| other.chain.as_ref().is_some_and(is_along);
            if let Some(cutter) = curve.cutter
                && curves[..k].iter().any(lies_on)
            {
                along.insert(cutter);
                continue;
            }
            // A cutter along a seam makes a border of it.
            let seam = curve.seam && !curves.iter().any(|s| s.cutter.is_some() && lies_on(s));
            let piece = match &curve.border {
                Some((border, trim_curve)) => {
                    let own = DividingBorder { curve: k, border, trim_curve, is_drawn: curve.is_drawn, seam };
                    if whole { own.whole(&run) } else { own.part(base, &run, (w[0], w[1]), tolerance)? }
                }
                None => match within(base, &loops, middle) {
                    Some(start) => of_cutter(base, k, run, start, tolerance)?,
                    None => continue,
                },
            };
            out.push(piece);
        }
    }
    for (k, curve) in curves.iter().enumerate() {
        if curve.chain.is_none()
            && let Some((border, TrimCurve::Line(a, b))) = &curve.border
        {
            let added = at_pole(base, k, border, (DVec2::from(*a), DVec2::from(*b)), &mut out, tolerance);
            out.extend(added);
        }
    }
    Ok((out, along))
}

/// Whether a surface is bounded by curves in (u, v), and not by the square or triangle of its parameters.
pub(crate) fn bounded(base: &Surface) -> bool {
    base.domain() == Domain::Loop
}

/// Where in (u, v) a point of a surface lies inside its loops; `None` beyond them.
pub(crate) fn within(base: &Surface, loops: &[TrimLoop], p: DVec3) -> Option<DVec2> {
    let near = base.flat_uv(p).unwrap_or_else(|| closest(&base.untrimmed(), p).uv);
    if !bounded(base) {
        return Some(near.into());
    }
    let inside = |at: &DVec2| loops.iter().map(|trim_loop| trim_loop.turning(base, *at)).sum::<f64>().abs() > std::f64::consts::PI;
    base.copies(near).into_iter().find(inside)
}

/// Where a piece is asked where it lies: no place that is special for anything.
const MIDDLE: f64 = 0.4873;
/// Where a piece is compared with another curve; it runs along one that is near at all of them.
const ALONG: [f64; 3] = [MIDDLE, 0.2327, 0.7719];

/// A border as a dividing curve.
struct DividingBorder<'a> {
    /// Its number.
    curve: usize,
    border: &'a Border,
    trim_curve: &'a TrimCurve,
    /// Whether its curve was made for it.
    is_drawn: bool,
    /// Whether its pieces are seams.
    seam: bool,
}

impl DividingBorder<'_> {
    /// The whole of it, along a curve.
    fn whole(&self, run: &Chain) -> Piece {
        let places = self.trim_curve.places();
        let p = (run.start(), run.point(MIDDLE), run.end());
        let uv = (places[0], places[places.len() - 1]);
        Piece { curve: self.curve, border: self.border.clone(), trim_curve: self.trim_curve.clone(), uv, p, seam: self.seam, rim: true }
    }

    /// The part between two fractions, along a curve.
    fn part(&self, base: &Surface, run: &Chain, (from, to): (f64, f64), tolerance: &Tolerance) -> Result<Piece> {
        let about = |f: f64| self.trim_curve.share(f);
        let p = (run.start(), run.point(MIDDLE), run.end());
        let off = |off: OffSurface| outside(base, run, off, tolerance);
        // From a pole the other end decides on which side of a seam the border runs.
        let pcurve = if is_pole(base, about(from)) {
            Pcurve::follow(base, run, (1.0, 0.0), about(to), tolerance.point).map(|pcurve| pcurve.turned())
        } else {
            Pcurve::follow(base, run, (0.0, 1.0), about(from), tolerance.point)
        }
        .map_err(off)?
        .into_poles(base, run);
        if !self.is_drawn {
            let (uv, trim_curve) = (pcurve.ends(), TrimCurve::Pcurve(Arc::new(pcurve)));
            return Ok(Piece {
                curve: self.curve,
                border: Border::chain(run.clone(), false),
                trim_curve,
                uv,
                p,
                seam: self.seam,
                rim: true,
            });
        }
        // The border is straight in (u, v): its parts are.
        let (a, b) = (about(0.0), about(1.0));
        let onto = |q: DVec2, f: f64| {
            let share = if f <= 0.0 || f >= 1.0 { f } else { (q - a).dot(b - a) / (b - a).length_squared() };
            a.lerp(b, share)
        };
        let uv = (onto(pcurve.ends().0, from), onto(pcurve.ends().1, to));
        let trim_curve = TrimCurve::Line(uv.0.into(), uv.1.into());
        Ok(Piece { curve: self.curve, border: Border::straight(self.border.side.clone()), trim_curve, uv, p, seam: self.seam, rim: true })
    }
}

/// A piece of a cutter, with the place of its middle.
fn of_cutter(base: &Surface, curve: usize, run: Chain, start: DVec2, tolerance: &Tolerance) -> Result<Piece> {
    let off = |off: OffSurface| outside(base, &run, off, tolerance);
    let before = Pcurve::follow(base, &run, (MIDDLE, 0.0), start, tolerance.point).map_err(off)?;
    let after = Pcurve::follow(base, &run, (MIDDLE, 1.0), start, tolerance.point).map_err(off)?;
    let pcurve = before.turned().then(&after).into_poles(base, &run);
    let p = (run.start(), run.point(MIDDLE), run.end());
    let (uv, border) = (pcurve.ends(), Border::chain(run.clone(), false));
    Ok(Piece { curve, border, trim_curve: TrimCurve::Pcurve(Arc::new(pcurve)), uv, p, seam: false, rim: false })
}

fn outside(base: &Surface, run: &Chain, off: OffSurface, tolerance: &Tolerance) -> Fault {
    let (of, at) = (run.origin(), off.at);
    BorderFault::LoopOutsideSurface { of, surface: base.origin(), off: off.distance, at, tolerance: tolerance.point }.into()
}

/// A pole, parted where cutters run into it; ends beside an end of it are put there.
fn at_pole(
    base: &Surface,
    curve: usize,
    border: &Border,
    (a, b): (DVec2, DVec2),
    pieces: &mut [Piece],
    tolerance: &Tolerance,
) -> Vec<Piece> {
    let mut cuts = vec![0.0, 1.0];
    for piece in pieces {
        for last in [false, true] {
            let uv = if last { piece.uv.1 } else { piece.uv.0 };
            // A pole may be as wide as the tolerance: where in (u, v) a piece ends decides whether it ends there.
            let share = (uv - a).dot(b - a) / (b - a).length_squared();
            if (uv - a.lerp(b, share)).length() > NUDGE {
                continue;
            }
            if share > NUDGE && share < 1.0 - NUDGE {
                cuts.push(share);
            } else if share.abs().min((share - 1.0).abs()) <= NUDGE {
                piece.end_at(last, if share < 0.5 { a } else { b });
            }
        }
    }
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|b, a| *b - *a <= tolerance.parameter);
    let piece = |w: &[f64]| {
        let at = |share: f64| a.lerp(b, share);
        let p = [w[0], 0.5 * (w[0] + w[1]), w[1]].map(|share| base.point(at(share).x, at(share).y));
        let uv = (at(w[0]), at(w[1]));
        let trim_curve = TrimCurve::Line(uv.0.into(), uv.1.into());
        Piece { curve, border: border.clone(), trim_curve, uv, p: p.into(), seam: false, rim: true }
    };
    cuts.windows(2).map(piece).collect()
}

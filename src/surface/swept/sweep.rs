//! `sweep`: sections swept along guides by a law.

use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::{NEAREST, NUDGE, Tolerance};
use crate::geometry::construct::build::{all_different, line};
use crate::geometry::construct::spline::{self, Ends, Spacing, Spline};
use crate::geometry::curves::curve::Shape as CurveShape;
use crate::geometry::data::fault::CurveFault;
use crate::geometry::{Curve, Kind};
use crate::network::Chain;
use crate::surface::blended::coons::{Made, finish};
use crate::surface::blended::gordon::{CurveNet, Named, gordon};
use crate::surface::core::surface::Surface;
use crate::surface::data::flow_words::phrase;
use crate::surface::data::kind::SurfaceKind;
use crate::surface::data::one_sided::OneSided;
use crate::surface::faults::{BorderFault, SweepFault};
use crate::surface::rails::rail::Rail;
use crate::surface::rails::reparam::{Even, Map, Reparam};
use crate::surface::shapes::blend::Blend;
use crate::surface::shapes::cardinal::{End, ended, slopes};
use crate::surface::shapes::rule::Rule;
use crate::surface::shapes::weights::BlendAxis;
use crate::surface::swept::law_met::{Miss, Missed, missed};
use crate::surface::swept::laws::Law;
use crate::surface::swept::sections::Guide;
use crate::surface::swept::single::single;
use crate::surface::swept::sweep_input::{Input, NetMethod};
use crate::surface::swept::sweep_net::{Rib, SweepNet, net};

/// The surface through all sections and guides; u runs along the main guide, v along the sections. With notes and warnings.
///
/// One section on one guide is exact. There must be at least one section and one guide. Fails with E631–E637 and E640.
/// E401 for one that is no longer than the tolerance.
pub fn sweep(input: &Input, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    if let Some(short) = input.guides.iter().chain(input.sections).find(|chain| chain.length() <= tolerance.point) {
        return Err(CurveFault::ZeroLength { of: short.origin(), length: short.length(), tolerance: tolerance.point }.into());
    }
    if let ([section], [guide]) = (input.sections, input.guides)
        && let Some(done) = single(section, guide, input, tolerance)?
    {
        return Ok(done);
    }
    let mut guides: Vec<Guide> = input.guides.iter().map(Guide::new).collect();
    let mut more: Vec<f64> = Vec::new();
    let mut swept = denser(input, &mut guides, &more, tolerance)?;
    for _ in 1..MOST {
        if swept.missed.fractions.is_empty() {
            break;
        }
        more.extend(&swept.missed.fractions);
        match denser(input, &mut guides, &more, tolerance) {
            Ok(nearer) => swept = nearer,
            // Curves that cannot be made through so many stations: the surface through fewer of them stands, with its warning.
            Err(fault) if fault.of::<CurveFault>().is_some() => break,
            Err(fault) => return Err(fault),
        }
    }
    let Swept { surface, mut notes, missed: Missed { fractions, worst: Miss { at, off, share } } } = swept;
    if !fractions.is_empty() {
        notes.push(SweepFault::LawMissed { surface: input.origin, law: input.law.name(), off, share, at }.into());
    }
    Ok((surface, notes))
}

/// A surface is made at most so many times, with more stations each time. Where guides and sections are smooth, each time brings it
/// nearer to its law by a factor of 16.
const MOST: usize = 9;

/// A surface with its notes, and where it is off its law.
struct Swept {
    surface: Surface,
    notes: Vec<Fault>,
    missed: Missed,
}

/// The surface with stations at the fractions `more` of the main guide too; guides that are too short are extended.
fn denser(input: &Input, guides: &mut [Guide], more: &[f64], tolerance: &Tolerance) -> Result<Swept> {
    loop {
        match net(input, guides, more, tolerance)? {
            Ok(net) => {
                let (surface, notes) = surface(&net, input, tolerance)?;
                let rounded = net.rounds_corners(tolerance) || input.method == NetMethod::Local;
                let missed = if rounded { Missed::default() } else { missed(&surface, &net, tolerance) };
                return Ok(Swept { surface, notes, missed });
            }
            Err(short) => {
                let guide = &guides[short.guide];
                let fixed = short.guide == 0 || guide.own != (0.0, 1.0) || input.law == Law::Synchronized;
                let longer = if fixed { None } else { Guide::longer(&guide.given, tolerance)? };
                guides[short.guide] = longer.ok_or(short.fault)?;
            }
        }
    }
}

fn surface(net: &SweepNet, input: &Input, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let mut notes = net.notes.clone();
    let mut nodes_u: Vec<f64> = net.ribs.iter().map(|r| r.w).collect();
    if net.closed.0 {
        nodes_u.push(1.0);
    }
    let along_v: Vec<Rail> = net
        .ribs
        .iter()
        .map(|r| Rail::new(r.chain.clone(), Map::new(net.breaks.clone(), r.breaks.clone(), Reparam::Smooth, net.closed.1)))
        .collect();
    // Guides by break, then lines through the sections where there is none.
    let even = net.even(tolerance);
    let mut lines: Vec<(usize, Rail)> = Vec::new();
    for (&j, &place) in net.order.iter().zip(&net.places) {
        lines.push((place, guide_rail((net, &even), j, &nodes_u, &mut notes, tolerance)?));
    }
    let last = net.breaks.len() - 1;
    for place in missing(&lines, net, last) {
        lines.push((place, through((net, &even), place, &nodes_u, input.origin, tolerance)?));
    }
    lines.sort_by_key(|l| l.0);
    let mut nodes_v: Vec<f64> = lines.iter().map(|l| net.breaks[l.0]).collect();
    if net.closed.1 {
        nodes_v.push(1.0);
    }
    let along_u: Vec<Rail> = lines.into_iter().map(|l| l.1).collect();
    let poles = along_u.iter().filter(|r| matches!(r, Rail::Point(_))).count();
    let chains: Vec<Chain> = input.sections.iter().chain(input.guides).cloned().collect();
    let flow = phrase(poles, net.closed);
    let (made, more) = match input.method {
        NetMethod::Gordon => {
            let named = Named { origin: input.origin, kind: SurfaceKind::Sweep, flow, chains };
            gordon(CurveNet { along_u, along_v, nodes: (nodes_u, nodes_v), closed: net.closed }, named, tolerance)
        }
        NetMethod::Local => local(
            along_u,
            along_v,
            (nodes_u, nodes_v),
            Made { origin: input.origin, kind: SurfaceKind::Sweep, flow, closed: net.closed, chains },
            tolerance,
        ),
    };
    notes.extend(more);
    contains(&made, net, tolerance)?;
    Ok((made, notes))
}

/// Each patch from its own four curves.
fn local(
    mut along_u: Vec<Rail>,
    mut along_v: Vec<Rail>,
    nodes: (Vec<f64>, Vec<f64>),
    made: Made,
    tolerance: &Tolerance,
) -> (Surface, Vec<Fault>) {
    for (rails, closed) in [(&mut along_u, made.closed.1), (&mut along_v, made.closed.0)] {
        if closed && let Some(first) = rails.first().cloned() {
            rails.push(first);
        }
    }
    let blend = Blend::new(BlendAxis::new(nodes.0, Rule::Linear), BlendAxis::new(nodes.1, Rule::Linear), along_v, along_u);
    let mut notes = Vec::new();
    (finish(blend, made, tolerance, &mut notes), notes)
}

/// A guide between the first and the last station; N638 for what was added to it, N609 for what is left out.
fn guide_rail((net, even): (&SweepNet, &Even), j: usize, nodes: &[f64], notes: &mut Vec<Fault>, tolerance: &Tolerance) -> Result<Rail> {
    let guide = &net.guides[j];
    let mut fractions = net.on_guide(j);
    if net.closed.0 {
        return Ok(Rail::new(guide.chain.clone(), Map::even_over(nodes.to_vec(), fractions, Reparam::Smooth, even, true)));
    }
    let n = fractions.len() - 1;
    let (from, to) = (fractions[0], fractions[n]);
    let (whole, near) = (guide.chain.length(), tolerance.point / guide.chain.length());
    for (own, used, outward) in [(guide.own.0, from, -1.0), (guide.own.1, to, 1.0)] {
        let more = (used - own) * outward;
        let (of, end) = (guide.given.origin(), guide.chain.point(if more > 0.0 { used } else { own }));
        if more > near {
            notes
                .push(SweepFault::GuideExtended { guide: of, length: more * whole, share: more / (guide.own.1 - guide.own.0), end }.into());
        } else if more < -near {
            let border = net.guides[0].given.origin();
            notes.push(BorderFault::EndTrimmed { curve: of, border, end, length: -more * whole }.into());
        }
    }
    let all = from <= near && to >= 1.0 - near;
    let chain = if all { guide.chain.clone() } else { guide.chain.slice(from, to, tolerance)? };
    fractions.iter_mut().for_each(|f| *f = if all { *f } else { (*f - from) / (to - from) });
    (fractions[0], fractions[n]) = (0.0, 1.0);
    Ok(Rail::new(chain, Map::even_over(nodes.to_vec(), fractions, Reparam::Smooth, even, false)))
}

/// Breaks at which a line through the sections is wanted: open ends, and enough for a closed direction.
fn missing(lines: &[(usize, Rail)], net: &SweepNet, last: usize) -> Vec<usize> {
    const LEAST: usize = 3;
    let mut have: Vec<usize> = lines.iter().map(|l| l.0).collect();
    have.sort_unstable();
    let before = have.len();
    if net.closed.1 {
        // In the middle of the widest gaps there are breaks, as a closed section has several pieces. Of equals all are taken, so that
        // the direction of the sections says nothing.
        while have.len() < LEAST {
            let gap = |k: usize| (have[k], have.get(k + 1).copied().unwrap_or(last));
            let width = |k: usize| net.breaks[gap(k).1] - net.breaks[gap(k).0];
            let widest = (0..have.len()).map(width).fold(0.0, f64::max);
            let mut more = Vec::new();
            for (low, high) in (0..have.len()).filter(|k| width(*k) >= widest - NUDGE).map(gap) {
                let middle = 0.5 * (net.breaks[low] + net.breaks[high]);
                let off = |k: usize| (net.breaks[k] - middle).abs();
                let least = (low + 1..high).map(off).fold(f64::INFINITY, f64::min);
                more.extend((low + 1..high).filter(|k| off(*k) <= least + NUDGE));
            }
            if more.is_empty() {
                break;
            }
            have.extend(more);
            have.sort_unstable();
        }
    } else {
        have.extend([0, last].into_iter().filter(|k| !lines.iter().any(|l| l.0 == *k)));
    }
    debug_assert!(have.len() >= before);
    have.into_iter().filter(|k| !lines.iter().any(|l| l.0 == *k)).collect()
}

/// A line through the sections at one of their common breaks: a spline, in parts where all guides have a corner or are straight; a
/// pole where they all meet there.
fn through((net, even): (&SweepNet, &Even), place: usize, nodes: &[f64], origin: Origin, tolerance: &Tolerance) -> Result<Rail> {
    let points: Vec<DVec3> = net.ribs.iter().map(|r| r.chain.point(r.breaks[place])).collect();
    if points.iter().all(|p| tolerance.same_point(points[0], *p)) {
        return Ok(Rail::Point(points[0]));
    }
    if net.closed.0 {
        let curve = spline::spline(&points, &Spline { start: Ends::Natural, end: Ends::Natural, closed: true }, origin)?;
        let mut fractions: Vec<f64> = curve.knots().iter().map(|t| curve.length_at(*t) / curve.length()).collect();
        let n = fractions.len() - 1;
        (fractions[0], fractions[n]) = (0.0, 1.0);
        return Ok(Rail::new(Chain::of_curve(&curve), Map::new(nodes.to_vec(), fractions, Reparam::Smooth, true)));
    }
    let n = points.len() - 1;
    let (mut parts, mut lengths) = (Vec::new(), vec![0.0]);
    for part in parts_of(even, &points, tolerance) {
        let run = &points[part.from..=part.to];
        let curve = match run {
            [a, .., b] if part.straight || run.len() == 2 => line(*a, *b, origin)?,
            _ => spline_part(run, part.ends, origin)?,
        };
        let before = lengths[lengths.len() - 1];
        let knots: Vec<f64> = match part.straight || run.len() == 2 {
            true => run[1..].iter().map(|p| p.distance(run[0])).collect(),
            false => curve.knots()[1..].iter().map(|t| curve.length_at(*t)).collect(),
        };
        lengths.extend(knots.into_iter().map(|length| before + length));
        parts.push(Chain::of_curve(&curve));
    }
    let whole = lengths[n];
    let mut fractions: Vec<f64> = lengths.iter().map(|l| l / whole).collect();
    (fractions[0], fractions[n]) = (0.0, 1.0);
    let chain = match parts.as_slice() {
        [one] => one.clone(),
        _ => Chain::join(&parts, origin, tolerance)?,
    };
    Ok(Rail::new(chain, Map::even_over(nodes.to_vec(), fractions, Reparam::Smooth, even, false)))
}

/// The spline through the points of a part; where it has no given direction its end is "not a knot", as the blend's is.
fn spline_part(points: &[DVec3], ends: (Option<DVec3>, Option<DVec3>), origin: Origin) -> Result<Curve> {
    all_different(points, false, origin)?;
    let spans = Spacing::Chord.spans(points);
    let mut knots = vec![0.0];
    spans.iter().for_each(|span| knots.push(knots[knots.len() - 1] + span));
    let [first, last] = [ends.0, ends.1].map(|way| way.map(DVec3::normalize_or_zero));
    let end = |way: Option<DVec3>| if way.is_some() { End::Slope } else { End::Plain };
    let rows = match (first, last) {
        (None, None) => slopes(&knots, false),
        _ => ended(&knots, (end(first), end(last))),
    };
    let values = || points.iter().copied().chain([first.unwrap_or_default(), last.unwrap_or_default()]);
    let slopes: Vec<DVec3> = rows.iter().map(|row| row.iter().zip(values()).map(|(by, value)| value * *by).sum()).collect();
    Ok(Curve::new(CurveShape::Nurbs(Arc::new(spline::through(points, &spans, &slopes))), Kind::Spline, origin))
}

/// A part of a line through sections.
struct Part {
    /// Places of its first and last station.
    from: usize,
    to: usize,
    /// Whether it is a straight line, as the main guide is there.
    straight: bool,
    /// Directions at its ends, where the parts beside it give them.
    ends: (Option<DVec3>, Option<DVec3>),
}

/// The parts of a line through points at the stations: they end at corners of all guides, and where these cease to be straight and the
/// points, too, lie on a line.
fn parts_of(even: &Even, points: &[DVec3], tolerance: &Tolerance) -> Vec<Part> {
    /// Points are on a line to so many roundings of a coordinate.
    const ROUNDINGS: f64 = 64.0;
    let (n, straight) = (points.len() - 1, &even.pieces);
    let corner = |k: usize| even.jumps.contains(&k);
    let stops = (1..n).filter(|k| corner(*k) || straight[*k - 1] != straight[*k]);
    let stops: Vec<usize> = std::iter::once(0).chain(stops).chain(std::iter::once(n)).collect();
    let on_line = |from: usize, to: usize| {
        let way = (points[to] - points[from]).normalize_or_zero();
        let off = |p: &DVec3| (*p - points[from]).reject_from(way).length();
        way != DVec3::ZERO && points[from..=to].iter().all(|p| off(p) <= ROUNDINGS * tolerance.rounding)
    };
    let mut parts: Vec<Part> = Vec::new();
    for w in stops.windows(2) {
        let straight = straight[w[0]] && on_line(w[0], w[1]);
        match parts.last_mut() {
            Some(before) if !(before.straight || straight || corner(w[0])) => before.to = w[1],
            _ => parts.push(Part { from: w[0], to: w[1], straight, ends: (None, None) }),
        }
    }
    for k in 1..parts.len() {
        let at = parts[k].from;
        if corner(at) {
            continue;
        }
        let way = |part: &Part| Some(points[part.to] - points[part.from]);
        if parts[k - 1].straight {
            parts[k].ends.0 = way(&parts[k - 1]);
        } else if parts[k].straight {
            parts[k - 1].ends.1 = way(&parts[k]);
        }
    }
    parts
}

/// The surface holds every section and guide, to [`NEAREST`] of its size and what they miss each other by; E413 else.
fn contains(surface: &Surface, net: &SweepNet, tolerance: &Tolerance) -> Result<()> {
    const PLACES: usize = 24;
    /// Where guides lie close together beside a wide gap, splines across them take what they miss the sections by so many times.
    const AMPLIFIED: f64 = 64.0;
    let size = surface.hull().diagonal();
    let given = || net.ribs.iter().filter(|rib| rib.chain.origin() != surface.origin());
    let anchors = || net.order.iter().zip(&net.places).flat_map(|(j, place)| given().map(move |rib| (*j, *place, rib)));
    let miss =
        |(j, place, rib): (usize, usize, &Rib)| net.guides[j].chain.point(rib.on_guides[j]).distance(rib.chain.point(rib.breaks[place]));
    let allowed = NEAREST * size + tolerance.point + AMPLIFIED * anchors().map(miss).fold(0.0, f64::max);
    let (us, vs) = (net.ribs.iter().map(|r| r.w), net.places.iter().map(|k| net.breaks[*k]));
    let far = |p: DVec3, q: DVec3| p.distance(q) > allowed;
    let fault =
        |at: DVec3| CurveFault::NotConverged { of: surface.origin(), what: "the surface through its own sections".to_owned(), at }.into();
    for (rib, u) in net.ribs.iter().zip(us) {
        let map = Map::new(net.breaks.clone(), rib.breaks.clone(), Reparam::Smooth, net.closed.1);
        for k in 0..=PLACES {
            let v = k as f64 / PLACES as f64;
            let p = rib.chain.point(map.value(v));
            if far(surface.jet_one_sided(u, v, (OneSided::After, OneSided::After)).p, p) {
                return Err(fault(p));
            }
        }
    }
    for (&j, v) in net.order.iter().zip(vs) {
        for rib in &net.ribs {
            let p = net.guides[j].chain.point(rib.on_guides[j]);
            if far(surface.point(rib.w, v), p) {
                return Err(fault(p));
            }
        }
    }
    Ok(())
}

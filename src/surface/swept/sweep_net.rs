//! The net of a sweep: stations along the main guide, a section at each, and the guides between.

use glam::DVec3;

use crate::base::fault::{Fault, Result, ValueFault};
use crate::base::math;
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::network::Chain;
use crate::surface::faults::SweepFault;
use crate::surface::rails::rail::Rail;
use crate::surface::rails::reparam::{Even, Map};
use crate::surface::swept::laws::{Law, Main, Station, check_section, plane_normal, samples};
use crate::surface::swept::marks::Marks;
use crate::surface::swept::ribs::Given;
use crate::surface::swept::sections::{Guide, Section, against, aligned, apart};
use crate::surface::swept::sweep_input::Input;
use crate::surface::swept::synchronized::{self, Divided};

/// Sections and the main guide's direction turn by at most this between two stations, radians.
const TURN: f64 = std::f64::consts::PI / 12.0;

/// A guide that is too short, with what is to be said if it cannot be made longer.
pub struct TooShort {
    /// Its place.
    pub guide: usize,
    /// E634 or E640.
    pub fault: Fault,
}

/// A section at a station.
#[derive(Clone, Debug)]
pub struct Rib {
    /// Fraction of the main guide.
    pub w: f64,
    /// Fractions of the guides, in their given order.
    pub on_guides: Vec<f64>,
    /// The curve.
    pub chain: Chain,
    /// Fractions of the common breaks.
    pub breaks: Vec<f64>,
}

/// A place along the main guide at which a section is made.
pub(super) struct Place {
    /// Fraction of the main guide.
    pub w: f64,
    /// Fractions of the guides, in their given order.
    pub on_guides: Vec<f64>,
    /// Whether it lies half way between two stations.
    pub halfway: bool,
}

/// All that the surface is made of.
pub struct SweepNet {
    /// Guides, in the main guide's direction.
    pub guides: Vec<Guide>,
    /// Places of the guides in the order in which sections meet them.
    pub order: Vec<usize>,
    /// Sections at all stations, by ascending w.
    pub ribs: Vec<Rib>,
    /// Sections half way between two stations, by ascending w: the surface is compared with them, it is not made of them.
    pub halfway: Vec<Rib>,
    /// v of the common breaks.
    pub breaks: Vec<f64>,
    /// Which break each guide runs through, in the order of `order`.
    pub places: Vec<usize>,
    /// Whether u and v are closed.
    pub closed: (bool, bool),
    /// W639 and W644.
    pub notes: Vec<Fault>,
}

impl SweepNet {
    /// Fractions of a guide at the stations, and at its end where u is closed.
    pub fn on_guide(&self, j: usize) -> Vec<f64> {
        let own = self.ribs.iter().map(|rib| rib.on_guides[j]);
        own.chain(self.closed.0.then_some(1.0)).collect()
    }

    /// Whether some guide has a corner at a station where others have none: the surface goes on smoothly there beside that guide.
    pub fn rounds_corners(&self, tolerance: &Tolerance) -> bool {
        let at_corner = |j: usize| -> Vec<usize> {
            let (places, kinks) = (self.on_guide(j), self.guides[j].chain.kinks(tolerance));
            (0..places.len()).filter(|k| kinks.iter().any(|f| (f - places[*k]).abs() <= NUDGE)).collect()
        };
        let first = at_corner(0);
        (1..self.guides.len()).any(|j| at_corner(j) != first)
    }

    /// Spans between stations over which all guides are straight, and stations at which all of them have a corner.
    pub fn even(&self, tolerance: &Tolerance) -> Even {
        let rails: Vec<Rail> = self.guides.iter().map(|guide| Rail::new(guide.chain.clone(), Map::identity())).collect();
        let places: Vec<Vec<f64>> = (0..rails.len()).map(|j| self.on_guide(j)).collect();
        let kinks: Vec<Vec<f64>> = self.guides.iter().map(|guide| guide.chain.kinks(tolerance)).collect();
        let n = places[0].len();
        let corner = |k: usize| (0..rails.len()).all(|j| kinks[j].iter().any(|f| (f - places[j][k]).abs() <= NUDGE));
        let straight = |k: usize| (0..rails.len()).all(|j| rails[j].is_straight(places[j][k], places[j][k + 1]));
        Even { pieces: (0..n - 1).map(straight).collect(), jumps: (0..n).filter(|k| corner(*k)).collect() }
    }
}

/// Makes the net, with stations at the fractions `more` of the main guide too, or says which guide is too short for it.
pub fn net(input: &Input, guides: &[Guide], more: &[f64], tolerance: &Tolerance) -> Result<std::result::Result<SweepNet, TooShort>> {
    let (sections, law, origin) = (input.sections, input.law, input.origin);
    let mut found = Vec::with_capacity(sections.len());
    for chain in sections {
        match Section::meeting(chain, guides, tolerance)? {
            Ok(section) => found.push(section),
            Err(guide) => return Ok(Err(TooShort { guide, fault: apart(chain, &guides[guide]) })),
        }
    }
    found.sort_by(|a, b| a.on_guides[0].total_cmp(&b.on_guides[0]));
    let (mut guides, mut sections) = (guides.to_vec(), found);
    let closed_u = seams(&mut guides, &mut sections, tolerance)?;
    let main_chain = guides[0].chain.clone();
    let normal = common_normal(&sections, &main_chain);
    let mut main = Main::new(&main_chain, law, normal, tolerance)?;
    let turn = |sections: &[Section], k: usize| {
        let (from, to) = (sections[k - 1].on_guides[0], sections[k].on_guides[0]);
        match law {
            Law::Synchronized => Divided { guides: &guides, sections }.turn((from, to)),
            _ => main.station(to).turn * main.station(from).turn.transpose(),
        }
    };
    let order = aligned(&mut sections, &guides, turn, tolerance)?;
    let closed = (closed_u, sections[0].chain.is_closed(tolerance));
    for section in &sections {
        let station = main.station(section.on_guides[0]);
        if law != Law::Synchronized {
            check_section(&section.chain, &station, law, (&sections[0].chain, &guides[0].given), tolerance)?;
        }
    }
    directions(&mut guides, &mut sections, law, closed_u, &mut main)?;
    let mut ws = stations(&mut main, &guides, &sections, law, closed_u, tolerance);
    ws.extend(more);
    let ws = graded(ws, closed_u);
    let mut places: Vec<Place> = Vec::with_capacity(2 * ws.len());
    for (w, halfway) in with_middles(&ws, closed_u) {
        let station = main.station(w);
        match on_guides(&guides, &sections, &station, law, places.last().map(|place| &place.on_guides), tolerance) {
            Ok(Ok(on_guides)) => places.push(Place { w, on_guides, halfway }),
            // A section that is only compared with the surface fails no sweep.
            _ if halfway => {}
            Ok(Err(short)) => return Ok(Err(short)),
            Err(fault) => return Err(fault),
        }
    }
    let marks = Marks::new(&sections, &order, closed.1, tolerance)?;
    let (breaks, through) = (marks.mean(), marks.places.clone());
    let mut made = SweepNet { guides, order, ribs: Vec::new(), halfway: Vec::new(), breaks, places: through, closed, notes: Vec::new() };
    let given = Given { sections: &sections, marks: &marks, law, origin, tolerance };
    given.ribs(&mut made, places, &mut main)?;
    Ok(Ok(made))
}

/// Stations and the middles between them, in order, and which of them are middles.
fn with_middles(ws: &[f64], closed: bool) -> Vec<(f64, bool)> {
    let ends = ws[1..].iter().copied().chain(closed.then_some(1.0));
    let spans: Vec<(f64, f64)> = ws.iter().copied().zip(ends).collect();
    let mut all: Vec<(f64, bool)> = spans.into_iter().flat_map(|(from, to)| [(from, false), (0.5 * (from + to), true)]).collect();
    if !closed {
        all.push((ws[ws.len() - 1], false));
    }
    all
}

/// Begins closed guides at the first section; whether they are closed.
fn seams(guides: &mut [Guide], sections: &mut [Section], tolerance: &Tolerance) -> Result<bool> {
    let closed = guides[0].chain.is_closed(tolerance);
    if let Some(j) = guides.iter().position(|g| g.chain.is_closed(tolerance) != closed) {
        let found = format!("closed and open curves, number {} unlike the first", j + 1);
        return Err(ValueFault::OutsideRange { argument: "guides", found, range: "all closed, or all open".to_owned() }.into());
    }
    if closed {
        for (j, guide) in guides.iter_mut().enumerate() {
            let start = sections[0].on_guides[j];
            *guide = guide.from(start, tolerance)?;
            sections.iter_mut().for_each(|s| s.on_guides[j] = (s.on_guides[j] - start).rem_euclid(1.0));
        }
    }
    Ok(closed)
}

/// Normal of the first flat section; where all are straight, that of the plane through them across the main guide's chord.
fn common_normal(sections: &[Section], main: &Chain) -> DVec3 {
    let flat = sections.iter().map(|s| plane_normal(&s.chain)).find(|n| *n != DVec3::ZERO);
    flat.unwrap_or_else(|| {
        let way = (sections[0].chain.end() - sections[0].chain.start()).normalize_or_zero();
        (main.end() - main.start()).reject_from_normalized(way).normalize_or_zero()
    })
}

/// Turns the guides to run as the main one does; E635 where one meets the sections in another order.
fn directions(guides: &mut [Guide], sections: &mut [Section], law: Law, closed: bool, main: &mut Main) -> Result<()> {
    for (j, guide) in guides.iter_mut().enumerate().skip(1) {
        let (first, last) = (sections[0].on_guides[j], sections[sections.len() - 1].on_guides[j]);
        let backwards = if sections.len() > 1 && !closed {
            last < first
        } else {
            let station = main.station(sections[0].on_guides[0]);
            against(guide, first, &station, law, main.chain.jet(station.w).d1)
        };
        if backwards {
            *guide = guide.reversed();
            for section in sections.iter_mut() {
                let f = &mut section.on_guides[j];
                *f = if closed && *f == 0.0 { 0.0 } else { 1.0 - *f };
            }
        }
        if let Some(w) = sections.windows(2).find(|w| w[1].on_guides[j] <= w[0].on_guides[j]) {
            let fault = SweepFault::GuideDoublesBack { guide: guide.given.origin(), law: law.name(), at: w[1].anchor(j) };
            return Err(fault.into());
        }
    }
    Ok(())
}

/// Stations farther from each other than this share of the main guide are two.
const QUARTER: f64 = 0.25;

/// Smooth knots of guides are one station where they are no farther from each other than this share of the main guide: splines
/// through stations that lie together are sensitive to rounding.
const TOGETHER: f64 = 1.0 / 64.0;

/// Fractions of the main guide for all stations: sections, breaks of all guides, ends, and more where it turns.
fn stations(main: &mut Main, guides: &[Guide], sections: &[Section], law: Law, closed: bool, tolerance: &Tolerance) -> Vec<f64> {
    let divided = Divided { guides, sections };
    let mut ws: Vec<f64> = sections.iter().map(|s| s.on_guides[0]).collect();
    // A guide is longer than the tolerance; of one that is hardly so one end is a station, whatever its section.
    let near = NUDGE.max(tolerance.point / main.chain.length()).min(QUARTER);
    let mut offer = |w: f64| {
        let taken = ws.iter().any(|x| (x - w).abs() <= near);
        if !taken && (0.0..=1.0).contains(&w) && !(closed && 1.0 - w <= near) {
            ws.push(w);
        }
    };
    offer(0.0);
    if !closed {
        offer(1.0);
    }
    guides[0].breaks(tolerance).into_iter().for_each(&mut offer);
    // Other guides need a station at their corners only; knots of theirs that lie together share one, in the middle.
    let mut knots: Vec<f64> = Vec::new();
    for (j, guide) in guides.iter().enumerate().skip(1) {
        let corners = guide.chain.kinks(tolerance);
        for f in guide.breaks(tolerance) {
            let w = if law == Law::Synchronized { divided.on_main(j, f) } else { main.fraction_of(guide.chain.point(f)).unwrap_or(-1.0) };
            if corners.iter().any(|c| (c - f).abs() <= NUDGE) { offer(w) } else { knots.push(w) }
        }
    }
    knots.sort_by(f64::total_cmp);
    for cluster in knots.chunk_by(|a, b| b - a <= TOGETHER) {
        let middle = 0.5 * (cluster[0] + cluster[cluster.len() - 1]);
        if ws.iter().all(|w| (w - middle).abs() > TOGETHER) && (TOGETHER..=1.0 - TOGETHER).contains(&middle) {
            ws.push(middle);
        }
    }
    ws.sort_by(f64::total_cmp);
    let mut all = Vec::with_capacity(ws.len());
    for k in 0..ws.len() {
        all.push(ws[k]);
        let next = if k + 1 < ws.len() { ws[k + 1] } else { 1.0 };
        if next > ws[k] + near {
            let parts =
                (turning(main, (law == Law::Synchronized).then_some(divided), (ws[k], next)) / TURN - NUDGE).ceil().max(1.0) as usize;
            all.extend((1..parts).map(|n| ws[k] + (next - ws[k]) * n as f64 / parts as f64));
        }
    }
    all
}

/// A span between stations is at most so many times as long as the ones beside it: splines through uneven stations swing in long spans.
const UNEVEN: f64 = 3.0;

/// Stations with more of them in the middle of every span that is much longer than one beside it.
fn graded(mut ws: Vec<f64>, closed: bool) -> Vec<f64> {
    ws.sort_by(f64::total_cmp);
    loop {
        let n = ws.len();
        let mut spans: Vec<f64> = ws.windows(2).map(|w| w[1] - w[0]).collect();
        if closed {
            spans.push(1.0 - ws[n - 1]);
        }
        let beside = |k: usize| {
            let (before, after) = match closed {
                true => (Some((k + spans.len() - 1) % spans.len()), Some((k + 1) % spans.len())),
                false => (k.checked_sub(1), Some(k + 1)),
            };
            before.into_iter().chain(after).filter_map(|i| spans.get(i)).fold(f64::INFINITY, |least, span| least.min(*span))
        };
        let middles: Vec<f64> = (0..spans.len()).filter(|k| spans[*k] > UNEVEN * beside(*k)).map(|k| ws[k] + 0.5 * spans[k]).collect();
        if middles.is_empty() {
            return ws;
        }
        ws.extend(middles);
        ws.sort_by(f64::total_cmp);
    }
}

/// By how much sections and the directions of the guides turn between two fractions of the main one, radians.
fn turning(main: &mut Main, divided: Option<Divided>, (from, to): (f64, f64)) -> f64 {
    // Looked at in eight parts, so that a whole turn is one.
    const PARTS: usize = 8;
    let at = |k: usize| from + (to - from) * k as f64 / PARTS as f64;
    let guides = divided.map_or(1, |d| d.guides.len());
    let (mut section, mut ways) = (0.0, vec![0.0; guides]);
    for k in 0..PARTS {
        section += match divided {
            Some(divided) => synchronized::angle(divided.turn((at(k), at(k + 1)))),
            None => {
                let (a, b) = (main.station(at(k)).turn, main.station(at(k + 1)).turn);
                [0, 1, 2].map(|c| math::angle_between(a.col(c), b.col(c))).into_iter().fold(0.0, f64::max)
            }
        };
        for (j, way) in ways.iter_mut().enumerate() {
            let (chain, a, b) = match divided {
                Some(d) if j > 0 => (&d.guides[j].chain, d.on_guide(j, at(k)), d.on_guide(j, at(k + 1))),
                _ => (main.chain, at(k), at(k + 1)),
            };
            // What the ends of a part do not show, as of a helix, its curvature does.
            let bend = chain.jet(0.5 * (a + b)).d2.length() / chain.length() * (b - a);
            *way += math::angle_between(chain.jet(a).d1, chain.jet_before(b).d1).max(bend);
        }
    }
    ways.into_iter().fold(section, f64::max)
}

/// Fractions of all guides at a station, after those of the station before.
fn on_guides(
    guides: &[Guide],
    sections: &[Section],
    station: &Station,
    law: Law,
    before: Option<&Vec<f64>>,
    tolerance: &Tolerance,
) -> Result<std::result::Result<Vec<f64>, TooShort>> {
    if let Some(section) = sections.iter().find(|s| s.on_guides[0] == station.w) {
        return Ok(Ok(section.on_guides.clone()));
    }
    let mut row = vec![station.w];
    for (j, guide) in guides.iter().enumerate().skip(1) {
        if law == Law::Synchronized {
            row.push(Divided { guides, sections }.on_guide(j, station.w));
            continue;
        }
        let passes = guide.passes(station, tolerance);
        let low = before.map_or(-1.0, |row| row[j]);
        let high = sections.iter().filter(|s| s.on_guides[0] > station.w).map(|s| s.on_guides[j]).fold(2.0, f64::min);
        let mut inside = passes.iter().copied().filter(|f| *f > low && *f < high);
        let far = |f: f64| guide.chain.point(f).distance_squared(station.at);
        let next = match law {
            // A plane across a winding way meets a guide again elsewhere.
            Law::Normal => inside.min_by(|a, b| far(*a).total_cmp(&far(*b))),
            _ => {
                let first = inside.next();
                // A guide that goes on in its direction is there again a whole turn later.
                let back = |a: f64, b: f64| {
                    let slope = |f: f64| station.slope(guide.chain.jet(f).d1);
                    !matches!(law, Law::Rotational(_)) || slope(a) * slope(b) < 0.0
                };
                let again = first.and_then(|a| inside.next().filter(|b| back(a, *b)));
                if let Some(again) = again {
                    let at = guide.chain.point(again);
                    return Err(SweepFault::GuideDoublesBack { guide: guide.given.origin(), law: law.name(), at }.into());
                }
                first
            }
        };
        match (next, passes.first()) {
            (Some(f), _) => row.push(f),
            (None, Some(f)) if guide.chain.is_closed(tolerance) || guide.own != (0.0, 1.0) => {
                let at = guide.chain.point(*f);
                return Err(SweepFault::GuideDoublesBack { guide: guide.given.origin(), law: law.name(), at }.into());
            }
            _ => {
                let places = samples(&guide.chain).into_iter().map(|f| guide.chain.point(f));
                let nearest = places.min_by(|a, b| station.off(*a).abs().total_cmp(&station.off(*b).abs())).unwrap_or(station.at);
                let fault = SweepFault::GuideMissesStation {
                    guide: guide.given.origin(),
                    law: law.name(),
                    station: station.w,
                    at: station.at,
                    miss: station.off(nearest).abs(),
                    nearest,
                };
                return Ok(Err(TooShort { guide: j, fault: fault.into() }));
            }
        }
    }
    Ok(Ok(row))
}

//! Sections and guides put in order: where they touch, which way they run, where a closed one starts.

use crate::network::fault::GridFault;
use glam::{DMat3, DVec3};

use crate::base::fault::{Fault, Result, ValueFault};
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::geometry::curves::curve::Shape;
use crate::geometry::{Curve, Kind};
use crate::network::meet::{closest_points, meet};
use crate::network::{Chain, Run};
use crate::surface::data::breaks::chain_breaks;
use crate::surface::faults::SectionFault;
use crate::surface::swept::laws::{Law, Station, halved, samples};

/// A guide is made longer by this share of its length at each end, at most.
const LONGER: f64 = 0.25;

/// A guide, perhaps with more at its ends than was given.
#[derive(Clone, Debug)]
pub struct Guide {
    /// As given.
    pub given: Chain,
    /// What is used, in the main guide's direction.
    pub chain: Chain,
    /// Where what was given lies on it.
    pub own: (f64, f64),
}

impl Guide {
    /// As it was given.
    pub fn new(given: &Chain) -> Self {
        Self { given: given.clone(), chain: given.clone(), own: (0.0, 1.0) }
    }

    /// The same, longer at both ends along the curves it ends with; none for a closed one.
    pub fn longer(given: &Chain, tolerance: &Tolerance) -> Result<Option<Self>> {
        if given.is_closed(tolerance) {
            return Ok(None);
        }
        let curve = given.to_curve()?.to_nurbs(tolerance)?;
        let (a, b) = curve.domain();
        let reach = LONGER * given.length();
        let piece = |t0: f64, t1: f64| {
            let curve = Curve::new(Shape::Nurbs(std::sync::Arc::new(curve.part(t0, t1))), Kind::Nurbs, given.origin());
            Run { s0: 0.0, s1: curve.length(), curve }
        };
        let (first, last) = (curve.jet(a).d1.length(), curve.jet(b).d1.length());
        let (head, tail) = (piece(a - reach / first, a), piece(b, b + reach / last));
        let (before, after) = (head.length(), tail.length());
        let runs: Vec<_> = std::iter::once(head).chain(given.runs().iter().cloned()).chain(std::iter::once(tail)).collect();
        let chain = Chain::of_runs(runs, given.origin());
        let whole = chain.length();
        Ok(Some(Self { given: given.clone(), own: (before / whole, (whole - after) / whole), chain }))
    }

    /// The other way round.
    pub fn reversed(&self) -> Self {
        Self { given: self.given.clone(), chain: self.chain.reversed(), own: (1.0 - self.own.1, 1.0 - self.own.0) }
    }

    /// A closed guide begun at a fraction.
    pub fn from(&self, f: f64, tolerance: &Tolerance) -> Result<Self> {
        let chain = if on_seam(f, &self.chain, tolerance) { self.chain.clone() } else { self.chain.slice(f, f, tolerance)? };
        Ok(Self { chain, ..self.clone() })
    }

    /// Breaks of what was given.
    pub fn breaks(&self, tolerance: &Tolerance) -> Vec<f64> {
        let inside = |f: &f64| *f > self.own.0 + tolerance.parameter && *f < self.own.1 - tolerance.parameter;
        chain_breaks(&self.chain).into_iter().filter(inside).collect()
    }

    /// Fractions in ascending order where it passes a station.
    pub fn passes(&self, station: &Station, tolerance: &Tolerance) -> Vec<f64> {
        let value = |f: f64| station.off(self.chain.point(f));
        let stops = samples(&self.chain);
        let values: Vec<f64> = stops.iter().map(|&f| value(f)).collect();
        let mut found = Vec::new();
        for k in 0..stops.len() {
            let end = k == 0 || k + 1 == stops.len();
            if values[k] == 0.0 || (end && values[k].abs() <= tolerance.point) {
                found.push(stops[k]);
            } else if k > 0 && values[k - 1] != 0.0 && (values[k - 1] < 0.0) != (values[k] < 0.0) {
                found.push(halved((stops[k - 1], stops[k]), values[k - 1] < 0.0, value));
            }
        }
        found.retain(|&f| station.faces(self.chain.point(f)));
        found.sort_by(f64::total_cmp);
        let near = tolerance.point / self.chain.length();
        found.dedup_by(|b, a| *b - *a <= near);
        found
    }
}

/// Whether a fraction is the start of a closed chain.
fn on_seam(f: f64, chain: &Chain, tolerance: &Tolerance) -> bool {
    let near = tolerance.point / chain.length();
    f <= near || f >= 1.0 - near
}

/// A section and where it touches the guides.
#[derive(Clone, Debug)]
pub struct Section {
    /// The curve, in the direction of the others; a closed one starts at the main guide.
    pub chain: Chain,
    /// Fractions at the guides, in the order of the guides.
    pub anchors: Vec<f64>,
    /// Fractions of the guides there.
    pub on_guides: Vec<f64>,
}

impl Section {
    /// Where a section meets all guides; the index of a guide that it meets nowhere, or E640 and E603.
    pub fn meeting(chain: &Chain, guides: &[Guide], tolerance: &Tolerance) -> Result<std::result::Result<Self, usize>> {
        let (mut anchors, mut on_guides) = (Vec::new(), Vec::new());
        for (j, guide) in guides.iter().enumerate() {
            let found = meet(chain, &guide.chain, tolerance)?;
            match found.as_slice() {
                [] => return Ok(Err(j)),
                [one] => {
                    let (fa, fb) = sharpened(chain, &guide.chain, (one.fa, one.fb));
                    anchors.push(on_break(snapped(fa, chain, tolerance), chain, tolerance));
                    on_guides.push(snapped(fb, &guide.chain, tolerance));
                }
                [one, two, ..] => {
                    let fault = GridFault::GridDouble { a: chain.origin(), b: guide.given.origin(), first: one.point, second: two.point };
                    return Err(fault.into());
                }
            }
        }
        Ok(Ok(Self { chain: chain.clone(), anchors, on_guides }))
    }

    /// The point at anchor `j`.
    pub fn anchor(&self, j: usize) -> DVec3 {
        self.chain.point(self.anchors[j])
    }

    /// The run backwards.
    pub fn reversed(&self) -> Self {
        let anchors = self.anchors.iter().map(|f| 1.0 - f).collect();
        Self { chain: self.chain.reversed(), anchors, on_guides: self.on_guides.clone() }
    }

    /// A closed section begun at its first anchor.
    pub fn begun(&self, tolerance: &Tolerance) -> Result<Self> {
        let start = self.anchors[0];
        let seam = on_seam(start, &self.chain, tolerance);
        let chain = if seam { self.chain.clone() } else { self.chain.slice(start, start, tolerance)? };
        let after = |f: &f64| if seam { *f } else { (f - start).rem_euclid(1.0) };
        let mut anchors: Vec<f64> = self.anchors.iter().map(after).collect();
        anchors[0] = 0.0;
        Ok(Self { chain, anchors, on_guides: self.on_guides.clone() })
    }

    /// How unlike it lies to another section that the law has turned up to it, each about its first anchor.
    fn unlike(&self, other: &Self, turn: DMat3) -> f64 {
        const PLACES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
        let arm = |s: &Self, f: f64| s.chain.point(f) - s.anchor(0);
        PLACES.iter().map(|&f| arm(self, f).distance_squared(turn * arm(other, f))).sum()
    }
}

/// Fractions of the nearest points of two curves beside a meeting, to rounding.
fn sharpened(a: &Chain, b: &Chain, (mut fa, mut fb): (f64, f64)) -> (f64, f64) {
    const STEPS: usize = 4;
    for _ in 0..STEPS {
        let (p, q) = (a.jet(fa), b.jet(fb));
        let (apart, x, y) = (q.p - p.p, p.d1, -q.d1);
        // Least squares for p + x·s + y·t = q.
        let (xx, xy, yy) = (x.dot(x), x.dot(y), y.dot(y));
        let area = xx * yy - xy * xy;
        if area <= NUDGE * xx * yy {
            break;
        }
        let (r, s) = (apart.dot(x), apart.dot(y));
        let next = ((fa + (yy * r - xy * s) / area).clamp(0.0, 1.0), (fb + (xx * s - xy * r) / area).clamp(0.0, 1.0));
        // Beside a corner a step may lead away.
        if a.point(next.0).distance(b.point(next.1)) >= apart.length() {
            break;
        }
        (fa, fb) = next;
    }
    (fa, fb)
}

/// A fraction within a tolerance of an end is that end.
fn snapped(f: f64, chain: &Chain, tolerance: &Tolerance) -> f64 {
    let near = tolerance.point / chain.length();
    if f <= near {
        0.0
    } else if f >= 1.0 - near {
        1.0
    } else {
        f
    }
}

/// A fraction within a tolerance of a break of a curve is that break: nothing is cut off between the two.
fn on_break(f: f64, chain: &Chain, tolerance: &Tolerance) -> f64 {
    let near = tolerance.point / chain.length();
    let breaks = chain_breaks(chain).into_iter().filter(|b| (b - f).abs() <= near);
    breaks.min_by(|a, b| (a - f).abs().total_cmp(&(b - f).abs())).unwrap_or(f)
}

/// E640: a section that touches a guide nowhere.
pub fn apart(section: &Chain, guide: &Guide) -> Fault {
    let (p, q) = closest_points(section, &guide.given);
    SectionFault::MissesGuide { section: section.origin(), guide: guide.given.origin(), gap: p.distance(q), at: p }.into()
}

/// Turns sections so that all meet the guides in one order, and puts the guides in that order.
///
/// `turn` says how the law turns a section up to the one at a place, from the one before it.
///
/// Returns that order: places of the guides along the sections. E604 where a section has another.
pub fn aligned(
    sections: &mut [Section],
    guides: &[Guide],
    mut turn: impl FnMut(&[Section], usize) -> DMat3,
    tolerance: &Tolerance,
) -> Result<Vec<usize>> {
    let closed = sections[0].chain.is_closed(tolerance);
    if let Some(other) = sections.iter().find(|s| s.chain.is_closed(tolerance) != closed) {
        let found = format!("closed and open curves, {:.0}% along the first guide one of the other kind", 100.0 * other.on_guides[0]);
        return Err(ValueFault::OutsideRange { argument: "sections", found, range: "all closed, or all open".to_owned() }.into());
    }
    if closed {
        for section in sections.iter_mut() {
            *section = section.begun(tolerance)?;
        }
    }
    let order = |s: &Section| -> Vec<usize> {
        let mut order: Vec<usize> = (0..guides.len()).collect();
        order.sort_by(|&a, &b| s.anchors[a].total_cmp(&s.anchors[b]));
        order
    };
    let reversed = |s: &Section| if closed { s.reversed().begun(tolerance) } else { Ok(s.reversed()) };
    let wanted = order(&sections[0]);
    for k in 1..sections.len() {
        let other = reversed(&sections[k])?;
        let (as_is, turned) = (order(&sections[k]) == wanted, order(&other) == wanted);
        let back = match (as_is, turned) {
            (true, true) => {
                let (before, turn) = (&sections[k - 1], turn(sections, k));
                other.unlike(before, turn) < sections[k].unlike(before, turn)
            }
            (false, true) => true,
            (true, false) => false,
            (false, false) => {
                let own = order(&sections[k]);
                let at = (0..own.len()).find(|&n| own[n] != wanted[n]).unwrap_or(0);
                let (a, b) = (wanted[at], own[at]);
                let (first, second) = (sections[k].anchor(a), sections[k].anchor(b));
                let origin = |j: usize| guides[j].given.origin();
                let curve = sections[k].chain.origin();
                return Err(GridFault::GridNotMonotone { curve, a: origin(a), b: origin(b), first, second }.into());
            }
        };
        if back {
            sections[k] = other;
        }
    }
    Ok(wanted)
}

/// Whether a guide runs against the law at a station, seen at one of its fractions.
pub fn against(guide: &Guide, f: f64, station: &Station, law: Law, main: DVec3) -> bool {
    let d = guide.chain.jet(f).d1;
    if law == Law::Synchronized { d.dot(main) < 0.0 } else { station.slope(d) < 0.0 }
}

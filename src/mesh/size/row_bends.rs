//! How a mapped face is bent from place to place along its sides, over what limits allow of its rows.

use glam::DVec3;

use crate::base::tolerance::WHOLE_NUMBER;
use crate::base::{job, work};
use crate::mesh::border::layout::Face;
use crate::mesh::border::side_parameters::SideMap;
use crate::mesh::request::input::Input;
use crate::mesh::request::limits::Limits;
use crate::mesh::size::row_profile::{Bend, RowProfile};
use crate::surface::{Evaluator, Jet2, OneSided};

/// What steers the search for bends.
struct BendSettings {
    /// Places across the rows at which bends are taken, at least, evenly between the sides.
    across: usize,
    /// Break lines across the rows between which bends are taken too, at most.
    max_breaks: usize,
    /// Places in an interval at which bends are taken, as shares of it: none on a break line.
    places: [f64; 3],
    /// Largest ratio of demands at these places in an interval that is not halved.
    max_ratio: f64,
    /// An interval of fewer rows is not halved.
    min_rows: f64,
    /// Halvings of an interval between break lines at most.
    max_halvings: u32,
    /// Intervals of a side at most.
    max_intervals: usize,
    /// Share of the chord error that is left for one direction at least where the other one bends too.
    min_share: f64,
}

const SETTINGS: BendSettings = BendSettings {
    across: 6,
    max_breaks: 8,
    places: [1.0 / 8.0, 0.5, 7.0 / 8.0],
    max_ratio: 1.25,
    min_rows: 0.5,
    max_halvings: 12,
    max_intervals: 1 << 14,
    min_share: 0.5,
};

/// One direction of a mapped face, with the sides along it.
pub(super) struct RowDirection<'a> {
    evaluator: Evaluator<'a>,
    limits: &'a Limits,
    /// 0: rows follow each other along u, 1: along v.
    direction: usize,
    /// Sides along the direction; a pole has the map of the other one.
    sides: [SideMap<'a>; 2],
    /// Values of the parameter along the direction at break lines inside the face, ascending.
    breaks: Vec<f64>,
    /// Values of the other parameter at which bends are taken: the first and the last are those of the sides.
    across: Vec<f64>,
    /// Step of the other parameter that the size allows.
    step_across: f64,
}

impl<'a> RowDirection<'a> {
    /// Of a face with four sides, `None` where both sides along the direction are poles.
    pub(super) fn new(input: &'a Input, evaluator: Evaluator<'a>, limits: &'a Limits, face: &Face, direction: usize) -> Option<Self> {
        let used = |k: usize| !face.sides[k].uses.is_empty();
        let [first, second] = [direction, direction + 2];
        let (a, b) = match (used(first), used(second)) {
            (true, true) => (first, second),
            (true, false) => (first, first),
            (false, true) => (second, second),
            (false, false) => return None,
        };
        let patch = &input.model.patches[face.patch.index()];
        let (us, vs) = evaluator.surface().breaks();
        let inside = |lines: Vec<f64>, (low, high): (f64, f64)| lines.into_iter().filter(|x| *x > low && *x < high).collect::<Vec<f64>>();
        let (us, vs) = (inside(us, patch.u), inside(vs, patch.v));
        let (breaks, mut lines, (low, high)) = if direction == 0 { (us, vs, patch.v) } else { (vs, us, patch.u) };
        let mut across: Vec<f64> = (0..=SETTINGS.across).map(|k| low + (high - low) * k as f64 / SETTINGS.across as f64).collect();
        if lines.len() <= SETTINGS.max_breaks && !lines.is_empty() {
            lines.insert(0, low);
            lines.push(high);
            across.extend(lines.windows(2).map(|w| 0.5 * (w[0] + w[1])));
            across.sort_by(f64::total_cmp);
        }
        let length = face.sides[1 - direction].length.max(face.sides[3 - direction].length);
        let step_across = (high - low) / (length / face.size.0).max(1.0);
        Some(Self {
            evaluator,
            limits,
            direction,
            breaks,
            sides: [SideMap::new(input, face, a), SideMap::new(input, face, b)],
            across,
            step_across,
        })
    }

    /// The bends at every place.
    pub(super) fn profile(&self) -> RowProfile {
        let mut profile = RowProfile { stops: vec![0.0], bends: Vec::new(), longest: 0.0 };
        let mut lengths = vec![0.0; self.across.len()];
        let stops = self.stops();
        for w in stops.windows(2) {
            let mut open = vec![(w[0], w[1], SETTINGS.max_halvings)];
            while let Some((a, b, left)) = open.pop() {
                job::poll();
                let (bend, even, steps) = self.interval(a, b);
                let halved = bend.rows(b - a) > SETTINGS.min_rows && !even;
                if left > 0 && halved && profile.bends.len() + open.len() < SETTINGS.max_intervals {
                    let middle = 0.5 * (a + b);
                    open.extend([(middle, b, left - 1), (a, middle, left - 1)]);
                    continue;
                }
                profile.stops.push(b);
                profile.bends.push(bend);
                lengths.iter_mut().zip(steps).for_each(|(sum, step)| *sum += step);
            }
        }
        profile.longest = lengths.into_iter().fold(0.0, f64::max);
        profile
    }

    /// Shares of the sides where break lines meet one of them, with both ends.
    fn stops(&self) -> Vec<f64> {
        let mut stops: Vec<f64> = self.sides.iter().flat_map(|side| self.breaks.iter().map(|x| side.share(*x))).collect();
        stops.retain(|f| *f > 0.0 && *f < 1.0);
        stops.extend([0.0, 1.0]);
        stops.sort_by(f64::total_cmp);
        stops.dedup_by(|b, a| *b - *a <= WHOLE_NUMBER);
        // The last stop is the end itself.
        if let Some(last) = stops.last_mut() {
            *last = 1.0;
        }
        stops
    }

    /// The largest bend in an interval, whether it is the same all over it, and the lengths of the lines across which bends are taken.
    fn interval(&self, a: f64, b: f64) -> (Bend, bool, Vec<f64>) {
        let ends = self.sides.each_ref().map(|side| [a, b].map(|f| side.parameter(f)));
        let (from, to) = (self.across[0], self.across[self.across.len() - 1]);
        let lines: Vec<[f64; 2]> = self
            .across
            .iter()
            .map(|other| {
                let y = (other - from) / (to - from);
                [0, 1].map(|end| ends[0][end] + (ends[1][end] - ends[0][end]) * y)
            })
            .collect();
        let mut found = [Bend::default(); SETTINGS.places.len()];
        let mut lengths = Vec::with_capacity(lines.len());
        for (k, (jets, [low, high])) in self.jets(&lines).into_iter().zip(lines).enumerate() {
            let on_side = k == 0 || k + 1 == self.across.len();
            for (jet, most) in jets.iter().zip(&mut found) {
                *most = most.max(self.bend(jet, (high - low) / (b - a), on_side));
            }
            lengths.push(jets[SETTINGS.places.len() / 2].du.length() * (high - low).abs());
        }
        let rows = found.map(|bend| bend.rows(1.0));
        let (least, most) = (rows.into_iter().fold(f64::INFINITY, f64::min), rows.into_iter().fold(0.0, f64::max));
        (found.into_iter().fold(Bend::default(), Bend::max), most <= SETTINGS.max_ratio * least, lengths)
    }

    /// Jets with u along the direction at the places of an interval, on each line across: `lines` are its ends on them.
    fn jets(&self, lines: &[[f64; 2]]) -> Vec<[Jet2; SETTINGS.places.len()]> {
        let surface = self.evaluator.surface();
        work::spend((lines.len() * SETTINGS.places.len()) as u64);
        let own = |[low, high]: [f64; 2]| SETTINGS.places.map(|place| low + (high - low) * place);
        if lines.iter().any(|line| line != &lines[0]) {
            let jet = |own: f64, other: f64| {
                if self.direction == 0 { self.evaluator.jet(own, other) } else { exchanged(&self.evaluator.jet(other, own)) }
            };
            return lines.iter().zip(&self.across).map(|(line, other)| own(*line).map(|own| jet(own, *other))).collect();
        }
        // One tensor grid, whose curves are evaluated once.
        let own = own(lines[0]).map(|own| (own, OneSided::After));
        let last = self.across.len() - 1;
        let lean = |k: usize| if k == last { OneSided::Before } else { OneSided::After };
        let across: Vec<(f64, OneSided)> = self.across.iter().enumerate().map(|(k, other)| (*other, lean(k))).collect();
        if self.direction == 0 {
            let jets = surface.jets(&own, &across);
            jets.chunks_exact(own.len()).map(|row| std::array::from_fn(|k| row[k])).collect()
        } else {
            let jets = surface.jets(&across, &own);
            (0..across.len()).map(|n| std::array::from_fn(|k| exchanged(&jets[k * across.len() + n]))).collect()
        }
    }

    /// The bend at a place whose jet has u along the direction, `rate` times as fast as shares of a side.
    fn bend(&self, jet: &Jet2, rate: f64, on_side: bool) -> Bend {
        let across = jet.du.cross(jet.dv);
        let area = across.length();
        let (tangent, normal) = (jet.du.normalize_or_zero(), across.normalize_or_zero());
        let mut bend = Bend::default();
        if let Some(chord) = self.limits.chord {
            let [along, twist, other] = [jet.duu, jet.duv, jet.dvv].map(|second| second.dot(normal).abs());
            // Both directions share what a twist demands: cells that are nothing but twisted are squares.
            let by_twist = (4.0 * chord * jet.du.length() / (twist * jet.dv.length())).sqrt();
            let step_across = self.step_across.min((8.0 * chord / other).sqrt()).min(by_twist);
            let left = (chord - other * step_across * step_across / 8.0).max(SETTINGS.min_share * chord);
            bend.second = along / left;
            bend.twist = twist * step_across * rate.abs() / (4.0 * left);
            if on_side {
                bend.second = bend.second.max(aside(jet.duu, tangent) / chord);
            }
            bend.second *= rate * rate;
        }
        if let Some(angle) = self.limits.angle {
            let change = jet.duu.cross(jet.dv) + jet.du.cross(jet.duv);
            let turn = if area > 0.0 { aside(change, normal) / area } else { 0.0 };
            let speed = jet.du.length();
            let curve = if on_side && speed > 0.0 { aside(jet.duu, tangent) / speed } else { 0.0 };
            bend.turn = turn.max(curve) * rate.abs() / angle;
        }
        if bend.rows(1.0).is_finite() { bend } else { Bend::default() }
    }
}

/// Length of a vector without its part along a unit vector.
fn aside(vector: DVec3, unit: DVec3) -> f64 {
    (vector - unit * vector.dot(unit)).length()
}

/// A jet with u and v exchanged.
fn exchanged(jet: &Jet2) -> Jet2 {
    Jet2 { du: jet.dv, dv: jet.du, duu: jet.dvv, dvv: jet.duu, ..*jet }
}

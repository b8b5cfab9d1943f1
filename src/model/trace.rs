//! Arc length along lines of a surface and along runs of links: every edge as one curve from 0 to its length.

use glam::DVec3;

use super::nearest::nearest;
use super::topology::EdgeCurve;
use crate::base::digest::{StableHash, StableHasher};
use crate::base::job;
use crate::base::quadrature::{self, RUNNING};
use crate::base::tolerance::{EPSILON, MEASURE_ACCURACY, NEWTON_STEP, Tolerance};
use crate::network::{Chain, Network};
use crate::surface::{LineEvaluator, OneSided, PreparedSurface, Surface};

/// Halvings of one piece before its length is taken as it is; the line is cut at kinks, so this is far from reached.
const DEPTH: u32 = 24;
/// Pieces of one line at most; what is left of it then is taken as it is: values that are all rounding never settle.
const STRETCHES: usize = 1 << 14;
/// Newton steps of the inverse; bisection takes over before that.
const STEPS: usize = 60;

/// A straight line in (u, v) on a surface under its arc length.
#[derive(Clone, Debug)]
pub struct Trace {
    prepared: PreparedSurface,
    /// Of a line of constant u or v on a blend of curves.
    line: Option<LineEvaluator>,
    from: (f64, f64),
    to: (f64, f64),
    panels: Vec<Panel>,
    length: f64,
}

// The others follow from these.
crate::content!(Trace { prepared, from, to } but { line, panels, length });

/// One piece whose length is a known polynomial of the place.
#[derive(Clone, Debug)]
struct Panel {
    t: (f64, f64),
    s: f64,
    running: [f64; RUNNING],
}

impl Trace {
    /// The line between two (u, v); the surface must be smooth along it but for jumps of higher derivatives.
    pub fn new(surface: &Surface, from: (f64, f64), to: (f64, f64)) -> Self {
        Self::of_prepared(PreparedSurface::plain(surface), from, to)
    }

    /// The same line on a surface prepared for many evaluations.
    pub fn of_prepared(prepared: PreparedSurface, from: (f64, f64), to: (f64, f64)) -> Self {
        let is_iso = (from.0 == to.0) != (from.1 == to.1) && !prepared.evaluator().has_power_form();
        let line = if is_iso { prepared.surface().line_evaluator(from, from.1 == to.1) } else { None };
        let mut trace = Self { prepared, line, from, to, panels: Vec::new(), length: 0.0 };
        let surface = trace.prepared.surface();
        let (start, end) = (surface.point(from.0, from.1), surface.point(to.0, to.1));
        // Along a pole all is rounding.
        let rounding = EPSILON * start.abs().max(end.abs()).max_element();
        let scale = start.distance(end).max(trace.speed(0.5)).max(rounding / MEASURE_ACCURACY);
        let stops = [vec![0.0], trace.prepared.surface().breaks_between(from, to), vec![1.0]].concat();
        // A short span between two knots may be run through so fast that no sample of a longer piece sees it.
        let mut open: Vec<(f64, f64, u32)> = stops.windows(2).rev().map(|w| (w[0], w[1], DEPTH)).collect();
        while let Some((a, b, left)) = open.pop() {
            job::poll();
            let panel = quadrature::kronrod(a, b, |t| trace.speed(t));
            if left > 0 && trace.panels.len() + open.len() < STRETCHES && panel.error > MEASURE_ACCURACY * scale.max(trace.length) {
                let middle = 0.5 * (a + b);
                open.push((middle, b, left - 1));
                open.push((a, middle, left - 1));
                continue;
            }
            let running = quadrature::running_integral(&panel.values);
            trace.panels.push(Panel { t: (a, b), s: trace.length, running });
            trace.length += panel.integral;
        }
        trace
    }

    /// Arc length, model units.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// (u, v) at the share `t` of the way in the parameter plane.
    pub fn uv(&self, t: f64) -> (f64, f64) {
        let mix = |a: f64, b: f64| if t == 1.0 { b } else { a + (b - a) * t };
        (mix(self.from.0, self.to.0), mix(self.from.1, self.to.1))
    }

    /// Point and derivative by `t`.
    pub fn jet(&self, t: f64) -> (DVec3, DVec3) {
        let (u, v) = self.uv(t);
        let (along_u, along_v) = (self.to.0 - self.from.0, self.to.1 - self.from.1);
        // A line may end at a kink: its own direction there is that of what it comes from.
        let ends = t == 0.0 || t == 1.0;
        let lean = |way: f64| if ends && way != 0.0 && (t == 0.0) != (way > 0.0) { OneSided::Before } else { OneSided::After };
        if let Some(line) = &self.line {
            let way = along_u + along_v;
            let (p, d1) = line.jet((u, v), lean(way));
            return (p, d1 * way);
        }
        let [p, du, dv] = if ends {
            let jet = self.prepared.surface().jet_one_sided(u, v, (lean(along_u), lean(along_v)));
            [jet.p, jet.du, jet.dv]
        } else {
            self.prepared.evaluator().tangents(u, v)
        };
        (p, du * along_u + dv * along_v)
    }

    fn speed(&self, t: f64) -> f64 {
        self.jet(t).1.length()
    }

    /// Arc length from the start to `t`.
    pub fn length_at(&self, t: f64) -> f64 {
        let k = self.panels.partition_point(|p| p.t.1 < t).min(self.panels.len() - 1);
        let (panel, half) = (&self.panels[k], 0.5 * (self.panels[k].t.1 - self.panels[k].t.0));
        let x = ((t - panel.t.0) / half - 1.0).clamp(-1.0, 1.0);
        panel.s + half * quadrature::chebyshev(&panel.running, x).0
    }

    /// The `t` at arc length `s`; outside 0…length the nearer end.
    pub fn at_length(&self, s: f64) -> f64 {
        if s <= 0.0 {
            return 0.0;
        }
        if s >= self.length {
            return 1.0;
        }
        let k = self.panels.partition_point(|p| p.s <= s).saturating_sub(1);
        let (panel, half) = (&self.panels[k], 0.5 * (self.panels[k].t.1 - self.panels[k].t.0));
        let wanted = (s - panel.s) / half;
        // As if it were run at one speed.
        let whole = self.panels.get(k + 1).map_or(self.length, |next| next.s) - panel.s;
        let (mut low, mut high, mut x) = (-1.0, 1.0, (2.0 * (s - panel.s) / whole - 1.0).clamp(-1.0, 1.0));
        for _ in 0..STEPS {
            job::poll();
            let (value, slope) = quadrature::chebyshev(&panel.running, x);
            let miss = value - wanted;
            if miss > 0.0 {
                high = x;
            } else {
                low = x;
            }
            let newton = x - miss / slope;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            // Newton's step squares what is amiss.
            let last = next == newton && (next - x).abs() <= NEWTON_STEP;
            x = next;
            if last || (high - low).abs() < f64::EPSILON {
                break;
            }
        }
        panel.t.0 + half * (x + 1.0)
    }
}

/// An edge as one curve: arc length `s` from 0 to [`Track::length`].
#[derive(Clone, Debug)]
pub enum Track {
    /// A run of links: their chains with `true` where the run goes against one, the length before each, and where on them the edge lies.
    Links {
        /// Chain of each link, along the link's own direction.
        chains: Vec<(Chain, bool)>,
        /// Arc length before each of them, and of all.
        starts: Vec<f64>,
        /// The part of the run that is used.
        span: (f64, f64),
    },
    /// A line on a surface.
    Iso(Trace),
}

impl StableHash for Track {
    fn hash_into(&self, to: &mut StableHasher) {
        match self {
            Self::Links { chains, starts, span } => (0u8, (chains, starts, *span)).hash_into(to),
            Self::Iso(trace) => (1u8, trace).hash_into(to),
        }
    }
}

impl Track {
    /// The geometry of an edge.
    pub fn of(curve: &EdgeCurve, surfaces: &[super::topology::Named], network: &Network) -> Self {
        match curve {
            EdgeCurve::Iso { surface, from, to } => Self::Iso(Trace::new(&surfaces[surface.index()].surface, *from, *to)),
            EdgeCurve::Run { chain, span } => {
                Self::Links { chains: vec![(chain.clone(), false)], starts: vec![0.0, chain.length()], span: *span }
            }
            EdgeCurve::Links { links, span } => {
                let chains: Vec<_> = links.iter().map(|(link, against)| (network.link_chain(*link), *against)).collect();
                let mut starts = vec![0.0];
                for (link, _) in links {
                    let s = network.links[link.index()].s;
                    starts.push(starts[starts.len() - 1] + (s.1 - s.0));
                }
                Self::Links { chains, starts, span: *span }
            }
        }
    }

    /// Arc lengths inside at which one curve ends and the next begins, ascending.
    pub fn joints(&self, tolerance: &Tolerance) -> Vec<f64> {
        let Self::Links { chains, starts, span } = self else { return Vec::new() };
        let mut found: Vec<f64> = starts.clone();
        for ((chain, against), w) in chains.iter().zip(starts.windows(2)) {
            let along = |f: f64| if *against { 1.0 - f } else { f };
            found.extend(chain.joints().iter().map(|f| w[0] + (w[1] - w[0]) * along(*f)));
        }
        found.iter_mut().for_each(|s| *s -= span.0);
        found.retain(|s| *s > tolerance.point && *s < self.length() - tolerance.point);
        found.sort_by(f64::total_cmp);
        found.dedup_by(|a, b| *a - *b <= tolerance.point);
        found
    }

    /// Arc length, model units.
    pub fn length(&self) -> f64 {
        match self {
            Self::Links { span, .. } => span.1 - span.0,
            Self::Iso(trace) => trace.length(),
        }
    }

    /// Point at arc length `s`; outside 0…length the nearer end.
    pub fn point(&self, s: f64) -> DVec3 {
        self.jet(s).0
    }

    /// Point and unit tangent at arc length `s` (zero where the track has none).
    pub fn jet(&self, s: f64) -> (DVec3, DVec3) {
        match self {
            Self::Iso(trace) => {
                let (p, d1) = trace.jet(trace.at_length(s));
                (p, d1.normalize_or_zero())
            }
            Self::Links { chains, starts, span } => {
                let s = (span.0 + s).clamp(span.0, span.1).clamp(0.0, starts[starts.len() - 1]);
                let k = starts.partition_point(|x| *x <= s).clamp(1, chains.len()) - 1;
                let (chain, against) = &chains[k];
                let f = ((s - starts[k]) / (starts[k + 1] - starts[k])).clamp(0.0, 1.0);
                let jet = chain.jet(if *against { 1.0 - f } else { f });
                let tangent = jet.d1.normalize_or_zero();
                (jet.p, if *against { -tangent } else { tangent })
            }
        }
    }

    /// Arc length and distance of the place between two arc lengths that is nearest to a point: no other one is nearer by more
    /// than a thousandth, and the distance is never below the true one.
    pub fn closest(&self, p: DVec3, span: (f64, f64)) -> (f64, f64) {
        nearest(|s| self.jet(s), span, p)
    }

    /// Points at a quarter, a half and three quarters of the length; what tells two edges with the same ends apart.
    pub fn probes(&self) -> [DVec3; 3] {
        [0.25, 0.5, 0.75].map(|f| self.point(f * self.length()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::origin::Origin;
    use crate::surface::points::control_net::{Net, nurbs};

    #[test]
    fn a_short_span_between_knots_counts() {
        let tolerance = Tolerance::new(1e-6, 30.0);
        let rows: Vec<Vec<DVec3>> = (0..8).map(|j| (0..2).map(|i| DVec3::new(f64::from(i), 3.0 * f64::from(j), 0.0)).collect()).collect();
        let knots_v = [vec![0.0; 6], vec![0.02, 5.0], vec![10.0; 6]].concat();
        let net = Net { rows: &rows, weights: None };
        let plane = nurbs(&net, (1, 5), (None, Some(&knots_v)), Origin::NONE, &tolerance).unwrap();
        let side = Trace::new(&plane, (1.0, 0.0), (1.0, 1.0));
        assert!((side.length() - 21.0).abs() < 1e-8, "{}", side.length());
        let back = Trace::new(&plane, (0.0, 1.0), (1.0, 0.0));
        let half = back.uv(back.at_length(0.5 * back.length()));
        assert!((back.length_at(back.at_length(4.0)) - 4.0).abs() < 1e-8);
        assert!(half.1 < 0.5, "most of the way is near v = 0: {half:?}");
    }
}

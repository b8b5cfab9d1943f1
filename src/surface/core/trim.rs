//! What a trimmed surface knows beside its borders.

use glam::DVec2;

use crate::surface::data::kind::Domain;
use crate::surface::rails::trim_curve::TrimCurve;

/// What a trimmed surface knows beside its borders.
#[derive(Clone, Debug)]
pub(crate) struct Trim {
    /// Where the surface below is defined.
    pub ground: Domain,
    /// Number of borders of each loop, the outer one first.
    pub loops: Vec<usize>,
    /// One a border.
    pub trim_curves: Vec<TrimCurve>,
    /// Corners of a box in (u, v) that holds the loops; where a surface closes they may lie whole turns away.
    pub reach: (DVec2, DVec2),
    /// How far the curves that were to be its borders are from the surface, at the least, model units: where one runs beside a border of
    /// the surface below, that one stands for it.
    pub off: f64,
}

// Where it lies in (u, v) follows from the borders and the surface below.
crate::content!(Trim { loops, off } but { ground, trim_curves, reach });

/// A box in (u, v) that holds some trim curves: between two places a curve is nowhere farther from its chord than the chord is long.
pub(crate) fn reach(trim_curves: &[TrimCurve]) -> (DVec2, DVec2) {
    let (mut low, mut high, mut longest) = (DVec2::INFINITY, DVec2::NEG_INFINITY, 0.0_f64);
    for trim_curve in trim_curves {
        let places = trim_curve.places();
        if matches!(trim_curve, TrimCurve::Pcurve(_)) {
            longest = places.windows(2).map(|w| w[0].distance(w[1])).fold(longest, f64::max);
        }
        for p in places {
            (low, high) = (low.min(p), high.max(p));
        }
    }
    (low - DVec2::splat(longest), high + DVec2::splat(longest))
}

impl Trim {
    pub fn flipped(&self) -> Self {
        let mut trim_curves = Vec::with_capacity(self.trim_curves.len());
        let mut first = 0;
        let turn = |(u, v): (f64, f64)| if self.ground == Domain::Triangle { (v, u) } else { (u, 1.0 - v) };
        for n in &self.loops {
            trim_curves.extend(self.trim_curves[first..first + n].iter().rev().map(|c| c.flipped(&turn)));
            first += n;
        }
        self.with_courses(trim_curves)
    }

    /// The same by other trim curves.
    pub fn with_courses(&self, trim_curves: Vec<TrimCurve>) -> Self {
        Self { reach: reach(&trim_curves), trim_curves, ..self.clone() }
    }
}

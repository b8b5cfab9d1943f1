//! The four laws by which sections travel: where a station lies, and what each law asks of sections.

use glam::{DMat3, DVec3};

use crate::base::fault::Result;
use crate::base::math;
use crate::base::tolerance::{PARALLEL, Tolerance};
use crate::network::Chain;
use crate::surface::data::breaks::chain_breaks;
use crate::surface::faults::{SectionFault, SweepFault};
use crate::surface::swept::legs::Legs;
use crate::surface::swept::revolve::Axis;

/// Samples between two breaks of a curve.
const SAMPLES: usize = 32;

/// How sections travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// They stay parallel.
    Parallel,
    /// They turn about an axis.
    Rotational(Axis),
    /// They stay normal to the main guide.
    Normal,
    /// They divide all guides in the same ratio.
    Synchronized,
}

impl Law {
    /// Its word in the language.
    pub fn name(self) -> &'static str {
        match self {
            Self::Parallel => "parallel",
            Self::Rotational(_) => "rotational",
            Self::Normal => "normal",
            Self::Synchronized => "synchronized",
        }
    }
}

/// A place of the main guide with the plane that a section has there.
#[derive(Clone, Copy, Debug)]
pub struct Station {
    /// Fraction of the main guide.
    pub w: f64,
    /// Its point there.
    pub at: DVec3,
    /// A point of the plane and its unit normal; none under the synchronized law.
    plane: Option<(DVec3, DVec3)>,
    /// Of a half-plane: the unit direction from the axis into it.
    side: Option<DVec3>,
    /// How a section that stands at the start of the main guide is turned here.
    pub turn: DMat3,
}

impl Station {
    /// How far a point lies off the plane, with a sign; 0 where there is none.
    pub fn off(&self, p: DVec3) -> f64 {
        self.plane.map_or(0.0, |(o, n)| (p - o).dot(n))
    }

    /// How fast that grows along a derivative.
    pub fn slope(&self, d: DVec3) -> f64 {
        self.plane.map_or(0.0, |(_, n)| d.dot(n))
    }

    /// Whether a point of the plane is on the right side of the axis.
    pub fn faces(&self, p: DVec3) -> bool {
        match (self.side, self.plane) {
            (Some(side), Some((o, _))) => (p - o).dot(side) >= 0.0,
            _ => true,
        }
    }
}

/// The main guide under its law.
pub struct Main<'a> {
    /// The guide.
    pub chain: &'a Chain,
    law: Law,
    /// Normal of the sections under the parallel law.
    normal: DVec3,
    legs: Option<Legs<'a>>,
}

impl<'a> Main<'a> {
    /// E637 where it touches the axis, E635 where it turns back under its law, E636 where it has a cusp.
    pub fn new(chain: &'a Chain, law: Law, normal: DVec3, tolerance: &Tolerance) -> Result<Self> {
        let legs = if law == Law::Normal { Some(Legs::new(chain, 0.0, tolerance)?) } else { None };
        let main = Self { chain, law, normal, legs };
        main.check(tolerance)?;
        Ok(main)
    }

    fn check(&self, tolerance: &Tolerance) -> Result<()> {
        let mut sign = 0.0f64;
        for f in samples(self.chain) {
            let jet = self.chain.jet(f);
            let speed = match self.law {
                Law::Parallel => jet.d1.dot(self.normal),
                Law::Rotational(axis) => {
                    let arm = (jet.p - axis.about).reject_from_normalized(axis.direction);
                    if arm.length() <= tolerance.point {
                        let fault = SweepFault::MainGuideOnAxis { guide: self.chain.origin(), at: jet.p, off: arm.length() };
                        return Err(fault.into());
                    }
                    axis.direction.cross(arm.normalize_or_zero()).dot(jet.d1)
                }
                Law::Normal | Law::Synchronized => return Ok(()),
            };
            let least = PARALLEL * self.chain.length();
            if speed.abs() > least && sign * speed < 0.0 || speed.abs() <= least && self.law == Law::Parallel && sign == 0.0 && f > 0.5 {
                return Err(SweepFault::GuideDoublesBack { guide: self.chain.origin(), law: self.law.name(), at: jet.p }.into());
            }
            if speed.abs() > least {
                sign = speed;
            }
        }
        Ok(())
    }

    /// The station at a fraction.
    pub fn station(&mut self, w: f64) -> Station {
        let at = self.chain.point(w);
        let mut station = Station { w, at, plane: None, side: None, turn: DMat3::IDENTITY };
        match self.law {
            Law::Parallel => station.plane = Some((at, self.along(w, self.normal))),
            Law::Rotational(axis) => {
                let side = radial(&axis, at);
                let normal = axis.direction.cross(side);
                station.plane = Some((axis.about, self.along(w, normal)));
                station.side = Some(side);
                let start = radial(&axis, self.chain.start());
                let (cos, sin) = (start.dot(side), axis.direction.cross(start).dot(side));
                let column = |v: DVec3| v * cos + axis.direction.cross(v) * sin + axis.direction * (axis.direction.dot(v) * (1.0 - cos));
                station.turn = DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
            }
            Law::Normal => {
                if let Some(legs) = &mut self.legs {
                    let (tangent, turn) = legs.frame_at(w);
                    (station.plane, station.turn) = (Some((at, tangent)), turn);
                }
            }
            Law::Synchronized => {}
        }
        station
    }

    /// A plane's normal, turned to look along the guide.
    fn along(&self, w: f64, normal: DVec3) -> DVec3 {
        if self.chain.jet(w).d1.dot(normal) < 0.0 { -normal } else { normal }
    }

    /// The fraction of the main guide whose station holds a point; none where there is no such place.
    pub fn fraction_of(&self, p: DVec3) -> Option<f64> {
        let value = |f: f64| -> (f64, bool) {
            let jet = self.chain.jet(f);
            match self.law {
                Law::Parallel => ((jet.p - p).dot(self.normal), true),
                Law::Rotational(axis) => {
                    let side = radial(&axis, p);
                    ((jet.p - axis.about).dot(axis.direction.cross(side)), (jet.p - axis.about).dot(side) > 0.0)
                }
                Law::Normal | Law::Synchronized => ((jet.p - p).dot(jet.d1), true),
            }
        };
        let stops = samples(self.chain);
        let crossings = stops.windows(2).filter_map(|w| {
            let (low, high) = (value(w[0]), value(w[1]));
            ((low.0 < 0.0) != (high.0 < 0.0) && low.1 && high.1).then(|| halved((w[0], w[1]), low.0 < 0.0, |f| value(f).0))
        });
        let far = |f: &f64| self.chain.point(*f).distance(p);
        crossings.min_by(|a, b| far(a).total_cmp(&far(b)))
    }
}

/// The zero of a function that changes its sign once, to rounding.
pub fn halved((mut low, mut high): (f64, f64), negative_first: bool, value: impl Fn(f64) -> f64) -> f64 {
    const HALVINGS: usize = 60;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if (value(middle) < 0.0) == negative_first { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Fractions at which a curve is looked at, breaks among them.
pub fn samples(chain: &Chain) -> Vec<f64> {
    let stops = [vec![0.0], chain_breaks(chain), vec![1.0]].concat();
    let inner = |w: &[f64]| (0..SAMPLES).map(|k| w[0] + (w[1] - w[0]) * k as f64 / SAMPLES as f64).collect::<Vec<_>>();
    stops.windows(2).flat_map(inner).chain([1.0]).collect()
}

fn radial(axis: &Axis, p: DVec3) -> DVec3 {
    (p - axis.about).reject_from_normalized(axis.direction).normalize_or_zero()
}

/// Unit normal of the plane that a curve lies in best, as its area has it; zero for a straight one.
pub fn plane_normal(chain: &Chain) -> DVec3 {
    let points: Vec<DVec3> = samples(chain).into_iter().map(|f| chain.point(f)).collect();
    let from = points[0];
    let area = points.windows(2).map(|w| (w[0] - from).cross(w[1] - from)).sum::<DVec3>();
    let size = chain.length() * chain.length();
    if area.length() <= PARALLEL * size { DVec3::ZERO } else { area.normalize_or_zero() }
}

/// Checks that a section lies in the plane of its station: E631, E632 or E633 by the law, with the largest distance.
pub fn check_section(section: &Chain, station: &Station, law: Law, others: (&Chain, &Chain), tolerance: &Tolerance) -> Result<()> {
    let (first, main) = others;
    let mut worst = (0.0f64, station.at);
    for f in samples(section) {
        let p = section.point(f);
        let off = station.off(p).abs();
        // On the wrong side of the axis a point is as far off as it is from the axis.
        let off = match (law, station.faces(p)) {
            (Law::Rotational(axis), false) => off.max((p - axis.about).reject_from_normalized(axis.direction).length()),
            _ => off,
        };
        if off > worst.0 {
            worst = (off, p);
        }
    }
    let (off, at) = worst;
    let angle = math::atan2(off, (at - station.at).length_squared().sqrt().max(off));
    // The station is where the guide says, which the section touches within the tolerance only; farther from an axis that is more.
    let farther = match law {
        Law::Rotational(axis) => {
            let radius = |p: DVec3| (p - axis.about).reject_from_normalized(axis.direction).length();
            (radius(at) / radius(station.at).max(tolerance.point)).max(1.0)
        }
        _ => 1.0,
    };
    let touched = section.closest(station.at).2.min(tolerance.point);
    if off <= tolerance.point + touched * farther || (!matches!(law, Law::Rotational(_)) && angle <= tolerance.angle) {
        return Ok(());
    }
    let section = section.origin();
    Err(match law {
        Law::Parallel => SectionFault::NotParallel { a: first.origin(), b: section, angle, off, at }.into(),
        Law::Rotational(_) => SectionFault::AxisOff { section, off, at }.into(),
        _ => SectionFault::NotNormal { section, guide: main.origin(), angle, off, at }.into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::origin::Origin;
    use crate::geometry::construct::build::{bezier, line};
    use crate::surface::swept::sections::Guide;

    fn quadratic(points: [(f64, f64, f64); 3]) -> Chain {
        let points = points.map(DVec3::from);
        Chain::of_curve(&bezier(&points, None, Origin::NONE).expect("a curve"))
    }

    fn checked(main: &Chain, law: Law, guide: &Guide, rows: &[(f64, [f64; 3])]) {
        let tolerance = Tolerance::new(1e-9, 10.0);
        let mut main = Main::new(main, law, DVec3::X, &tolerance).expect("a main guide");
        for (w, wanted) in rows {
            let found: Vec<DVec3> = guide.passes(&main.station(*w), &tolerance).iter().map(|f| guide.chain.point(*f)).collect();
            assert!(found.len() == 1 && found[0].distance((*wanted).into()) < 1e-7, "{w}: {found:?}");
        }
    }

    #[test]
    fn stations_are_those_of_the_reference() {
        let straight = Chain::of_curve(&line(DVec3::ZERO, DVec3::new(10.0, 0.0, 0.0), Origin::NONE).expect("a line"));
        let second = quadratic([(0.0, 2.0, 0.0), (5.0, 2.0, 1.5), (10.0, 10.0, 3.0)]);
        let parallel = [(0.25, [2.5, 2.5, 0.75]), (0.5, [5.0, 4.0, 1.5]), (0.75, [7.5, 6.5, 2.25])];
        checked(&straight, Law::Parallel, &Guide::new(&second), &parallel);
        let ratios = [
            (0.25, [3.15731729, 2.7974922, 0.94719519]),
            (0.5, [5.84558358, 4.73366779, 1.75367507]),
            (0.75, [8.08339039, 7.22729602, 2.42501712]),
        ];
        for (w, wanted) in ratios {
            assert!(second.point(w).distance(wanted.into()) < 1e-7, "{w}");
        }
        // Normal planes at both ends lie beyond the second guide: it goes on as its polynomial does.
        let main = quadratic([(0.0, 0.0, 0.0), (5.0, 2.0, 0.0), (10.0, 0.0, 0.0)]);
        let upper = quadratic([(0.0, 3.0, 1.0), (5.0, 4.0, 1.0), (10.0, 3.0, 1.0)]);
        let longer = Guide::longer(&upper, &Tolerance::new(1e-9, 10.0)).expect("a curve").expect("an open one");
        let normal = [
            (0.0, [-1.10211367, 2.75528418, 1.0]),
            (0.25, [1.92839871, 3.31130531, 1.0]),
            (0.5, [5.0, 3.5, 1.0]),
            (0.75, [8.07160129, 3.31130531, 1.0]),
            (1.0, [11.10211367, 2.75528418, 1.0]),
        ];
        checked(&main, Law::Normal, &longer, &normal);
    }
}

//! `extrude`: a profile translated along a straight line.

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::construct::build::line;
use crate::geometry::data::fault::CurveFault;
use crate::geometry::shapes::nurbs::{projected, weighted};
use crate::geometry::{Motion, Nurbs};
use crate::network::Chain;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::data::breaks::chain_breaks;
use crate::surface::data::flow_words::phrase;
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::faults::ProfileFault;
use crate::surface::rails::rail::Rail;
use crate::surface::rails::reparam::Map;
use crate::surface::rails::side::Border;
use crate::surface::shapes::nurbs::NurbsSurface;
use crate::surface::shapes::sweep::{Path, Sweep};

/// The surface S(u, v) = profile(v) + u·by, model units.
///
/// Fails with E409 for a `by` without length and E624 where the profile runs along it.
pub fn extrude(profile: &Chain, by: DVec3, origin: Origin, tolerance: &Tolerance) -> Result<Surface> {
    if by.length() <= tolerance.point {
        return Err(CurveFault::ZeroDirection { of: origin, argument: "by", needed: "with a length" }.into());
    }
    let (rail, kinks) = kinked(profile, tolerance);
    let closed_v = profile.is_closed(tolerance);
    let far = profile.moved(&Motion::translation(by)).with_origin(origin);
    let path = |p: DVec3| Ok::<_, crate::base::fault::Fault>(Chain::of_curve(&line(p, p + by, origin)?));
    let first = path(profile.start())?;
    let last = if closed_v { first.clone() } else { path(profile.end())? };
    let mut generated = vec![far.clone(), first.clone()];
    if !closed_v {
        generated.push(last.clone());
    }
    let surface = Surface::new(Parts {
        origin,
        kind: SurfaceKind::Extrude,
        flow: phrase(0, (false, closed_v)),
        domain: Domain::Square,
        closed: (false, closed_v),
        borders: vec![
            Border::chain(first, false),
            Border::chain(far, false),
            Border::chain(last, false),
            Border::chain(profile.clone(), false),
        ],
        kinks: (Vec::new(), kinks),
        shape: Shape::Sweep(Sweep::new(rail, Path::Straight { by })),
        chains: vec![profile.clone()],
        generated,
        trim: None,
        flipped: false,
    });
    sweeps_area(&surface, profile, tolerance)?;
    Ok(surface)
}

/// The exact net of an extruded profile: degree 1 in u, the profile's in v.
pub fn net(profile: &Nurbs, by: DVec3) -> NurbsSurface {
    let n = profile.poles.len();
    let mut poles = Vec::with_capacity(2 * n);
    for q in &profile.poles {
        poles.push(*q);
        poles.push(weighted(projected(*q) + by, q.w));
    }
    NurbsSurface { degree: (1, profile.degree), knots: (vec![0.0, 0.0, 1.0, 1.0], unit_knots(profile)), poles, counts: (2, n) }
}

/// A curve's knots over 0…1.
pub(crate) fn unit_knots(curve: &Nurbs) -> Vec<f64> {
    let (a, b) = curve.domain();
    curve.knots.iter().map(|k| if *k == b { 1.0 } else { (k - a) / (b - a) }).collect()
}

/// The profile as a rail that knows its kinks, and the kink lines.
pub(crate) fn kinked(profile: &Chain, tolerance: &Tolerance) -> (Rail, Vec<f64>) {
    let mut rail = Rail::new(profile.clone(), Map::identity());
    let lines = rail.kink_lines(tolerance);
    rail.set_kinks(lines.clone());
    (rail, lines.into_iter().map(|line| line.0).collect())
}

/// E624 where a part of the profile (longer than a point) is translated along itself: (u, v) are the way and the profile.
pub(crate) fn sweeps_area(surface: &Surface, profile: &Chain, tolerance: &Tolerance) -> Result<()> {
    const SAMPLES: usize = 16;
    const WAYS: [f64; 4] = [0.07, 0.31, 0.62, 0.93];
    let stops = [vec![0.0], chain_breaks(profile), vec![1.0]].concat();
    for w in stops.windows(2) {
        if (w[1] - w[0]) * profile.length() <= tolerance.point {
            continue;
        }
        let parallel = (0..SAMPLES).all(|k| {
            let v = w[0] + (w[1] - w[0]) * (k as f64 + 0.5) / SAMPLES as f64;
            WAYS.iter().all(|u| {
                let jet = surface.jet(*u, v);
                jet.du.cross(jet.dv).length() <= crate::base::tolerance::PARALLEL * jet.du.length() * jet.dv.length()
            })
        });
        if parallel {
            let (from, to) = (profile.point(w[0]), profile.point(w[1]));
            return Err(ProfileFault::SweepDegenerate { profile: profile.origin(), from, to }.into());
        }
    }
    Ok(())
}

//! `along`: one profile along one path.

use glam::{DMat3, DVec3};

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::Motion;
use crate::geometry::curves::curve::Shape as CurveShape;
use crate::network::Chain;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::data::breaks::chain_breaks;
use crate::surface::data::flow_words::phrase;
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::data::one_sided::OneSided;
use crate::surface::faults::SweepFault;
use crate::surface::rails::rail::Rail;
use crate::surface::rails::reparam::{Map, Reparam};
use crate::surface::rails::side::{Border, Side};
use crate::surface::shapes::framed::Framed;
use crate::surface::shapes::matrices::Matrices;
use crate::surface::swept::extrude::{extrude, kinked, sweeps_area};
use crate::surface::swept::legs::{Legs, no_frame};
use crate::surface::swept::revolve::{Axis, revolve};
use crate::surface::swept::rounded::Rounded;

/// Samples a run of the path and of the profile in the search for folds.
const SAMPLES: usize = 9;

/// Settings of [`along`].
#[derive(Clone, Copy, Debug)]
pub struct AlongSettings {
    /// Turn about the path from its start to its end, radians.
    pub twist: f64,
    /// The profile turns about corners of the path; else it is cut by their bisecting planes.
    pub round: bool,
    /// The declaration.
    pub origin: Origin,
}

/// The surface of a profile that moves along a path, staying as it stands to the path's direction.
///
/// u runs along the path, v along the profile, both by arc length. At corners of the path the surface is cut by the
/// bisecting plane, or the profile is turned about the corner, and then u goes on as far as its farthest point moves. A straight path gives the extruded surface, an arc the revolved one. Returns W639 where it folds.
/// Fails with E636 where the path has a cusp.
pub fn along(profile: &Chain, path: &Chain, settings: &AlongSettings, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    if settings.round && !path.kinks(tolerance).is_empty() {
        return rounded(profile, path, settings, tolerance);
    }
    let plain = if settings.twist == 0.0 { simple(profile, path, settings.origin, tolerance)? } else { None };
    let surface = match plain {
        Some(surface) => {
            Surface::new(Parts { kind: SurfaceKind::Along, chains: vec![profile.clone(), path.clone()], ..surface.parts().clone() })
        }
        None => framed(profile, path, settings, tolerance)?,
    };
    let notes = folds(&surface, path, &Some, tolerance);
    Ok((surface, notes))
}

/// With turns about the corners. W639 where the profile reaches over to the inner side of one.
fn rounded(profile: &Chain, path: &Chain, settings: &AlongSettings, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let mut legs = Legs::new(path, settings.twist, tolerance)?;
    let turned = Rounded::new(&mut legs, profile, tolerance).ok_or_else(|| no_frame(path, (0.0, 1.0)))?;
    let closed = legs.closes(settings.twist, tolerance);
    let (us, fractions): (Vec<f64>, Vec<f64>) = turned.stops.iter().copied().unzip();
    let mut way = Rail::new(path.clone(), Map::new(us, fractions, Reparam::Linear, false));
    way.set_kinks(turned.corners.clone());
    let corners = turned.corners.iter().map(|c| c.0).collect();
    let frame = PathFrame { turn: turned.turn.clone(), last: legs.last(), corners, cut: false, closed };
    let surface = along_way(profile, path, way, &turned.crossings, frame, settings.origin, tolerance);
    sweeps_area(&surface, profile, tolerance)?;
    let mut notes = folds(&surface, path, &|u| turned.fraction(u), tolerance);
    if let (Some((at, reach)), true) = (turned.inside, notes.is_empty()) {
        notes.push(SweepFault::SelfIntersects { surface: settings.origin, path: path.origin(), at, reach, radius: Some(0.0) }.into());
    }
    Ok((surface, notes))
}

/// The exact surface of a path that is one straight line or one arc of a circle.
fn simple(profile: &Chain, path: &Chain, origin: Origin, tolerance: &Tolerance) -> Result<Option<Surface>> {
    let curve = path.to_curve()?;
    match curve.shape() {
        CurveShape::Line(a, b) => extrude(profile, *b - *a, origin, tolerance).map(Some),
        CurveShape::Arc(arc) if arc.radius.is_some() => {
            let normal = arc.u.cross(arc.v).normalize_or_zero();
            // A profile that crosses the axis folds over, but is a surface.
            Ok(revolve(profile, &Axis { about: arc.center, direction: normal }, arc.sweep, origin, tolerance).ok())
        }
        _ => Ok(None),
    }
}

fn framed(profile: &Chain, path: &Chain, settings: &AlongSettings, tolerance: &Tolerance) -> Result<Surface> {
    let origin = settings.origin;
    let mut legs = Legs::new(path, settings.twist, tolerance)?;
    let turn = legs.mitred()?;
    let closed = legs.closes(settings.twist, tolerance);
    let frame = PathFrame { turn, last: legs.last(), corners: legs.corners(), cut: legs.cut_at_start(), closed };
    let surface = made(profile, path, frame, origin, tolerance);
    sweeps_area(&surface, profile, tolerance)?;
    Ok(surface)
}

/// A profile that is moved along a path by a smooth function of its fraction; W639 is not looked for.
pub fn moved_by(
    profile: &Chain,
    path: &Chain,
    settings: &AlongSettings,
    turn: &mut dyn FnMut(f64) -> DMat3,
    tolerance: &Tolerance,
) -> Result<(Surface, Vec<Fault>)> {
    let stops = [vec![0.0], chain_breaks(path), vec![1.0]].concat();
    let mut all = Matrices::empty();
    for w in stops.windows(2) {
        if !all.fit((w[0], w[1]), turn) {
            return Err(no_frame(path, (w[0], w[1])));
        }
    }
    let closed = path.is_closed(tolerance);
    let corners = path.kinks(tolerance).into_iter().filter(|f| *f > 0.0).collect();
    let frame = PathFrame { turn: all, last: turn(1.0), corners, cut: false, closed };
    Ok((made(profile, path, frame, settings.origin, tolerance), Vec::new()))
}

/// How a profile moves.
struct PathFrame {
    turn: Matrices,
    /// The rotation at the end.
    last: DMat3,
    corners: Vec<f64>,
    /// Whether the profile is cut where it starts.
    cut: bool,
    /// Whether it comes back to where it started.
    closed: bool,
}

fn made(profile: &Chain, path: &Chain, frame: PathFrame, origin: Origin, tolerance: &Tolerance) -> Surface {
    let mut way = Rail::new(path.clone(), Map::identity());
    way.set_kinks(frame.corners.iter().map(|f| (*f, *f)).collect());
    along_way(profile, path, way, &[], frame, origin, tolerance)
}

/// `across` are fractions of the profile at which the surface is parted beside its kinks.
fn along_way(profile: &Chain, path: &Chain, way: Rail, across: &[f64], frame: PathFrame, origin: Origin, tolerance: &Tolerance) -> Surface {
    let (rail, mut kinks) = kinked(profile, tolerance);
    let near = tolerance.point / profile.length();
    kinks.extend(across.iter().copied().filter(|f| kinks.iter().all(|k| (k - f).abs() > near)).collect::<Vec<_>>());
    kinks.sort_by(f64::total_cmp);
    let corners = frame.corners;
    let closed = (frame.closed, profile.is_closed(tolerance));
    let mut generated = Vec::new();
    let ends = match (frame.cut, closed.0) {
        (true, true) => [Border::straight(Side::Seam), Border::straight(Side::Seam)],
        (_, true) => [Border::chain(profile.clone(), false), Border::chain(profile.clone(), false)],
        (cut, false) => {
            let last = profile.moved(&Motion::rigid(frame.last, path.start(), path.end())).with_origin(origin);
            generated.push(last.clone());
            let end = |chain: Chain| if cut { Border::straight(Side::Free) } else { Border::chain(chain, false) };
            [end(profile.clone()), end(last)]
        }
    };
    let side = |p: DVec3| match (tolerance.same_point(p, path.start()) && corners.is_empty(), closed.1) {
        (true, _) => Border::chain(path.clone(), false),
        (_, true) => Border::straight(Side::Seam),
        _ => Border::straight(Side::Free),
    };
    let [first, last] = ends;
    Surface::new(Parts {
        origin,
        kind: SurfaceKind::Along,
        flow: phrase(0, closed),
        domain: Domain::Square,
        closed,
        borders: vec![side(profile.start()), last, side(profile.end()), first],
        kinks: (corners.clone(), kinks),
        shape: Shape::Framed(Framed::new(way, frame.turn, rail)),
        chains: vec![profile.clone(), path.clone()],
        generated,
        trim: None,
        flipped: false,
    })
}

/// W639 at the place where the profile moves back most against the path's direction.
///
/// `fraction` gives the path's own for u; none where it stands still.
fn folds(surface: &Surface, path: &Chain, fraction: &dyn Fn(f64) -> Option<f64>, tolerance: &Tolerance) -> Vec<Fault> {
    let inside = |breaks: Vec<f64>| -> Vec<f64> {
        let stops = [&[0.0], breaks.as_slice(), &[1.0]].concat();
        stops
            .windows(2)
            .flat_map(|w| (0..SAMPLES).map(|k| w[0] + (w[1] - w[0]) * (k as f64 + 0.5) / SAMPLES as f64).collect::<Vec<_>>())
            .collect()
    };
    let (us, vs) = surface.breaks();
    let path_breaks = chain_breaks(path);
    let (us, vs) = (inside(if us.is_empty() { path_breaks } else { us }), inside(vs));
    let side = |list: &[f64]| list.iter().map(|x| (*x, OneSided::After)).collect::<Vec<_>>();
    let jets = surface.jets(&side(&us), &side(&vs));
    let mut worst: Option<(f64, usize)> = None;
    for (k, jet) in jets.iter().enumerate() {
        let Some(f) = fraction(us[k % us.len()]) else { continue };
        let speed = jet.du.dot(path.jet(f).d1) / (path.length() * path.length());
        if speed < -tolerance.parameter && worst.is_none_or(|(least, _)| speed < least) {
            worst = Some((speed, k));
        }
    }
    let fault = worst.map(|(_, k)| {
        let u = us[k % us.len()];
        let way = path.jet(fraction(u).unwrap_or(u));
        let bend = way.d2.length() / (path.length() * path.length());
        let radius = (bend > 0.0).then(|| 1.0 / bend);
        let reach = jets[k].p.distance(way.p);
        SweepFault::SelfIntersects { surface: surface.origin(), path: path.origin(), at: jets[k].p, reach, radius }.into()
    });
    fault.into_iter().collect()
}

//! `extend`: surfaces made longer over a side.

use glam::DVec3;

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::{PARALLEL, Tolerance};
use crate::geometry::Motion;
use crate::geometry::construct::extend::{self as curves, End, Onward, check_length};
use crate::geometry::data::extend_fault::{ExtendFault, NoEnd, Stop};
use crate::network::Chain;
use crate::surface::analysis::as_net::Off;
use crate::surface::analysis::extend_net::{NoStrip, with_strip};
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::faults::DeviationFault;
use crate::surface::rails::rail::Rail;
use crate::surface::rails::side::{Side, between};
use crate::surface::shapes::frame::Frame;
use crate::surface::shapes::sweep::{Path, Sweep};
use crate::surface::swept::extrude::extrude;
use crate::surface::swept::revolve::{Axis, revolve};

/// A side of a surface with four.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rim {
    /// u = 0.
    Start,
    /// u = 1.
    End,
    /// v = 0.
    Left,
    /// v = 1.
    Right,
}

impl Rim {
    /// The word of the language.
    pub fn word(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::End => "end",
            Self::Left => "left",
            Self::Right => "right",
        }
    }

    /// Whether u runs across it.
    pub fn in_u(self) -> bool {
        matches!(self, Self::Start | Self::End)
    }

    /// Whether the parameter across it begins there.
    pub fn at_start(self) -> bool {
        matches!(self, Self::Start | Self::Left)
    }

    /// Its number among the sides v = 0, u = 1, v = 1, u = 0.
    fn index(self) -> usize {
        match self {
            Self::Left => 0,
            Self::End => 1,
            Self::Right => 2,
            Self::Start => 3,
        }
    }

    /// The side of the shape of a surface that is read with v backwards.
    fn turned(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
            other => other,
        }
    }
}

/// The surface with a strip on over a side, the rest as it is; `by` is what the longest of the lines across the side is made longer by,
/// model units.
///
/// Planes, extrusions, and revolutions that go on as they are stay such. Others become nets, exact where the surface has an exact one, else
/// within the tolerance, which the note N677 states. The normal is continuous over the side, with [`Onward::Curvature`] all derivatives are.
/// Fails with E306 for a length that is not above 0, E417 for a surface without such a side, E418 where it goes on for less than `by`.
pub fn extend(surface: &Surface, rim: Rim, by: f64, how: Onward, origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    check_length(by, origin)?;
    let of = surface.origin();
    has_side(surface, rim, by)?;
    if how == Onward::Reflect {
        return Err(ExtendFault::NoImage { of }.into());
    }
    let parts = surface.parts();
    let flip = |made: Surface| if parts.flipped { made.flipped() } else { made };
    let own = if parts.flipped { rim.turned() } else { rim };
    match &parts.shape {
        Shape::Plane(frame) => {
            let shape = Shape::Plane(longer_frame(*frame, own, by));
            return Ok((Surface::new(Parts { origin, shape, ..surface.without_curves().parts().clone() }), Vec::new()));
        }
        Shape::Sweep(sweep) => {
            if let Some(made) = longer_sweep(sweep, own, by, how, of, origin, tolerance)? {
                return Ok((flip(made), Vec::new()));
            }
        }
        _ => {}
    }
    let Some(form) = surface.to_net(tolerance)? else {
        return Err(ExtendFault::NoEnd { of, side: rim.word(), why: NoEnd::Sides, by }.into());
    };
    let net = with_strip(&form.net, rim, by, how).map_err(|why| match why {
        NoStrip::Still => ExtendFault::NoDirection { of, side: rim.word(), at: middle(surface, rim), surface: true, by },
        NoStrip::Weight => ExtendFault::TooFar { of, by, most: 0.0, stop: Stop::Polynomial },
    })?;
    let note = |off, proved| DeviationFault::AsNet { net: origin, surface: of, off, proved }.into();
    let notes = match form.off {
        Off::Exact => Vec::new(),
        Off::Bounded(off) => vec![note(off, true)],
        Off::Sampled(off) => vec![note(off, false)],
    };
    Ok((net.surface(SurfaceKind::Nurbs, origin, tolerance), notes))
}

/// E417 unless the side is one that ends the surface.
fn has_side(surface: &Surface, rim: Rim, by: f64) -> Result<()> {
    let closed = if rim.in_u() { surface.closed().0 } else { surface.closed().1 };
    let why = if surface.parts().trim.is_some() {
        NoEnd::Trimmed
    } else if surface.domain() != Domain::Square {
        NoEnd::Sides
    } else if closed {
        NoEnd::Seam
    } else if matches!(surface.side(rim.index()), Side::Pole(_)) {
        NoEnd::Pole
    } else {
        return Ok(());
    };
    Err(ExtendFault::NoEnd { of: surface.origin(), side: rim.word(), why, by }.into())
}

fn middle(surface: &Surface, rim: Rim) -> DVec3 {
    let end = if rim.at_start() { 0.0 } else { 1.0 };
    if rim.in_u() { surface.point(end, 0.5) } else { surface.point(0.5, end) }
}

fn longer_frame(frame: Frame, rim: Rim, by: f64) -> Frame {
    let longer = |e: DVec3| e * ((e.length() + by) / e.length());
    let (eu, ev) = if rim.in_u() { (longer(frame.eu), frame.ev) } else { (frame.eu, longer(frame.ev)) };
    let origin = if rim.at_start() { frame.origin - (eu - frame.eu) - (ev - frame.ev) } else { frame.origin };
    Frame { origin, eu, ev }
}

/// A sweep that stays one: longer along its path where it goes on as it is, or of a longer profile; none where its strip is no sweep.
fn longer_sweep(
    sweep: &Sweep,
    rim: Rim,
    by: f64,
    how: Onward,
    of: Origin,
    origin: Origin,
    tolerance: &Tolerance,
) -> Result<Option<Surface>> {
    let Rail::Chain { chain, map, .. } = sweep.profile() else { return Ok(None) };
    let profile = between(chain, map.value(0.0), map.value(1.0), tolerance)?;
    let moved = |motion: Motion| profile.moved(&motion).with_origin(origin);
    if !rim.in_u() {
        let end = if rim.at_start() { End::Start } else { End::End };
        let curve = profile.to_curve()?.with_origin(of);
        let profile = Chain::of_curve(&curves::extend(&curve, end, by, how, origin)?);
        return Ok(Some(match sweep.path() {
            Path::Straight { by } => extrude(&profile, by, origin, tolerance)?,
            Path::Turn { about, axis, angle } => revolve(&profile, &Axis { about, direction: axis }, angle, origin, tolerance)?,
        }));
    }
    match sweep.path() {
        Path::Straight { by: whole } => {
            let more = whole.normalize_or_zero() * by;
            let profile = if rim.at_start() { moved(Motion::translation(-more)) } else { profile };
            Ok(Some(extrude(&profile, whole + more, origin, tolerance)?))
        }
        Path::Turn { .. } if how == Onward::Linear => Ok(None),
        Path::Turn { about, axis, angle } => {
            let radius = widest(&profile, about, axis);
            let (turn, left) = (by / radius, std::f64::consts::TAU - angle.abs());
            if turn > left * (1.0 + PARALLEL) {
                return Err(ExtendFault::TooFar { of, by, most: left * radius, stop: Stop::Turn }.into());
            }
            let more = turn.min(left) * angle.signum();
            let profile = if rim.at_start() { moved(Motion::rotation(about, axis, -more)) } else { profile };
            Ok(Some(revolve(&profile, &Axis { about, direction: axis }, angle + more, origin, tolerance)?))
        }
    }
}

/// The largest distance of a profile from its axis.
fn widest(profile: &Chain, about: DVec3, axis: DVec3) -> f64 {
    const PLACES: usize = 256;
    let radius = |f: f64| (profile.point(f) - about).reject_from_normalized(axis).length();
    let at = |k: usize| k as f64 / PLACES as f64;
    let best = (0..=PLACES).max_by(|a, b| radius(at(*a)).total_cmp(&radius(at(*b)))).unwrap_or(0);
    let (low, high) = (at(best.saturating_sub(1)), at((best + 1).min(PLACES)));
    let refined = crate::base::solve::lowest(low, high, crate::base::tolerance::NUDGE, |f| -radius(f));
    radius(at(best)).max(radius(refined))
}

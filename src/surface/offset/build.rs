//! Surfaces at a distance from another one, along its normals.
//!
//! Planes, extrusions across the plane of their profile and revolutions keep their kind, with moved profiles. What is left is a
//! bicubic net within the tolerance of S + d·n, whose first derivatives are exact at its knots. Of a trimmed surface the surface below
//! is moved, and its loops run on that offset at the feet of the same places.

use std::sync::Arc;

use glam::DVec2;

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::Motion;
use crate::network::Chain;
use crate::surface::closest::foot::foot;
use crate::surface::closest::nearest::closest;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::faults::BorderFault;
use crate::surface::offset::boundary::{Boundary, boundaries, whole};
use crate::surface::offset::exact::{folds, level, rough, swept};
use crate::surface::rails::side::{Border, Side};
use crate::surface::rails::trim_curve::{Pcurve, TrimCurve};
use crate::surface::trims::trim_loop::{TrimLoop, assembled, natural};

/// The offset of a trimmed surface whose surface below has no creases, with the copies of its borders, loop by loop.
pub(crate) fn trimmed(surface: &Surface, distance: f64, origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let trim_loops = natural(surface, tolerance)?;
    let each = |boundary: &Option<Boundary>| boundary.as_ref().map(|boundary| boundary.copy(distance, origin, tolerance)).transpose();
    let copies: Vec<Vec<Option<Chain>>> =
        boundaries(surface, &trim_loops, tolerance).iter().map(|row| row.iter().map(each).collect::<Result<_>>()).collect::<Result<_>>()?;
    with_loops(surface, &trim_loops, &copies, distance, origin, tolerance)
}

/// The same with the copies of its borders at that distance given.
pub(crate) fn with_loops(
    surface: &Surface,
    trim_loops: &[TrimLoop],
    copies: &[Vec<Option<Chain>>],
    distance: f64,
    origin: Origin,
    tolerance: &Tolerance,
) -> Result<(Surface, Vec<Fault>)> {
    let below = whole(surface, tolerance);
    let (ground, notes) = offset(&below, distance, origin, tolerance)?;
    let ground = ground.untrimmed();
    let carrier = LoopOffset { below: &below, ground: &ground, distance, tolerance };
    let loops: Result<Vec<TrimLoop>> = trim_loops.iter().zip(copies).map(|(trim_loop, row)| carrier.trim_loop(trim_loop, row)).collect();
    Ok((assembled(&ground, loops?, origin)?, notes))
}

/// A surface and its offset.
struct LoopOffset<'a> {
    below: &'a Surface,
    ground: &'a Surface,
    distance: f64,
    tolerance: &'a Tolerance,
}

impl LoopOffset<'_> {
    /// The place on the offset above a place of the surface.
    fn place(&self, uv: DVec2) -> DVec2 {
        let p = self.below.point(uv.x, uv.y) + self.below.normal(uv.x, uv.y) * self.distance;
        let (near, off) = foot(self.ground.evaluator(), p, uv);
        if off <= self.tolerance.point {
            return near;
        }
        // Where parameters run otherwise: the same turn as the place below.
        let found = DVec2::from(closest(self.ground, p).uv);
        let turns = |closed: bool, there: f64, here: f64| if closed { (there - here).round() } else { 0.0 };
        let (closed_u, closed_v) = self.ground.closed();
        found + DVec2::new(turns(closed_u, uv.x, found.x), turns(closed_v, uv.y, found.y))
    }

    fn trim_loop(&self, trim_loop: &TrimLoop, copies: &[Option<Chain>]) -> Result<TrimLoop> {
        let mut made = TrimLoop { borders: Vec::new(), trim_curves: Vec::new(), chains: Vec::new() };
        for ((border, trim_curve), copy) in trim_loop.borders.iter().zip(&trim_loop.trim_curves).zip(copies) {
            let places = trim_curve.places();
            let (first, last) = (places[0], places[places.len() - 1]);
            let Some(chain) = copy else {
                let (a, b) = (self.place(first), self.place(last));
                let side = match &border.side {
                    Side::Pole(_) => Side::Pole(self.ground.point(a.x, a.y)),
                    _ => Side::Seam,
                };
                made.borders.push(Border::straight(side));
                made.trim_curves.push(TrimCurve::Line(a.into(), b.into()));
                continue;
            };
            let pcurve = Pcurve::follow(self.ground, chain, (0.0, 1.0), self.place(first), self.tolerance.point).map_err(|off| {
                let (of, surface) = (chain.origin(), self.ground.origin());
                BorderFault::LoopOutsideSurface { of, surface, off: off.distance, at: off.at, tolerance: self.tolerance.point }
            })?;
            made.chains.push(chain.clone());
            made.trim_curves.push(TrimCurve::Pcurve(Arc::new(pcurve.into_poles(self.ground, chain))));
            made.borders.push(Border::chain(chain.clone(), false));
        }
        Ok(made)
    }
}

/// Share of the tolerance for a net below another one.
const BELOW: f64 = 0.25;

/// The surface at `distance` (model units, positive on the side of the normal), and W664 where it folds over.
///
/// Fails with E306 where a profile turns tighter than the distance, and with E670 for creased surfaces that are no sweeps and for
/// those with a tip.
pub fn offset(surface: &Surface, distance: f64, origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    if distance == 0.0 {
        return Ok((surface.with_origin(origin), Vec::new()));
    }
    if let Some(normal) = level(surface, tolerance) {
        return Ok((surface.moved(&Motion::translation(normal * distance)).with_origin(origin), Vec::new()));
    }
    if surface.parts().trim.is_some() {
        rough(&whole(surface, tolerance), surface.origin(), origin, tolerance)?;
        return trimmed(surface, distance, origin, tolerance);
    }
    if let Some(exact) = swept(surface, distance, origin, tolerance)? {
        return Ok((exact, Vec::new()));
    }
    rough(surface, surface.origin(), origin, tolerance)?;
    let square = match surface.domain() {
        Domain::Triangle => {
            let fine = Tolerance { point: BELOW * tolerance.point, ..*tolerance };
            surface.to_net(&fine)?.map(|form| form.net.surface(SurfaceKind::Nurbs, surface.origin(), tolerance))
        }
        _ => None,
    };
    let base = square.as_ref().unwrap_or(surface);
    let net = base.offset_net(distance, tolerance)?;
    Ok((net.surface(SurfaceKind::Offset, origin, tolerance), folds(base, distance, origin)))
}

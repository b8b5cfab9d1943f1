//! Trimmed surfaces: a part of a surface inside an outer loop and outside others [Yoo & Yoon 2000].

use std::sync::Arc;

use glam::DVec2;

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::network::Chain;
use crate::surface::closest::nearest::closest;
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::core::trim::{Trim, reach};
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::faults::{BorderFault, LoopRole};
use crate::surface::rails::boundary;
use crate::surface::rails::side::{Border, Side};
use crate::surface::rails::trim_curve::{Pcurve, TrimCurve};

/// Both sides of a seam are whole turns apart in (u, v) but for so many nudges.
const TWIN_NUDGES: f64 = 4.0;

/// A closed loop of borders on a surface.
pub(crate) struct TrimLoop {
    pub borders: Vec<Border>,
    pub trim_curves: Vec<TrimCurve>,
    pub chains: Vec<Chain>,
}

impl TrimLoop {
    /// Its corners in (u, v), all on its curves.
    pub fn polygon(&self) -> Vec<DVec2> {
        self.trim_curves
            .iter()
            .flat_map(|c| {
                let mut places = c.places();
                places.pop();
                places
            })
            .collect()
    }

    /// For each border that is one side of a seam across which the face goes on, the border along the other side of it, whole turns
    /// away in (u, v). A border that runs along a seam of the surface with the face on one side only has none, and poles have none.
    pub fn twins(&self, base: &Surface) -> Vec<Option<usize>> {
        let closed = base.closed();
        let n = self.borders.len();
        let on_seam = |k: &usize| !matches!(self.borders[*k].side, Side::Pole(_)) && self.trim_curves[*k].is_seam(closed);
        let seams: Vec<usize> = (0..n).filter(on_seam).collect();
        if seams.len() < 2 {
            return vec![None; n];
        }
        let twin = |k: usize| {
            let middle = self.trim_curves[k].share(0.5);
            let others: Vec<DVec2> = self.copies(base, middle).into_iter().filter(|p| p.distance(middle) > 0.5).collect();
            let passes = |j: usize| others.iter().any(|p| self.trim_curves[j].passes(*p, TWIN_NUDGES * NUDGE));
            seams.iter().copied().find(|j| *j != k && passes(*j))
        };
        (0..n).map(|k| seams.contains(&k).then(|| twin(k)).flatten()).collect()
    }

    /// Twice its signed area in (u, v).
    pub fn area2(&self) -> f64 {
        area2(&self.polygon())
    }

    fn turned(self) -> Self {
        let borders = self.borders.iter().rev().map(Border::turned).collect();
        let trim_curves = self.trim_curves.iter().rev().map(TrimCurve::turned).collect();
        Self { borders, trim_curves, ..self }
    }

    /// Moved in (u, v).
    pub fn shifted(self, by: DVec2) -> Self {
        let trim_curves = self.trim_curves.iter().map(|c| c.shifted(by)).collect();
        Self { trim_curves, ..self }
    }

    /// The same once more.
    pub fn copied(&self) -> Self {
        Self { borders: self.borders.clone(), trim_curves: self.trim_curves.clone(), chains: self.chains.clone() }
    }
}

/// Twice the signed area of a polygon.
fn area2(polygon: &[DVec2]) -> f64 {
    (0..polygon.len()).map(|k| polygon[k].perp_dot(polygon[(k + 1) % polygon.len()])).sum()
}

/// A surface with these loops, the outer one first.
pub(crate) fn assembled(base: &Surface, trim_loops: Vec<TrimLoop>, origin: Origin) -> Result<Surface> {
    let mut parts = Parts { origin, kind: SurfaceKind::Trim, domain: Domain::Loop, ..base.parts().clone() };
    (parts.borders, parts.chains) = (Vec::new(), Vec::new());
    let mut trim = Trim { ground: base.ground(), loops: Vec::new(), trim_curves: Vec::new(), reach: (DVec2::ZERO, DVec2::ONE), off: 0.0 };
    for (k, trim_loop) in trim_loops.into_iter().enumerate() {
        // Outer loops run counter-clockwise in (u, v), the others clockwise.
        let ascending = area2(&trim_loop.polygon()) > 0.0;
        let trim_loop = if ascending == (k == 0) { trim_loop } else { trim_loop.turned() };
        trim.loops.push(trim_loop.borders.len());
        trim.trim_curves.extend(trim_loop.trim_curves);
        parts.borders.extend(trim_loop.borders);
        parts.chains.extend(trim_loop.chains);
    }
    trim.reach = reach(&trim.trim_curves);
    parts.trim = Some(Arc::new(trim));
    Ok(Surface::new(parts))
}

/// Whole turns by which a loop may be moved in (u, v).
pub(crate) fn shifts(base: &Surface) -> Vec<DVec2> {
    let of = |closed: bool| if closed { vec![0.0, 1.0, -1.0] } else { vec![0.0] };
    let (u, v) = base.closed();
    of(u).into_iter().flat_map(|x| of(v).into_iter().map(move |y| DVec2::new(x, y))).collect()
}

/// The loops that a surface has by itself.
pub(crate) fn natural(base: &Surface, tolerance: &Tolerance) -> Result<Vec<TrimLoop>> {
    let parts = base.parts();
    if let Some(trim) = &parts.trim {
        let mut first = 0;
        let trim_loop = |n: &usize| {
            let range = first..first + n;
            first += n;
            let borders = parts.borders[range.clone()].to_vec();
            let chains = borders.iter().filter_map(|b| if let Side::Chain { chain, .. } = &b.side { Some(chain.clone()) } else { None });
            TrimLoop { chains: chains.collect(), trim_curves: trim.trim_curves[range].to_vec(), borders }
        };
        return Ok(trim.loops.iter().map(trim_loop).collect());
    }
    if parts.domain == Domain::Loop {
        let steps: Vec<boundary::Step> = parts
            .borders
            .iter()
            .filter_map(|b| if let Side::Chain { chain, from, to } = &b.side { Some((chain.clone(), from > to)) } else { None })
            .collect();
        return Ok(vec![followed(base, &steps, tolerance)?]);
    }
    let corners: &[(f64, f64)] = match parts.domain {
        Domain::Square => &[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)],
        Domain::Triangle => &[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)],
        Domain::Loop | Domain::Unbounded => return Ok(Vec::new()),
    };
    let n = corners.len();
    // Sides run with ascending u or v; the far ones against the loop.
    let borders = (0..n).map(|k| if k >= 2 { parts.borders[k].turned() } else { parts.borders[k].clone() }).collect();
    let trim_curves = (0..n).map(|k| TrimCurve::Line(corners[k], corners[(k + 1) % n])).collect();
    Ok(vec![TrimLoop { borders, trim_curves, chains: parts.chains.clone() }])
}

/// A loop of curves on the surface.
pub(crate) fn around(base: &Surface, chains: &[Chain], role: LoopRole, tolerance: &Tolerance) -> Result<TrimLoop> {
    let steps = boundary::walked(chains, role, tolerance)?;
    boundary::simple(&steps, tolerance)?;
    followed(base, &steps, tolerance)
}

/// The same in (u, v).
fn followed(base: &Surface, steps: &[boundary::Step], tolerance: &Tolerance) -> Result<TrimLoop> {
    let first = closest(base, boundary::start(&steps[0]));
    let mut place = DVec2::new(first.uv.0, first.uv.1);
    let mut trim_loop = TrimLoop { borders: Vec::new(), trim_curves: Vec::new(), chains: Vec::new() };
    for (chain, against) in steps {
        let (from, to) = if *against { (1.0, 0.0) } else { (0.0, 1.0) };
        let pcurve = Pcurve::follow(base, chain, (from, to), place, tolerance.point).map_err(|off| {
            let (of, at) = (chain.origin(), off.at);
            Fault::from(BorderFault::LoopOutsideSurface { of, surface: base.origin(), off: off.distance, at, tolerance: tolerance.point })
        })?;
        place = pcurve.ends().1;
        trim_loop.chains.push(chain.clone());
        trim_loop.trim_curves.push(TrimCurve::Pcurve(Arc::new(pcurve)));
        trim_loop.borders.push(Border::chain(chain.clone(), *against));
    }
    Ok(trim_loop)
}

//! Surfaces made in Rust or by a script.

use std::sync::Arc;

use super::curve::{Curve, direction, place, rotation};
use super::error::{Error, row};
use super::names::{Names, Speaker, fresh};
use crate::base::fault::{Fault, ValueFault};
use crate::base::limits::CALL_WORK;
use crate::base::tolerance::Tolerance;
use crate::base::work::{Budget, Exceeded};
use crate::geometry::Motion;
use crate::lang::values::units::radians;
use crate::model::measure;
use crate::network::{self, Chain, ChainFlow};
use crate::session::report::DiagnosticRow;
use crate::surface::blended::coons::{self, BlendMethod, CoonsSettings, Grid};
use crate::surface::blended::skin::{self, Across};
use crate::surface::blended::skin_align::SkinSection;
use crate::surface::blended::skin_ends::Leaving;
use crate::surface::faults::LoopFault;
use crate::surface::{self, Domain, Reparam};

/// A surface over parameters u and v. Cheap to clone.
///
/// u and v run from 0 to 1, on surfaces of three sides with u + v ≤ 1. Curves come in any order and direction: how they span a surface is
/// found from where they meet, within a [`Tolerance`].
///
/// ```
/// use lofting::{Curve, Surface, Tolerance};
///
/// let tolerance = Tolerance::new(1e-6, 5.0);
/// let south = Curve::line((0.0, 0.0, 0.0), (4.0, 0.0, 0.0))?;
/// let wall = Surface::extrude(&south, (0.0, 0.0, 3.0), &tolerance)?;
/// assert!((wall.area() - 12.0).abs() < 1e-9);
/// # Ok::<(), lofting::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Surface {
    pub(super) surface: surface::Surface,
    name: Option<Arc<str>>,
    /// The curves that it was made from.
    pub(super) curves: Vec<Curve>,
    notes: Vec<DiagnosticRow>,
}

type Made = Result<(surface::Surface, Vec<Fault>), Fault>;

/// A surface of curves; what is said of it is kept. Its work is counted, as in scripts.
fn made(curves: Vec<Curve>, tolerance: &Tolerance, make: impl FnOnce(&[Chain]) -> Made) -> Result<Surface, Error> {
    let mut names = Names::default();
    curves.iter().for_each(|curve| names.add(curve.origin(), curve.name()));
    let say = Speaker { names: &names, unit: None, tolerance: Some(*tolerance) };
    let chains: Vec<Chain> = curves.iter().map(|curve| curve.chain.clone()).collect();
    let work = || make(&chains).map(|(surface, notes)| ([notes, surface.validate(tolerance)].concat(), surface));
    let too_much = |Exceeded| Err(ValueFault::StageWork { what: "the surface" }.into());
    let (notes, surface) = Budget::new(CALL_WORK).within(work).unwrap_or_else(too_much).map_err(|fault| Error::of_fault(&fault, &say))?;
    let notes = notes.iter().map(|note| row(note, &say)).collect();
    Ok(Surface { surface, name: None, curves, notes })
}

fn over_grid(chains: &[Chain], method: BlendMethod, tolerance: &Tolerance) -> Made {
    if let Some(places) = network::given_twice(chains, tolerance) {
        return Err(LoopFault::Twice { of: chains[places.1].origin(), argument: "curves", places, hole: None }.into());
    }
    let (flow, nodes) = network::of_chains(chains, &ChainFlow::default(), tolerance)?;
    let poles = (flow.poles.0.map(|n| nodes[n]), flow.poles.1.map(|n| nodes[n]));
    let settings = CoonsSettings { method, reparam: Reparam::Smooth, origin: fresh() };
    coons::build(&Grid { chains, flow: &flow, poles }, &settings, tolerance)
}

/// Constructors. They fail with codes of families 4 to 6, above all E501 where curves miss each other.
impl Surface {
    /// A Coons surface through a closed loop or a grid of curves; it contains every one of them, and the first runs along u.
    pub fn coons<'a>(curves: impl IntoIterator<Item = &'a Curve>, tolerance: &Tolerance) -> Result<Self, Error> {
        let curves = curves.into_iter().cloned().collect();
        made(curves, tolerance, |chains| over_grid(chains, BlendMethod::Coons, tolerance))
    }

    /// A transfinite surface through a grid of curves: one polynomial blend over the whole grid.
    pub fn transfinite<'a>(curves: impl IntoIterator<Item = &'a Curve>, tolerance: &Tolerance) -> Result<Self, Error> {
        let curves = curves.into_iter().cloned().collect();
        made(curves, tolerance, |chains| over_grid(chains, BlendMethod::Lagrange, tolerance))
    }

    /// Straight lines between two curves.
    pub fn ruled(a: &Curve, b: &Curve, tolerance: &Tolerance) -> Result<Self, Error> {
        made(vec![a.clone(), b.clone()], tolerance, |chains| surface::ruled(&chains[0], &chains[1], fresh(), tolerance))
    }

    /// A flat face inside curves that close.
    pub fn plane<'a>(curves: impl IntoIterator<Item = &'a Curve>, tolerance: &Tolerance) -> Result<Self, Error> {
        let curves = curves.into_iter().cloned().collect();
        made(curves, tolerance, |chains| surface::blended::plane_face::bounded(chains, fresh(), tolerance))
    }

    /// What a curve leaves when it is moved along a vector.
    pub fn extrude(profile: &Curve, by: impl Into<[f64; 3]>, tolerance: &Tolerance) -> Result<Self, Error> {
        let by = place("by", by)?;
        made(vec![profile.clone()], tolerance, |chains| Ok((surface::extrude(&chains[0], by, fresh(), tolerance)?, Vec::new())))
    }

    /// What a curve leaves when it is turned about an axis through a point, degrees, 360 at most either way.
    pub fn revolve(
        profile: &Curve,
        about: impl Into<[f64; 3]>,
        axis: impl Into<[f64; 3]>,
        degrees: f64,
        tolerance: &Tolerance,
    ) -> Result<Self, Error> {
        let axis = surface::swept::revolve::Axis { about: place("about", about)?, direction: direction("axis", axis)? };
        let angle = radians(degrees);
        made(vec![profile.clone()], tolerance, |chains| Ok((surface::revolve(&chains[0], &axis, angle, fresh(), tolerance)?, Vec::new())))
    }

    /// A smooth skin over two or more sections in order, all open or all closed; every section lies in it exactly.
    pub fn skin<'a>(sections: impl IntoIterator<Item = &'a Curve>, tolerance: &Tolerance) -> Result<Self, Error> {
        let curves = sections.into_iter().cloned().collect();
        made(curves, tolerance, |chains| {
            let sections: Vec<SkinSection> = chains.iter().cloned().map(SkinSection::Curve).collect();
            skin::said_well(&sections, false, tolerance)?;
            let ends = (Leaving::Plain, Leaving::Plain);
            let settings = skin::SkinSettings { across: Across::Cubic, closed: false, ends, smooth: None, origin: fresh() };
            skin::skin(&sections, &settings, tolerance)
        })
    }

    /// The part of a surface outside of closed curves on it, each a hole.
    pub fn with_holes<'a>(&self, holes: impl IntoIterator<Item = &'a Curve>, tolerance: &Tolerance) -> Result<Self, Error> {
        let holes: Vec<Curve> = holes.into_iter().cloned().collect();
        let mut trimmed = made(holes, tolerance, |chains| {
            let holes: Vec<Vec<Chain>> = chains.iter().map(|chain| vec![chain.clone()]).collect();
            let trimmed = surface::trim(&self.surface, &[], &holes, fresh(), tolerance)?;
            Ok((trimmed.cut_from(std::slice::from_ref(&self.surface)), Vec::new()))
        })?;
        trimmed.curves.splice(0..0, self.curves.iter().cloned());
        Ok(trimmed)
    }
}

/// Other surfaces of one.
impl Surface {
    /// The same surface with a name: messages, sets of meshes and plans call it by that.
    pub fn named(&self, name: &str) -> Self {
        Self { surface: self.surface.with_origin(fresh()), name: Some(name.into()), ..self.clone() }
    }

    /// Moved by a vector, with the curves it stands on.
    pub fn moved(&self, by: impl Into<[f64; 3]>) -> Result<Self, Error> {
        Ok(self.carried(&Motion::translation(place("by", by)?)))
    }

    /// Turned about an axis through a point, degrees, counter-clockwise seen against the axis, with the curves it stands on.
    pub fn rotated(&self, about: impl Into<[f64; 3]>, axis: impl Into<[f64; 3]>, degrees: f64) -> Result<Self, Error> {
        Ok(self.carried(&rotation(about, axis, degrees)?))
    }

    /// Names and the curves that it was made from stay with the original.
    fn carried(&self, motion: &Motion) -> Self {
        Self { surface: self.surface.moved(motion).with_origin(fresh()), name: None, curves: Vec::new(), notes: self.notes.clone() }
    }

    /// The same surface under another name.
    pub(super) fn called(&self, name: &str) -> Self {
        Self { name: Some(name.into()), ..self.clone() }
    }

    pub(super) fn of_surface(surface: &surface::Surface, name: &str) -> Self {
        Self { surface: surface.with_origin(fresh()), name: Some(name.into()), curves: Vec::new(), notes: Vec::new() }
    }
}

/// What it is.
impl Surface {
    /// Its name; empty without one.
    pub fn name(&self) -> &str {
        self.name.as_deref().unwrap_or_default()
    }

    /// The word of the language that makes such a surface: `coons`, `plane`, `nurbs_surface`.
    pub fn kind(&self) -> &'static str {
        self.surface.kind().name()
    }

    /// The point at u and v; outside of their range that of the nearest place inside.
    pub fn point(&self, u: f64, v: f64) -> [f64; 3] {
        let (u, v) = self.inside(u, v);
        self.surface.point(u, v).to_array()
    }

    /// The unit normal at u and v, as [`Surface::point`] takes them.
    pub fn normal(&self, u: f64, v: f64) -> [f64; 3] {
        let (u, v) = self.inside(u, v);
        self.surface.normal(u, v).to_array()
    }

    fn inside(&self, u: f64, v: f64) -> (f64, f64) {
        let share = |x: f64, most: f64| if x.is_nan() { 0.0 } else { x.clamp(0.0, most) };
        let u = share(u, 1.0);
        (u, share(v, if self.surface.domain() == Domain::Triangle { 1.0 - u } else { 1.0 }))
    }

    /// Its area, square model units, with a relative error of 1e-10; infinite for an unbounded plane.
    pub fn area(&self) -> f64 {
        if self.surface.domain() == Domain::Unbounded { f64::INFINITY } else { measure::area(&self.surface) }
    }

    /// Smallest and largest coordinates.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        let all = measure::bounds(std::slice::from_ref(&self.surface));
        [all.min.to_array(), all.max.to_array()]
    }

    /// Warnings and notes of its making: where it folds over, where it has kinks. Those of a script stand with the model.
    pub fn diagnostics(&self) -> &[DiagnosticRow] {
        &self.notes
    }
}

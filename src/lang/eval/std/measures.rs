//! Areas, volumes, centroids and boxes.

use std::sync::Arc;

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::fault::ValueFault;
use crate::base::origin::Origin;
use crate::base::tolerance::MEASURE_TOLD;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::kinds::PatchOf;
use crate::lang::values::conversions::{Area, Point, Volume};
use crate::lang::values::value::{MeshValue, ShellValue, Value};
use crate::model::measure;
use crate::network::Chain;
use crate::surface::{Surface, curve_bbox};
use crate::{builtins, fields};

/// `{min, max, size, diagonal}` of a box.
pub(crate) fn record_of(cx: &mut Cx, bounds: Box3) -> Value {
    let (min, max) = if bounds.is_empty() { (DVec3::ZERO, DVec3::ZERO) } else { (bounds.min, bounds.max) };
    cx.record([
        ("min", Value::point(min)),
        ("max", Value::point(max)),
        ("size", Value::point(max - min)),
        ("diagonal", Value::length((max - min).length())),
    ])
}

/// The box of surfaces as a record; W227 where it may be too large.
pub(crate) fn box_of(cx: &mut Cx, surfaces: &[Surface]) -> Value {
    let (bounds, loose) = measure::bounds_told(surfaces);
    if let Some((k, by)) = loose {
        let whole = (bounds.max - bounds.min).length();
        cx.say(&ValueFault::LooseBox { of: surfaces[k].origin(), by, share: by / whole }.into());
    }
    record_of(cx, bounds)
}

/// A measure of surfaces or what they enclose, estimated to be off by no more than a share of it; W228 where few digits hold.
pub(crate) fn told(cx: &mut Cx, what: &'static str, of: Origin, (value, share): (f64, f64)) -> f64 {
    if share > MEASURE_TOLD {
        cx.say(&ValueFault::RoughMeasure { of, what, share }.into());
    }
    value
}

/// The area of surfaces as [`told`] has it.
pub(crate) fn area_of(cx: &mut Cx, surfaces: &[Surface]) -> Area {
    let all = measure::areas_within(surfaces);
    let (sum, error) = all.iter().fold((0.0, 0.0), |sum, own| (sum.0 + own.0, sum.1 + own.1));
    // The one that is off by most is named.
    let worst = (0..all.len()).max_by(|a, b| all[*a].1.total_cmp(&all[*b].1).then(b.cmp(a)));
    let of = worst.map_or(Origin::NONE, |k| surfaces[k].origin());
    Area(told(cx, "the area", of, (sum, if sum > 0.0 { error / sum } else { 0.0 })))
}

builtins! {
    /// The box along the axes between two corners: `{min, max, size, diagonal}`.
    ///
    /// ```loft
    /// units m
    /// let a = box((1, 0, 0), (0, 2, 3)).size.y // => 2m
    /// ```
    fn box(
        /// A corner.
        a: Point,
        /// The opposite one.
        b: Point,
    ) -> Value = |cx, a, b| Ok(record_of(cx, Box3::of([a.0, b.0])));
}

fields! {
    /// Area of a surface.
    fn area(of: Surface) -> Area = |cx, of| Ok(area_of(cx, &[of]));
    /// Area of a patch.
    fn area(of: PatchOf) -> Area = |cx, of| {
        let model = cx.model(&of.0)?;
        let patch = &model.patches[of.1.index()];
        Ok(Area(measure::area_between(&model.surfaces[patch.surface.index()].surface, (patch.u, patch.v))))
    };
    /// Area of all surfaces of a shell.
    fn area(of: Arc<ShellValue>) -> Area = |cx, of| Ok(area_of(cx, &of.surfaces));
    /// Area of all faces of a mesh.
    fn area(of: Arc<MeshValue>) -> Area = |cx, of| Ok(Area(cx.mesh(&of)?.quality().map_or(0.0, |q| q.area)));
    /// Volume that a closed shell encloses.
    fn volume(of: Arc<ShellValue>) -> Volume = |cx, of| {
        let solid = cx.solid(&of)?;
        Ok(Volume(told(cx, "the volume", of.origin, (solid.volume.abs(), solid.error))))
    };
    /// Centre of the length of a curve.
    fn centroid(of: Chain) -> Point = |_, of| Ok(Point(measure::curve_centroid(&of)));
    /// Centre of the area of a mesh; of lines alone of their length.
    fn centroid(of: Arc<MeshValue>) -> Point = |cx, of| {
        let empty = || ValueFault::OutsideRange { argument: "of", found: "an empty mesh".to_owned(), range: "a mesh with nodes".to_owned() };
        Ok(Point(cx.mesh(&of)?.centroid().ok_or_else(empty)?))
    };
    /// Centre of the area of a surface.
    fn centroid(of: Surface) -> Point = |_, of| Ok(Point(measure::sheet(std::slice::from_ref(&of)).centroid));
    /// Centre of the volume of a closed shell, of the area of an open one.
    fn centroid(of: Arc<ShellValue>) -> Point = |cx, of| match cx.solid(&of) {
        Ok(solid) => Ok(Point(solid.centroid)),
        Err(Halt::Fault(_)) => Ok(Point(measure::sheet(&of.surfaces).centroid)),
        Err(other) => Err(other),
    };
    /// The smallest box along the axes, to 1e-6 of its diagonal. Its members are `min`, `max`, `size` and `diagonal`.
    fn bbox(of: Chain) -> Value = |cx, of| Ok(record_of(cx, curve_bbox(&of)));
    /// The smallest box along the axes, to 1e-6 of its diagonal. Its members are `min`, `max`, `size` and `diagonal`.
    ///
    /// Where thousands of places are equally extreme it may be larger: W227 says by how much at most. It contains every point.
    fn bbox(of: Surface) -> Value = |cx, of| Ok(box_of(cx, &[of]));
    /// The smallest box along the axes, to 1e-6 of its diagonal. Its members are `min`, `max`, `size` and `diagonal`.
    ///
    /// Where thousands of places are equally extreme it may be larger: W227 says by how much at most. It contains every point.
    fn bbox(of: Arc<ShellValue>) -> Value = |cx, of| Ok(box_of(cx, &of.surfaces));
    /// The smallest box along the axes that holds all nodes. Its members are `min`, `max`, `size` and `diagonal`.
    fn bbox(of: Arc<MeshValue>) -> Value = |cx, of| {
        let mesh = cx.mesh(&of)?;
        Ok(record_of(cx, Box3::of(mesh.nodes.iter().copied())))
    };
}

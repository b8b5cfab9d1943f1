//! Moving, turning, scaling and mirroring of anything with geometry.

use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::ValueFault;
use crate::builtins;
use crate::geometry::Motion;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::curves::unit;
use crate::lang::values::conversions::{Angle, Axis, Direction, FromValue, Point};
use crate::lang::values::types::Ty;
use crate::lang::values::value::{Dim, MeshValue, Plane, ShellValue, Value};
use crate::network::Chain;
use crate::surface::axis_of;

/// What may be moved, in words.
const MOVABLE: &str = "a point, curve, surface, shell or mesh, or a list of them";

/// Anything with geometry, or a list of it.
pub struct Movable(Value);

impl FromValue for Movable {
    const TY: Ty = Ty::OneOf(&[Ty::Point, Ty::Curve, Ty::Surface, Ty::Shell, Ty::Mesh, Ty::Plane, Ty::Part, Ty::List(&Ty::Any)]);
    fn from_value(value: Value) -> Option<Self> {
        Some(Self(value))
    }
}

/// The thing carried; what it was made from stays where it is.
fn carried(cx: &mut Cx, value: &Value, motion: &Motion) -> Result<Value, Halt> {
    let origin = cx.origin();
    Ok(match value {
        Value::Node(p) | Value::Vector(p, Dim::LENGTH | Dim::NONE) => Value::point(motion.point(*p)),
        // A curve of its own: the runs of the old one stay links of the old curves.
        Value::Curve(chain) => Value::Curve(Chain::of_curve(&chain.to_curve()?.moved(motion).with_origin(origin))),
        Value::Shell(shell) => {
            let surfaces = shell.surfaces.iter().map(|s| s.moved(motion).with_origin(cx.origin())).collect();
            Value::Shell(Arc::new(ShellValue { origin, surfaces, ..(**shell).clone() }))
        }
        Value::Mesh(mesh) => Value::Mesh(Arc::new(MeshValue::Data(Arc::new(cx.mesh(mesh)?.moved(motion)), origin))),
        Value::Plane(plane) => {
            let normal = motion.vector(plane.normal) / motion.scale();
            Value::Plane(Arc::new(Plane { at: motion.point(plane.at), normal }))
        }
        Value::Vertex(home, vertex) => Value::point(motion.point(cx.model(home)?.vertices[vertex.index()].point)),
        // Faces keep their names, and what lacks some goes on lacking them.
        Value::Record(record) if record.part.is_some() => {
            let things = value.part().map_or_else(Vec::new, |part| part.things());
            let carried = |thing: &Value| match thing {
                Value::Shell(shell) => {
                    let surfaces = shell.surfaces.iter().map(|s| s.moved(motion)).collect();
                    Value::Shell(Arc::new(ShellValue { origin, surfaces, ..(**shell).clone() }))
                }
                Value::Surface(surface) => Value::Surface(surface.moved(motion)),
                other => other.clone(),
            };
            Value::list(things.iter().map(carried).collect())
        }
        Value::Surface(surface) if cx.said_of(surface).is_some() => Value::Surface(surface.moved(motion)),
        Value::Surface(surface) => Value::Surface(surface.moved(motion).with_origin(origin)),
        Value::List(items) => Value::list(items.iter().map(|item| carried(cx, item, motion)).collect::<Result<_, _>>()?),
        other => {
            return Err(ValueFault::WrongKind { argument: "of", wanted: MOVABLE, found: other.ty().words() }.into());
        }
    })
}

/// Direction and a point of an axis; a straight curve gives both.
pub(crate) fn axis_line(cx: &Cx, axis: &Axis) -> Result<(DVec3, Option<DVec3>), Halt> {
    match axis {
        Axis::Direction(v) => Ok((unit(*v, "axis")?, None)),
        Axis::Curve(chain) => {
            let line = axis_of(chain, &cx.tolerance()?)?;
            Ok((line.direction, Some(line.about)))
        }
    }
}

builtins! {
    /// The same thing at another place.
    ///
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// curve north = move(south, by: (0, 3m, 0))
    /// ```
    fn move(
        /// Points, curves, surfaces, shells, meshes, or lists of them.
        of: Movable,
        /// How far and which way.
        by: Point,
    ) -> Value = |cx, of, by| carried(cx, &of.0, &Motion::translation(by.0));

    /// The same thing turned about an axis, counter-clockwise seen against it.
    ///
    /// A straight curve as axis gives its place as well.
    /// ```loft
    /// curve blade = line((1m, 0, 0), (2m, 0, 0))
    /// curve blades for i in 1..3 = rotate(blade, angle: i * 120deg)
    /// ```
    fn rotate(
        /// Points, curves, surfaces, shells, meshes, or lists of them.
        of: Movable,
        /// How far it turns.
        angle: Angle,
        /// Direction of the axis, or a straight curve.
        axis: Axis = "(0, 0, 1)",
        /// A point of the axis; the origin, or the curve's start.
        about: Option<Point>,
    ) -> Value = |cx, of, angle, axis, about| {
        let (direction, start) = axis_line(cx, &axis)?;
        let about = about.map(|p| p.0).or(start).unwrap_or(DVec3::ZERO);
        carried(cx, &of.0, &Motion::rotation(about, direction, angle.0))
    };

    /// The same thing larger or smaller, shape kept.
    ///
    /// ```loft
    /// curve outer = circle(center: (0, 0, 0), radius: 1m)
    /// curve inner = scale(outer, by: 60%)
    /// ```
    fn scale(
        /// Points, curves, surfaces, shells, meshes, or lists of them.
        of: Movable,
        /// Ratio of lengths, above 0.
        by: f64,
        /// The point that stays.
        about: Point = "(0, 0, 0)",
    ) -> Value = |cx, of, by, about| {
        if by <= 0.0 {
            let range = "above 0".to_owned();
            return Err(ValueFault::OutsideRange { argument: "by", found: by.to_string(), range }.into());
        }
        carried(cx, &of.0, &Motion::scaling(about.0, by))
    };

    /// The mirror image in a plane.
    ///
    /// ```loft
    /// curve right = arc((0, 0, 0), (2m, 0, 0), through: (1m, 0, 1m))
    /// curve left = mirror(right, normal: (1, 0, 0))
    /// ```
    fn mirror(
        /// Points, curves, surfaces, shells, meshes, or lists of them.
        of: Movable,
        /// Normal of the plane.
        normal: Direction,
        /// A point of the plane.
        at: Point = "(0, 0, 0)",
    ) -> Value = |cx, of, normal, at| carried(cx, &of.0, &Motion::mirror(at.0, unit(normal.0, "normal")?));
}

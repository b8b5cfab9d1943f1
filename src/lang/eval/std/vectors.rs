//! Functions and fields of points and directions.

use crate::base::fault::ValueFault;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::values::conversions::Vector;
use crate::lang::values::types::dim_words;
use crate::lang::values::value::{Dim, Quantity, Value};
use crate::{builtins, fields};

/// Both in one dimension: a bare one beside a length is in model units.
pub(crate) fn together(cx: &Cx, a: Vector, b: Vector) -> Result<(Vector, Vector), Halt> {
    let bare = cx.bare_unit(cx.module());
    match (a.1, b.1) {
        (x, y) if x == y => Ok((a, b)),
        (Dim::NONE, Dim::LENGTH) => Ok((Vector(a.0 * bare, Dim::LENGTH), b)),
        (Dim::LENGTH, Dim::NONE) => Ok((a, Vector(b.0 * bare, Dim::LENGTH))),
        (x, y) => Err(ValueFault::Mixed { argument: "b", found: dim_words(y), beside: dim_words(x) }.into()),
    }
}

fn product(a: Dim, b: Dim) -> Result<Dim, Halt> {
    a.times(b).ok_or_else(|| ValueFault::WrongKind { argument: "b", wanted: "a smaller power", found: dim_words(b) }.into())
}

pub(crate) fn not_zero(v: Vector, argument: &'static str) -> Result<(), Halt> {
    if v.0 == glam::DVec3::ZERO {
        return Err(ValueFault::OutsideRange { argument, found: "(0, 0, 0)".into(), range: "a vector other than 0".into() }.into());
    }
    Ok(())
}

/// A point, node, vertex or tuple.
pub(crate) fn vector(cx: &mut Cx, value: Value, argument: &'static str) -> Result<Vector, Halt> {
    match value {
        Value::Vector(..) | Value::Node(_) | Value::Vertex(..) => cx.as_vector(value).map(|(v, dim)| Vector(v, dim)),
        other => Err(ValueFault::WrongKind { argument, wanted: "a point", found: cx.kind(&other) }.into()),
    }
}

builtins! {
    /// Scalar product of two vectors.
    ///
    /// ```loft
    /// let a = dot((1, 2, 3), (1, 0, 1)) // => 4
    /// ```
    fn dot(
        /// A vector.
        a: Vector,
        /// Another.
        b: Vector,
    ) -> Quantity = |_, a, b| Ok(Quantity::new(a.0.dot(b.0), product(a.1, b.1)?));

    /// Vector product: at right angles to both, as long as the area they span.
    ///
    /// ```loft
    /// let a = cross((1, 0, 0), (0, 1, 0)) // => (0, 0, 1)
    /// ```
    fn cross(
        /// A vector.
        a: Vector,
        /// Another.
        b: Vector,
    ) -> Vector = |_, a, b| Ok(Vector(a.0.cross(b.0), product(a.1, b.1)?));

    /// Length of a vector.
    ///
    /// ```loft
    /// let a = norm((3m, 4m, 0)) // => 5000mm
    /// ```
    fn norm(
        /// A vector.
        v: Vector,
    ) -> Quantity = |_, v| Ok(Quantity::new(v.0.length(), v.1));

    /// The direction of a vector, of length 1.
    ///
    /// ```loft
    /// let a = unit((0, 0, 5m)) // => (0, 0, 1)
    /// ```
    fn unit(
        /// A vector of some length.
        v: Vector,
    ) -> Vector = |_, v| {
        not_zero(v, "v")?;
        Ok(Vector(v.0 / v.0.length(), Dim::NONE))
    };

    /// The point halfway between two.
    ///
    /// ```loft
    /// let a = mid((0, 0, 0), (4mm, 0, 2mm)) // => (2mm, 0mm, 1mm)
    /// ```
    fn mid(
        /// A point.
        a: Vector,
        /// Another.
        b: Option<Vector>,
    ) -> Vector = |cx, a, b| {
        let Some(b) = b else {
            return Err(ValueFault::Missing { function: "mid", what: "two points, or one curve", example: "mid(A, B)" }.into());
        };
        let (a, b) = together(cx, a, b)?;
        Ok(Vector(a.0 + (b.0 - a.0) * 0.5, a.1))
    };

    /// The point or number at a ratio of the way from one to another.
    ///
    /// ```loft
    /// let a = lerp((0, 0, 0), (4mm, 0, 0), 25%) // => (1mm, 0mm, 0mm)
    /// let b = lerp(10mm, 20mm, 0.5) // => 15mm
    /// ```
    fn lerp(
        /// Where the ratio is 0.
        a: Value,
        /// Where the ratio is 1.
        b: Value,
        /// The ratio.
        t: f64,
    ) -> Value = |cx, a, b, t| match (a, b) {
        (Value::Number(x), Value::Number(y)) if x.dim == y.dim || x.value == 0.0 || y.value == 0.0 => {
            let dim = if x.dim.is_none() { y.dim } else { x.dim };
            Ok(Value::quantity(x.value + (y.value - x.value) * t, dim))
        }
        (Value::Number(x), Value::Number(y)) => Err(ValueFault::Mixed { argument: "b", found: dim_words(y.dim), beside: dim_words(x.dim) }.into()),
        (a, b) => {
            let (a, b) = (vector(cx, a, "a")?, vector(cx, b, "b")?);
            let (a, b) = together(cx, a, b)?;
            Ok(Value::Vector(a.0 + (b.0 - a.0) * t, a.1))
        }
    };
}

fields! {
    /// First coordinate.
    fn x(v: Vector) -> Quantity = |_, v| Ok(Quantity::new(v.0.x, v.1));
    /// Second coordinate.
    fn y(v: Vector) -> Quantity = |_, v| Ok(Quantity::new(v.0.y, v.1));
    /// Third coordinate.
    fn z(v: Vector) -> Quantity = |_, v| Ok(Quantity::new(v.0.z, v.1));
}
